// The knots below the sheet, and the basis functions over them: drawn again only where they changed.

import { element, HANDLES } from "./paint.js";

/** @typedef {import("./app.js").App} App */
/** @typedef {{u: number, copies: number, inner: boolean, circle: SVGElement}} Mark */

/** pixels at both sides of the line, and below it */
const SIDE = 24, BELOW = 22;

export class KnotLine {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    this.svg = /** @type {SVGSVGElement} */ (document.querySelector("#knotline svg"));
    this.box = /** @type {HTMLElement} */ (this.svg.parentElement);
    /** @type {unknown[]} what it was drawn from */
    this.drawn = [];
    /** @type {Mark[]} */
    this.marks = [];
    /** @type {Mark | undefined} the mark in the hand */
    this.held = undefined;
    this.width = 600;
    this.height = 60;
    /** the first knot and the last: @type {number} */
    this.from = this.to = 0;
    this.back = element("g", {});
    this.knots = element("g", {});
    this.svg.append(this.back, this.knots);
    new ResizeObserver(([{ contentRect }]) => {
      if (!contentRect.width) return; // not shown
      [this.width, this.height] = [contentRect.width, contentRect.height];
      this.paint();
    }).observe(this.svg);
    this.svg.addEventListener("pointerdown", (event) => this.down(event));
    this.svg.addEventListener("pointermove", (event) => this.move(event));
    this.svg.addEventListener("pointerup", (event) => this.up(event));
    this.svg.addEventListener("keydown", (event) => this.key(event));
  }

  get curve() {
    return this.app.drawing.curves[this.app.selected];
  }

  // ---- drawing --------------------------------------------------------------------------------------------------------

  paint() {
    const { app, curve } = this;
    this.box.classList.toggle("shown", !!curve && app.shows("knots"));
    this.box.classList.toggle("tall", app.shows("functions"));
    if (!curve) return;
    const functions = app.shows("functions") && app.lens.functions, nodes = app.shows("nodes");
    const from = [curve.knots, curve.closed, curve.degree, functions, functions && [...app.vertices].join(), nodes, this.width, this.height];
    if (from.every((value, i) => value === this.drawn[i])) return;
    const place = curve.knots[0] !== this.from || curve.knots[curve.knots.length - 1] !== this.to || this.width !== this.drawn[6] || this.height !== this.drawn[7];
    this.drawn = from;
    [this.from, this.to] = [curve.knots[0], curve.knots[curve.knots.length - 1]];
    this.setBack(functions, nodes);
    this.setMarks(curve.knots.length <= HANDLES ? told(curve) : [], place);
  }

  /** @param {number} u */
  x(u) {
    const { from, to } = this;
    return SIDE + ((u - from) / (to - from || 1)) * (this.width - 2 * SIDE);
  }

  /**
   * The axis with its ends, nodes, basis functions.
   * @param {any} functions @param {boolean} nodes
   */
  setBack(functions, nodes) {
    const { from, to, curve } = this, base = this.height - BELOW, made = [];
    functions?.functions?.forEach((/** @type {any} */ f, /** @type {number} */ i) => {
      const d = f.values.map((/** @type {number} */ y, /** @type {number} */ k) => `${k ? "L" : "M"}${this.x(functions.u[f.at + k]).toFixed(1)} ${(base - y * (base - 8)).toFixed(1)}`).join("");
      made.push(element("path", { d, class: this.app.vertices.has(i) ? "function chosen" : "function" }));
    });
    made.push(element("path", { d: `M${this.x(from)} ${base}H${this.x(to)}`, class: "axis" }));
    if (nodes) for (const u of curve.nodes) if (u <= to) made.push(element("circle", { cx: this.x(u), cy: base, r: 3, class: "node" }));
    for (const [u, kind] of /** @type {[number, string][]} */ ([[from, "end"], [to, "end last"]]))
      made.push(element("text", { x: this.x(u), y: this.height - 4, class: kind }, String(+u.toPrecision(4))));
    this.back.replaceChildren(...made);
  }

  /**
   * Put in and take out the marks between the first and the last difference; move the rest only if the axis changed.
   * @param {Omit<Mark, "circle">[]} wanted @param {boolean} place
   */
  setMarks(wanted, place) {
    const { marks } = this, least = Math.min(marks.length, wanted.length);
    let start = 0, end = 0;
    while (start < least && same(marks[start], wanted[start])) start++;
    while (end < least - start && same(marks[marks.length - 1 - end], wanted[wanted.length - 1 - end])) end++;
    const made = wanted.slice(start, wanted.length - end).map((mark) => ({ ...mark, circle: circle(mark) }));
    const gone = marks.splice(start, marks.length - start - end, ...made);
    for (const mark of gone) mark.circle.remove();
    const next = marks[start + made.length]?.circle ?? null;
    for (const mark of made) this.knots.insertBefore(mark.circle, next);
    for (const mark of place ? marks : made) this.put(mark);
  }

  /** @param {Mark} mark */
  put({ circle, u, copies }) {
    circle.setAttribute("cx", this.x(u).toFixed(1));
    circle.setAttribute("cy", String(this.height - BELOW - copies * 9));
  }

  // ---- hand and keys --------------------------------------------------------------------------------------------------

  /** @param {Event} event @returns {Mark | undefined} the inner knot that is meant */
  meant(event) {
    return this.marks.find(({ circle, inner }) => inner && circle.contains(/** @type {Node} */ (event.target)));
  }

  /** @param {PointerEvent} event */
  down(event) {
    this.held = this.meant(event);
    if (this.held) this.svg.setPointerCapture(event.pointerId);
  }

  /** @param {PointerEvent} event */
  move(event) {
    this.held?.circle.setAttribute("cx", String(event.clientX - this.svg.getBoundingClientRect().left));
  }

  /** @param {PointerEvent} event */
  up(event) {
    const { held, curve } = this;
    this.held = undefined;
    if (!held) return;
    const share = (event.clientX - this.svg.getBoundingClientRect().left - SIDE) / (this.width - 2 * SIDE);
    const [a, b] = [curve.knots[0], curve.knots[curve.knots.length - 1]];
    this.moveTo(this.marks.indexOf(held), a + share * (b - a)).then(() => this.put(held)); // back, if it could not be moved
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    const mark = this.meant(event);
    if (!mark) return;
    const i = this.marks.indexOf(mark), [a, b] = this.curve.domain;
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (step) {
      event.preventDefault();
      this.moveTo(i, mark.u + (step * (b - a)) / 100).then(() => /** @type {any} */ (this.marks[i])?.circle.focus());
    }
    if (event.key === "Delete") this.app.do({ do: "remove knot", curve: this.app.selected, u: mark.u, tolerance: this.app.panel.tolerance() });
  }

  /** @param {number} knot @param {number} to */
  moveTo(knot, to) {
    return this.app.do({ do: "move knot", curve: this.app.selected, knot, to, "based on": this.app.drawing.revision });
  }
}

/** @param {import("./drawing.js").Curve} curve @returns {Omit<Mark, "circle">[]} */
function told({ knots, degree, closed }) {
  const side = closed ? 0 : degree;
  let copies = 0;
  return knots.map((u, i) => {
    copies = i && u === knots[i - 1] ? copies + 1 : 0;
    return { u, copies, inner: i > side && i < knots.length - side - 1 };
  });
}

/** @param {Omit<Mark, "circle">} a @param {Omit<Mark, "circle">} b */
const same = (a, b) => a.u === b.u && a.copies === b.copies && a.inner === b.inner;

/** @param {Omit<Mark, "circle">} mark */
function circle({ u, inner }) {
  const value = String(+u.toPrecision(6));
  const made = element("circle", { r: 4.5, class: inner ? "knot inner" : "knot", tabindex: inner ? 0 : -1, role: "slider", "aria-label": "knot", "aria-valuenow": u, "aria-valuetext": value });
  made.append(element("title", {}, value));
  return made;
}
