// The list of drawings: open, rename, copy, delete (and take that back), files in and out.

/** @typedef {import("./app.js").App} App */

const $ = (/** @type {string} */ id) => /** @type {any} */ (document.getElementById(id));

export class Documents {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    /** @type {{id: string, name: string, changed: number, curves: number}[]} */
    this.list = [];
    this.current = "";
    $("menu").onclick = () => this.show();
    $("new").onclick = () => this.make();
    $("import").onclick = $("start-import").onclick = () => $("file").click();
    $("file").onchange = () => this.bring([...$("file").files]);
    $("name").onchange = () => this.rename($("name").value.trim());
    app.sheet.addEventListener("dragover", (event) => event.preventDefault());
    app.sheet.addEventListener("drop", (event) => {
      event.preventDefault();
      this.bring([...(event.dataTransfer?.files ?? [])]);
    });
  }

  /** @param {Documents["list"]} list */
  take(list) {
    this.list = list;
    const named = list.find((d) => d.id === this.current);
    if (named && document.activeElement !== $("name")) $("name").value = named.name;
    if (named) document.title = `${named.name} – Knotwork`;
    this.fill();
  }

  /**
   * Open what was open before, or the newest, or a new one.
   * @param {string | null} first
   */
  async begin(first) {
    if (this.current) return;
    const before = location.hash.slice(1);
    const known = this.list.find((d) => d.id === (first && !before ? first : before));
    if (known) return this.open(known.id);
    const empty = this.list.find((d) => !d.curves);
    return empty ? this.open(empty.id) : this.make();
  }

  async make() {
    const answer = await this.app.wire.ask({ documents: "new", name: "Untitled" });
    if (answer.made) {
      this.take(answer.documents);
      await this.open(answer.made);
    }
    $("drawings").close();
  }

  /** @param {string} id */
  async open(id) {
    this.current = this.app.wire.document = id;
    history.replaceState(null, "", `#${id}`);
    this.app.drawing.revision = -1;
    this.app.drawing.curves = [];
    this.app.selected = -1;
    this.app.vertices = new Set();
    const answer = await this.app.wire.ask({ open: id });
    if (answer.error) return this.app.say("Not done", answer.error);
    this.app.take({ ...answer, reason: "" });
    this.take(this.list);
  }

  /** @param {string} name */
  async rename(name) {
    if (!name) return this.take(this.list);
    const answer = await this.app.wire.ask({ documents: "rename", document: this.current, name });
    if (answer.documents) this.take(answer.documents);
  }

  show() {
    this.fill();
    $("drawings").showModal();
  }

  fill() {
    const list = document.querySelector("#drawings ul");
    list?.replaceChildren(...this.list.map((d) => this.row(d)));
  }

  /** @param {Documents["list"][0]} d */
  row(d) {
    const row = document.createElement("li");
    const open = button(d.name, () => { this.open(d.id); $("drawings").close(); });
    open.className = "open";
    if (d.id === this.current) open.setAttribute("aria-current", "true");
    const note = document.createElement("span");
    note.textContent = `${d.curves} curve${d.curves === 1 ? "" : "s"}, ${new Date(d.changed * 1000).toLocaleString()}`;
    open.append(note);
    row.append(open, button("Copy", () => this.tell({ documents: "duplicate", document: d.id, name: `${d.name} (copy)` })), button("Delete", () => this.delete(d)));
    return row;
  }

  /** @param {Documents["list"][0]} d */
  async delete(d) {
    await this.tell({ documents: "delete", document: d.id });
    const back = button(`Bring ${d.name} back`, async () => { await this.tell({ documents: "restore", document: d.id }); back.remove(); });
    document.querySelector("#drawings .row")?.append(back);
    if (d.id === this.current) {
      this.current = "";
      await this.begin(null);
    }
  }

  /** @param {Record<string, any>} message */
  async tell(message) {
    const answer = await this.app.wire.ask(message);
    if (answer.documents) this.take(answer.documents);
    if (answer.error) this.app.say("Not done", answer.error);
  }

  /** @param {File[]} files */
  async bring(files) {
    for (const file of files) {
      this.app.expected = true;
      const url = `/import/${this.current}?token=${encodeURIComponent(this.app.token)}&name=${encodeURIComponent(file.name)}`;
      const answer = await (await fetch(url, { method: "POST", body: file })).json();
      this.app.say(answer.error ? "Not done" : "Imported", answer.error ?? answer.reason);
    }
    $("file").value = "";
  }
}

/** @param {string} text @param {() => void} act */
export function button(text, act) {
  const made = document.createElement("button");
  made.type = "button";
  made.textContent = text;
  made.onclick = act;
  return made;
}
