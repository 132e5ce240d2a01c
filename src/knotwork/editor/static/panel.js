// The panel of the chosen curve: degree, reduction, what is shown, what is taken away.

import { button } from "./documents.js";
import { colour } from "./paint.js";

/** @typedef {import("./app.js").App} App */

const $ = (/** @type {string} */ id) => /** @type {any} */ (document.getElementById(id));

export class Panel {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    for (const select of [$("degree"), $("new-degree")])
      for (let n = 1; n <= 9; n++) select.add(new Option(["linear", "quadratic", "cubic", "quartic", "quintic"][n - 1] ?? `degree ${n}`, String(n)));
    $("degree").onchange = () => app.setDegree(Number($("degree").value));
    $("new-degree").onchange = $("spacing").onchange = () => app.do({ do: "settings", degree: Number($("new-degree").value), spacing: $("spacing").value });
    $("close").onclick = () => app.toggleClosed();
    $("delete").onclick = () => { app.vertices = new Set(); app.remove(false); };
    $("tolerance").oninput = () => this.preview();
    $("tolerance").onchange = () => this.preview();
    $("reduce").onclick = () => app.do({ do: "reduce", curve: app.selected, tolerance: this.tolerance() });
    $("reduce-region").onclick = () => app.do({ do: "reduce", curve: app.selected, tolerance: this.tolerance(), region: this.region() });
    $("balance").onclick = () => app.do({ do: "balance", curve: app.selected, region: this.region() });
    $("table-open").onclick = () => this.table();
    for (const box of document.querySelectorAll("[data-show]")) /** @type {HTMLInputElement} */ (box).onchange = () => { app.look(); app.show(); };
    const kinds = { svg: "SVG", json: "JSON", dxf: "DXF", npz: "NPZ", csv: "CSV", py: "Python" };
    for (const [kind, name] of Object.entries(kinds)) $("exports").append(button(name, () => this.export(kind)));
    $("exports").append(button("PNG", () => this.png()));
    if (innerWidth > 900) app.togglePanel?.();
  }

  curve() {
    return this.app.drawing.curves[this.app.selected];
  }

  fill() {
    const { app } = this, curve = this.curve();
    document.body.classList.toggle("no-curve", !curve);
    $("new-degree").value = String(app.drawing.degree);
    $("spacing").value = app.drawing.spacing;
    if (!curve) return;
    const many = app.drawing.curves.length;
    $("which").textContent = many > 1 ? `${app.selected + 1} of ${many}` : "";
    $("degree").value = String(curve.degree);
    $("close").textContent = curve.closed ? "Open" : "Close";
    const chosen = app.vertices.size ? `, ${app.vertices.size} chosen` : "";
    $("numbers").textContent = `${curve.points.length} vertices, ${new Set(curve.knots).size} different knots${chosen}`;
    $("reduce-region").disabled = $("balance").disabled = app.vertices.size < 2;
    $("balance").hidden = curve.closed;
    $("tolerance-value").textContent = number(this.tolerance());
    $("reduction").textContent = "";
  }

  /** The tolerance of the slider, in the units of the drawing. */
  tolerance() {
    const curve = this.curve();
    if (!curve) return 1;
    let [a, b, c, d] = [Infinity, Infinity, -Infinity, -Infinity];
    for (const [x, y] of curve.points) [a, b, c, d] = [Math.min(a, x), Math.min(b, y), Math.max(c, x), Math.max(d, y)];
    return (Math.hypot(c - a, d - b) || 1) * 10 ** Number($("tolerance").value);
  }

  /** Show what the reduction would leave, as the slider moves. */
  async preview() {
    const { app } = this;
    $("tolerance-value").textContent = number(this.tolerance());
    if (this.asking || !this.curve()) return void (this.again = true);
    this.asking = true;
    const tolerance = this.tolerance();
    const { answer, error } = await app.wire.ask({ ask: "preview", curve: app.selected, tolerance });
    this.asking = false;
    if (answer) {
      $("reduction").textContent = `${answer.before} → ${answer.count} vertices, at most ${number(answer.bound)} off`;
      app.preview = { pieces: answer.pieces, tolerance };
      app.show();
    } else if (error) $("reduction").textContent = error;
    if (this.again) {
      this.again = false;
      this.preview();
    }
  }

  /** The parameters from the first of the selected vertices to the last. */
  region() {
    const curve = this.curve(), nodes = [...this.app.vertices].map((i) => curve.nodes[i]);
    return [nodes.reduce((a, b) => Math.min(a, b)), nodes.reduce((a, b) => Math.max(a, b))];
  }

  table() {
    const curve = this.curve();
    const body = document.querySelector("#table tbody");
    body?.replaceChildren(...(curve?.points ?? []).slice(0, 2000).map((p, i) => {
      const row = document.createElement("tr");
      for (const text of [i, +p[0].toPrecision(8), +p[1].toPrecision(8), +curve.nodes[i].toPrecision(6)]) {
        const cell = document.createElement("td");
        cell.textContent = String(text);
        row.append(cell);
      }
      return row;
    }));
    $("table").showModal();
  }

  /** @param {string} kind */
  export(kind) {
    const link = document.createElement("a");
    link.href = `/export/${this.app.documents.current}/${kind}?token=${encodeURIComponent(this.app.token)}`;
    link.download = `${$("name").value || "drawing"}.${kind}`;
    link.click();
  }

  /** The picture as it is on the sheet, without the marks. */
  png() {
    const source = this.app.canvas, target = document.createElement("canvas");
    target.width = source.width;
    target.height = source.height;
    const pen = /** @type {CanvasRenderingContext2D} */ (target.getContext("2d"));
    pen.fillStyle = colour("paper");
    pen.fillRect(0, 0, target.width, target.height);
    pen.drawImage(source, 0, 0);
    const link = document.createElement("a");
    link.href = target.toDataURL("image/png");
    link.download = `${$("name").value || "drawing"}.png`;
    link.click();
  }
}

/** @param {number} x */
const number = (x) => String(+x.toPrecision(3));
