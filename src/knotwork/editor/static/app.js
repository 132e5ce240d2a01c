// The editor: what is chosen, what is shown, and what the hand and the keys do to it.

import { Camera } from "./camera.js";
import { Documents } from "./documents.js";
import { at, Drawing } from "./drawing.js";
import { Hand } from "./hand.js";
import { KEYS, listen } from "./keys.js";
import { KnotLine } from "./knotline.js";
import { ink, paint } from "./paint.js";
import { Panel } from "./panel.js";
import { Wire } from "./wire.js";

/** @param {string} id @returns {any} */
export const $ = (id) => document.getElementById(id);

export class App {
  constructor() {
    this.sheet = /** @type {HTMLElement} */ ($("sheet"));
    this.canvas = /** @type {HTMLCanvasElement} */ ($("curves"));
    this.ink = /** @type {HTMLCanvasElement} */ ($("ink"));
    this.marks = /** @type {SVGSVGElement} */ ($("marks"));
    this.camera = new Camera();
    this.drawing = new Drawing();
    this.tool = "draw";
    this.selected = -1;
    /** @type {Set<number>} */
    this.vertices = new Set();
    /** @type {Record<string, any>} what was asked of the server about the chosen curve */
    this.lens = {};
    /** @type {{pieces: number[][], tolerance: number} | null} */
    this.preview = null;
    /** @type {{steps: any[], shown: number} | null} */
    this.boehm = null;
    /** @type {{path: number[][], pressure: number[] | null} | null} */
    this.lastStroke = null;
    /** milliseconds from the end of a stroke in the hand to the first frame that shows what it did */
    this.times = /** @type {number[]} */ ([]);
    /** whether a file was brought, and its curves are to be seen when they come */
    this.expected = false;
    /** @type {Promise<Record<string, any>>} the last change that was asked for */
    this.last = Promise.resolve({});
    /** @type {Promise<Record<string, any>> | null} the change that is drawn and not on disk yet */
    this.saving = null;
    /** @type {[number, number] | null} how far the chosen vertices are in the hand from where they were */
    this.away = null;
    this.token = new URLSearchParams(location.search).get("token") ?? "";
    this.hand = new Hand(this);
    this.documents = new Documents(this);
    this.panel = new Panel(this);
    this.knotline = new KnotLine(this);
    /** @type {Wire} */
    this.wire = new Wire(this.token, (news) => this.heard(news), (state) => this.lineIs(state));
    listen(this);
    this.buttons();
    new ResizeObserver(() => this.resized()).observe(this.sheet);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.show());
    this.setTool("draw");
  }

  buttons() {
    $("undo").onclick = () => this.history("undo");
    $("redo").onclick = () => this.history("redo");
    $("zoom-in").onclick = () => this.zoom(1.25);
    $("zoom-out").onclick = () => this.zoom(0.8);
    $("zoom").onclick = () => this.showAll();
    $("help").onclick = () => this.showKeys();
    $("panel-toggle").onclick = () => this.togglePanel();
    for (const button of document.querySelectorAll("#tools [data-tool]")) /** @type {HTMLElement} */ (button).onclick = () => this.setTool(/** @type {HTMLElement} */ (button).dataset.tool ?? "draw");
    for (const button of document.querySelectorAll("#reading [data-reading]")) /** @type {HTMLElement} */ (button).onclick = () => this.readAgain(/** @type {HTMLElement} */ (button).dataset.reading ?? "auto");
    $("example").onclick = () => this.example();
    const list = document.querySelector("#keys dl");
    for (const [keys, what] of KEYS) {
      const dt = document.createElement("dt"), dd = document.createElement("dd");
      dt.textContent = keys;
      dd.textContent = what;
      list?.append(dt, dd);
    }
  }

  // ---- what the server says ----------------------------------------------------------------------------------------

  /** @param {Record<string, any>} news */
  heard(news) {
    if (news.warning) this.say("Attention", news.warning);
    if (news.documents) this.documents.take(news.documents);
    if (news.hello) return void this.documents.begin(news.first);
    if (news.error) this.say("Not done", news.error);
    if (news.revision !== undefined) this.take(news);
  }

  /**
   * The drawing is this now, and on disk.
   * @param {Record<string, any>} news
   */
  take(news) {
    this.see(news);
    this.saved(news);
  }

  /**
   * Draw what the drawing is, or will be.
   * @param {Record<string, any>} news
   */
  see(news) {
    const fresh = this.drawing.revision < 0, brought = this.expected && news.case === "imported";
    this.drawing.take(news);
    if (news.curve >= 0 && news.case !== "ignored") this.selected = news.curve;
    this.selected = Math.min(this.selected, this.drawing.curves.length - 1);
    if (this.selected < 0 && this.drawing.curves.length) this.selected = 0;
    const count = this.drawing.curves[this.selected]?.points.length ?? 0;
    for (const vertex of this.vertices) if (vertex >= count) this.vertices.delete(vertex);
    this.preview = null;
    this.lens = {};
    this.mark(!!news.picture);
    document.body.classList.toggle("empty", !this.drawing.curves.length);
    if (fresh || brought) this.camera.show(this.drawing.box(), this.covered());
    if (brought) this.expected = false;
    this.paint();
    this.inked();
  }

  /**
   * What is drawn is on disk: it is said, and more is asked about it.
   * @param {Record<string, any>} news
   */
  saved(news) {
    this.drawing.revision = news.revision;
    this.mark(false);
    if (news.reason) this.say(news.case, news.reason);
    this.look();
    this.panel.fill();
  }

  /** @param {boolean} unsaved */
  mark(unsaved) {
    $("unsaved").classList.toggle("shown", unsaved);
  }

  /** @param {Record<string, any>} message @returns {Promise<Record<string, any>>} */
  do(message) {
    const done = this.perform(message);
    this.last = done;
    return done;
  }

  /** @param {Record<string, any>} message @returns {Promise<Record<string, any>>} */
  async perform(message) {
    const start = performance.now();
    if ("based on" in message && this.saving) {
      // it names vertices of a picture that is not saved yet
      const before = await this.saving;
      if (before.error) return before;
      message["based on"] = before.revision;
    }
    let seen = false;
    const show = (/** @type {Record<string, any>} */ picture) => {
      seen = true;
      this.saving = asked;
      this.see(picture);
      this.clock(start);
    };
    const asked = this.wire.ask(message, show);
    const answer = await asked;
    if (this.saving === asked) this.saving = null;
    if (answer.error) {
      this.drawing.ghost = null;
      this.say("Not done", answer.error);
      if (/changed elsewhere/.test(answer.error)) this.documents.open(this.documents.current);
    } else if (seen) this.saved(answer);
    else if (answer.revision !== undefined) {
      this.take(answer);
      this.clock(start);
    }
    return answer;
  }

  /** @param {number} start */
  clock(start) {
    requestAnimationFrame(() => this.times.push(performance.now() - start));
  }

  /** @param {"open" | "lost"} state */
  lineIs(state) {
    $("line").textContent = state === "open" ? "" : "The line to the server is down; what you draw waits.";
    document.body.classList.toggle("lost", state !== "open");
  }

  // ---- pictures -----------------------------------------------------------------------------------------------------

  /** @param {string} what */
  shows(what) {
    return /** @type {HTMLInputElement} */ (document.querySelector(`[data-show=${what}]`)).checked;
  }

  /** Draw in the next frame. */
  show() {
    this.stale = true;
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      if (this.stale) this.paint();
    });
  }

  /** Draw at once: the next frame shows it. */
  paint() {
    this.stale = false;
    const zoom = `${Math.round(this.camera.scale * 100)} %`;
    $("undo").disabled = !this.drawing.undo;
    $("redo").disabled = !this.drawing.redo;
    if ($("zoom").textContent !== zoom) $("zoom").textContent = zoom;
    paint(this);
    this.knotline.paint();
  }

  /** @param {boolean} [anew] */
  inked(anew) {
    ink(this, anew);
  }

  resized() {
    const { clientWidth, clientHeight } = this.sheet;
    this.camera.width = clientWidth;
    this.camera.height = clientHeight;
    this.paint();
    this.inked();
  }

  /** @param {number} dx @param {number} dy */
  pan(dx, dy) {
    this.camera.pan(dx, dy);
    this.show();
  }

  /** @param {number} factor @param {number} [x] @param {number} [y] */
  zoom(factor, x, y) {
    this.camera.zoom(factor, x, y);
    this.show();
  }

  /** What the panel covers of the sheet: its right side, or on a small screen its lower part. */
  covered() {
    const { width, height } = $("panel").getBoundingClientRect();
    const below = width > this.camera.width / 2;
    return { right: width && !below ? width + 12 : 0, bottom: width && below ? height + 62 : 0 };
  }

  showAll() {
    this.camera.show(this.drawing.box(), this.covered());
    this.show();
  }

  /** @param {string} rule @param {string} reason */
  say(rule, reason) {
    $("rule").textContent = rule ? rule[0].toUpperCase() + rule.slice(1) : "";
    $("reason").textContent = reason;
    $("said").classList.add("shown");
    clearTimeout(this.quiet);
    this.quiet = setTimeout(() => $("said").classList.remove("shown"), 9000);
  }

  // ---- tools --------------------------------------------------------------------------------------------------------

  /** @param {string} tool */
  setTool(tool) {
    this.tool = tool;
    this.sheet.dataset.tool = tool;
    for (const button of document.querySelectorAll("#tools [data-tool]")) button.setAttribute("aria-checked", String(/** @type {HTMLElement} */ (button).dataset.tool === tool));
    if (tool !== "lens") this.lens.triangle = null;
    this.show();
  }

  /** @param {number} index */
  choose(index) {
    if (index !== this.selected) this.vertices = new Set();
    this.selected = index;
    this.preview = null;
    this.lens = {};
    this.chosen();
    this.look();
  }

  chosen() {
    this.panel.fill();
    this.show();
  }

  /** @param {number} step */
  chooseNext(step) {
    const count = this.drawing.curves.length;
    if (count) this.choose((this.selected + step + count) % count);
  }

  chooseAll() {
    const curve = this.drawing.curves[this.selected];
    this.vertices = new Set(curve ? curve.points.keys() : []);
    this.chosen();
  }

  /** @param {number} step */
  nextVertex(step) {
    const count = this.drawing.curves[this.selected]?.points.length ?? 0;
    const now = this.vertices.size ? [...this.vertices][0] : step > 0 ? -1 : count;
    const vertex = now + step;
    this.vertices = new Set([vertex]);
    const [x, y] = this.drawing.curves[this.selected].points[vertex];
    this.say(`vertex ${vertex}`, `at ${+x.toPrecision(6)}, ${+y.toPrecision(6)}`);
    this.chosen();
  }

  atFirstVertex() {
    return !this.vertices.size || this.vertices.has(0);
  }

  atLastVertex() {
    return this.vertices.has((this.drawing.curves[this.selected]?.points.length ?? 0) - 1);
  }

  // ---- actions ------------------------------------------------------------------------------------------------------

  /**
   * A stroke was drawn.
   * @param {number[][]} path
   * @param {number[] | null} pressure
   */
  async drawn(path, pressure) {
    this.lastStroke = { path, pressure };
    await this.draw(path, pressure, "auto");
    this.inked();
  }

  /** @param {number[][]} path @param {number[] | null} pressure @param {string} reading */
  async draw(path, pressure, reading) {
    const near = 12 / this.camera.scale;
    const answer = await this.do({ do: "stroke", path, pressure, reading, reach: near, tolerance: 2 / this.camera.scale });
    const read = answer.case === "freehand" ? "curve" : "straight";
    $("reading").hidden = path.length < 3 || !answer.case;
    for (const button of document.querySelectorAll("#reading [data-reading]")) button.setAttribute("aria-pressed", String(/** @type {HTMLElement} */ (button).dataset.reading === read));
    return answer;
  }

  /**
   * Take the last stroke back and read it the other way.
   * @param {string} reading
   */
  async readAgain(reading) {
    if (!this.lastStroke) return;
    const { path, pressure } = this.lastStroke;
    await this.history("undo");
    await this.draw(path, pressure, reading);
  }

  settle() {
    if (this.drawing.pending) this.do({ do: "settle" });
  }

  escape() {
    if (this.hand.doing) return this.hand.stop();
    if (this.drawing.pending) return this.settle();
    this.vertices = new Set();
    this.boehm = null;
    this.chosen();
  }

  /** @param {"undo" | "redo"} way */
  async history(way) {
    const before = this.last;
    const turn = (async () => {
      await before; // so that the revision is known, and an undo said again after the line broke is done once
      if (this.drawing[way]) return this.perform({ do: way, "based on": this.drawing.revision });
      return {};
    })();
    this.last = turn;
    return turn;
  }

  /** @param {number[]} point */
  put(point) {
    const curve = this.drawing.curves[this.selected];
    this.do({ do: "put", curve: curve && !curve.closed ? this.selected : this.drawing.curves.length, point });
  }

  appendByKey() {
    const curve = this.drawing.curves[this.selected];
    const step = 60 / this.camera.scale;
    if (!curve || curve.closed) return this.put([this.camera.x, this.camera.y]);
    const end = curve.points[curve.points.length - 1], before = curve.points[curve.points.length - 2] ?? [end[0] - 1, end[1]];
    const length = Math.hypot(end[0] - before[0], end[1] - before[1]) || 1;
    this.put([end[0] + (step * (end[0] - before[0])) / length, end[1] + (step * (end[1] - before[1])) / length]);
  }

  /**
   * The control points of a curve as they are drawn: those in the hand where the hand is.
   * @param {number} index
   */
  pointsOf(index) {
    const { points } = this.drawing.curves[index], { away } = this;
    return away && index === this.selected ? points.map((p, i) => (this.vertices.has(i) ? [p[0] + away[0], p[1] + away[1]] : p)) : points;
  }

  /**
   * The polygon follows the hand; the curve when it lets go.
   * @param {[number, number]} by
   */
  dragged(by) {
    this.away = by;
    this.show();
  }

  dropped() {
    this.away = null;
    this.show();
  }

  /** @param {[number, number]} by */
  drop(by) {
    this.away = null; // what is drawn stays until the answer
    this.move(by);
  }

  /** @param {[number, number]} by */
  move(by) {
    return this.do({ do: "drag", curve: this.selected, vertices: [...this.vertices], by, "based on": this.drawing.revision });
  }

  /** @param {[number, number]} way @param {number} times */
  nudge(way, times) {
    const step = times / this.camera.scale;
    this.move([way[0] * step, way[1] * step]);
  }

  /**
   * Delete vertices, or, keeping the shape, the knot nearest to the chosen vertex.
   * @param {boolean} keepShape
   */
  remove(keepShape) {
    const curve = this.drawing.curves[this.selected];
    if (!curve) return;
    if (keepShape) {
      const vertex = [...this.vertices][0];
      if (vertex === undefined) return this.say("", "Choose the vertex whose knot is to go.");
      const inner = curve.knots.slice(curve.closed ? 1 : curve.degree + 1, curve.closed ? -1 : -curve.degree - 1);
      if (!inner.length) return this.say("", "The curve has no interior knot.");
      const u = inner.reduce((best, t) => (Math.abs(t - curve.nodes[vertex]) < Math.abs(best - curve.nodes[vertex]) ? t : best));
      return void this.do({ do: "remove knot", curve: this.selected, u, tolerance: this.panel.tolerance() });
    }
    const message = { do: "delete", curve: this.selected, "based on": this.drawing.revision };
    this.do(this.vertices.size ? { ...message, vertices: [...this.vertices] } : message);
    this.vertices = new Set();
  }

  /**
   * Insert a knot, and show Boehm's construction step by step.
   * @param {number} index
   * @param {number} u
   */
  async insertKnot(index, u) {
    this.choose(index);
    const told = (await this.wire.ask({ ask: "boehm", curve: index, u })).answer;
    const answer = await this.do({ do: "insert knot", curve: index, u });
    if (!told || answer.error) return;
    this.boehm = { steps: told.steps, shown: 0 };
    const next = () => {
      if (!this.boehm) return;
      this.boehm.shown += 1;
      this.show();
      setTimeout(this.boehm.shown < told.steps.length ? next : () => { this.boehm = null; this.show(); }, this.boehm.shown < told.steps.length ? 450 : 2500);
    };
    next();
    const k = (await this.wire.ask({ ask: "condition", curve: index, u })).answer;
    if (k) this.say("Knot", `Boehm's algorithm: ${told.steps.length} new vertices on the sides of the old polygon. Taking the knot out again can enlarge errors ${k.condition.toPrecision(3)} times.`);
  }

  toggleClosed() {
    if (this.drawing.curves[this.selected]) this.do({ do: "close", curve: this.selected });
  }

  /** @param {number} degree */
  setDegree(degree) {
    if (this.drawing.curves[this.selected]) this.do({ do: "degree", curve: this.selected, degree });
  }

  // ---- choosing with a frame ----------------------------------------------------------------------------------------

  /** @param {number[]} a @param {number[]} b */
  rubber(a, b) {
    const frame = this.marks.querySelector(".frame") ?? document.createElementNS("http://www.w3.org/2000/svg", "rect");
    frame.setAttribute("class", "frame");
    frame.setAttribute("x", String(Math.min(a[0], b[0])));
    frame.setAttribute("y", String(Math.min(a[1], b[1])));
    frame.setAttribute("width", String(Math.abs(a[0] - b[0])));
    frame.setAttribute("height", String(Math.abs(a[1] - b[1])));
    this.marks.append(frame);
  }

  /** @param {number[]} a @param {number[]} b @param {boolean} more */
  rubbed(a, b, more) {
    const curve = this.drawing.curves[this.selected];
    if (!more) this.vertices = new Set();
    curve?.points.forEach((p, i) => {
      const [x, y] = this.camera.toScreen(p);
      if ((x - a[0]) * (x - b[0]) <= 0 && (y - a[1]) * (y - b[1]) <= 0) this.vertices.add(i);
    });
    this.chosen();
  }

  // ---- lenses -------------------------------------------------------------------------------------------------------

  /** Ask for what is shown of the chosen curve. */
  async look() {
    const index = this.selected, curve = this.drawing.curves[index], revision = this.drawing.revision;
    if (!curve) return;
    for (const name of ["comb", "functions", "blossoms"]) {
      if (!this.shows(name) || this.lens[name]) continue;
      const { answer, error } = await this.wire.ask({ ask: name, curve: index });
      if (error) this.say("", error);
      if (index !== this.selected || revision !== this.drawing.revision) return;
      if (answer) this.lens[name] = name === "blossoms" ? answer.arguments : answer;
      this.show();
    }
    if (this.shows("nodes")) this.lens.nodes = curve.nodes.map((u) => this.pointAt(curve, u));
    this.show();
  }

  /** @param {import("./drawing.js").Curve} curve @param {number} u */
  pointAt(curve, u) {
    const [a, b] = curve.domain;
    if (curve.closed) u = a + ((((u - a) % (b - a)) + (b - a)) % (b - a));
    let i = curve.breaks.findIndex((x, k) => k && u <= x) - 1;
    i = Math.min(Math.max(i, 0), curve.pieces.length - 1);
    const t = (u - curve.breaks[i]) / (curve.breaks[i + 1] - curve.breaks[i]);
    return at(curve.pieces[i], Math.min(Math.max(t, 0), 1));
  }

  /**
   * The pointer moves over the sheet: the lens follows it.
   * @param {number} x
   * @param {number} y
   */
  async hover(x, y) {
    if (this.tool !== "lens" || this.asking) return;
    const hit = this.hand.curveAt(x, y, 80);
    if (!hit) {
      if (this.lens.triangle) { this.lens.triangle = null; this.show(); }
      return;
    }
    if (hit.index !== this.selected) this.choose(hit.index);
    this.asking = true;
    const { answer } = await this.wire.ask({ ask: "triangle", curve: hit.index, u: hit.u });
    this.asking = false;
    if (answer && this.tool === "lens") this.lens.triangle = answer;
    this.show();
  }

  // ---- the rest -----------------------------------------------------------------------------------------------------

  togglePanel() {
    const before = this.covered();
    const open = document.body.classList.toggle("panel");
    const now = this.covered();
    this.pan((before.right - now.right) / 2, (before.bottom - now.bottom) / 2);
    $("panel-toggle").setAttribute("aria-expanded", String(open));
  }

  showKeys() {
    $("keys").showModal();
  }

  /** A curve to begin with: a wave with a bump, drawn in strokes like anybody's. */
  async example() {
    const step = 90 / this.camera.scale, { x, y } = this.camera;
    const heights = [0, 0.9, 1.3, 0.4, -0.7, -0.9, 0.3, 1.1, 0.6];
    for (const [i, h] of heights.entries()) {
      await this.do({ do: "put", curve: i ? this.drawing.curves.length - 1 : this.drawing.curves.length, point: [x + (i - 4) * step, y + h * step] });
    }
    this.say("Example", "Draw a stroke across the dashed polygon, or drag one of its vertices.");
  }
}
