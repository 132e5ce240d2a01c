// Mouse, finger and pen: strokes, drags, and two fingers that move the sheet.

import { nearest } from "./drawing.js";

/** @typedef {import("./app.js").App} App */

/** pixels within which a vertex or a curve is meant */
const NEAR = { mouse: 9, pen: 11, touch: 20 };
/** milliseconds after the pen was seen in which fingers are palms */
const PALM = 900;

export class Hand {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    /** @type {number[][]} points of the stroke on the screen */
    this.path = [];
    /** @type {number[] | null} */
    this.pressure = null;
    /** @type {Map<number, {x: number, y: number}>} fingers on the sheet */
    this.fingers = new Map();
    /** @type {"" | "stroke" | "drag" | "pan" | "pinch" | "select"} */
    this.doing = "";
    /** @type {[number, number]} where the hand came down */
    this.start = [0, 0];
    /** @type {[number, number]} where it was last */
    this.last = [0, 0];
    this.penSeen = -Infinity;
    this.space = false;
    const sheet = app.sheet;
    sheet.addEventListener("pointerdown", (event) => this.down(event));
    sheet.addEventListener("pointermove", (event) => this.move(event));
    sheet.addEventListener("pointerup", (event) => this.up(event));
    sheet.addEventListener("pointercancel", (event) => this.cancel(event));
    sheet.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    sheet.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  /** @param {PointerEvent} event @returns {[number, number]} */
  place(event) {
    const box = this.app.sheet.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  /** @param {PointerEvent} event */
  near(event) {
    return NEAR[/** @type {"mouse" | "pen" | "touch"} */ (event.pointerType)] ?? NEAR.mouse;
  }

  /** @param {PointerEvent} event */
  down(event) {
    const app = this.app;
    if (event.pointerType === "pen") this.penSeen = event.timeStamp;
    else if (event.pointerType === "touch" && event.timeStamp - this.penSeen < PALM) return; // a palm beside the pen
    app.sheet.focus({ preventScroll: true });
    const [x, y] = this.place(event);
    if (event.pointerType === "touch") {
      this.fingers.set(event.pointerId, { x, y });
      if (this.fingers.size === 2) return this.pinch();
      if (this.fingers.size > 2) return;
    }
    if (this.doing) return;
    app.sheet.setPointerCapture(event.pointerId);
    this.pointer = event.pointerId;
    this.start = this.last = [x, y];
    if (event.button === 1 || this.space || app.tool === "hand") return void (this.doing = "pan");
    if (event.button !== 0) return;
    const hit = this.vertexAt(x, y, this.near(event));
    if (hit && (app.tool === "draw" || app.tool === "edit")) return this.grasp(hit, event);
    if (app.tool === "draw") return this.beginStroke(event);
    if (app.tool === "edit") return this.beginSelection(x, y, event);
    if (app.tool === "knot") return this.knotAt(x, y, this.near(event) * 2);
    if (app.tool === "lens") this.chooseCurve(x, y, 40);
  }

  /** @param {PointerEvent} event */
  move(event) {
    const app = this.app;
    const [x, y] = this.place(event);
    if (event.pointerType === "pen") this.penSeen = event.timeStamp;
    if (this.fingers.has(event.pointerId)) {
      const before = this.spread();
      this.fingers.set(event.pointerId, { x, y });
      if (this.doing === "pinch") return this.pinched(before, this.spread());
    }
    if (!this.doing) return void (event.pointerType !== "touch" && app.hover(x, y));
    if (event.pointerId !== this.pointer) return;
    if (this.doing === "stroke") return this.addTo(event);
    const [dx, dy] = [x - this.last[0], y - this.last[1]];
    this.last = [x, y];
    if (this.doing === "pan") app.pan(dx, dy);
    if (this.doing === "drag") app.dragged(this.movedBy(x, y, event.shiftKey));
    if (this.doing === "select") app.rubber(this.start, [x, y]);
  }

  /** @param {PointerEvent} event */
  up(event) {
    this.fingers.delete(event.pointerId);
    if (this.doing === "pinch") {
      if (!this.fingers.size) this.doing = "";
      return;
    }
    if (event.pointerId !== this.pointer) return;
    const doing = this.doing;
    this.doing = "";
    const [x, y] = this.place(event);
    if (doing === "stroke") this.endStroke(event);
    if (doing === "drag") {
      const by = this.movedBy(x, y, event.shiftKey);
      if (by[0] || by[1]) this.app.drop(by);
      else this.app.dropped();
    }
    if (doing === "select") this.app.rubbed(this.start, [x, y], event.shiftKey);
  }

  /** @param {PointerEvent} event */
  cancel(event) {
    this.fingers.delete(event.pointerId);
    if (this.doing !== "pinch") this.stop();
    if (!this.fingers.size) this.doing = "";
  }

  /** Give up what the hand is doing. */
  stop() {
    if (this.doing === "drag") this.app.dropped();
    this.doing = "";
    this.path = [];
    this.app.inked();
  }

  /** @param {WheelEvent} event */
  wheel(event) {
    event.preventDefault();
    const box = this.app.sheet.getBoundingClientRect();
    const unit = event.deltaMode ? 24 : 1;
    if (event.ctrlKey || event.metaKey || (!event.deltaX && Math.abs(event.deltaY) >= 50 && !event.shiftKey))
      this.app.zoom(Math.exp((-event.deltaY * unit) / (event.ctrlKey ? 120 : 500)), event.clientX - box.left, event.clientY - box.top);
    else this.app.pan(-event.deltaX * unit, -event.deltaY * unit);
  }

  // ---- strokes ------------------------------------------------------------------------------------------------------

  /** @param {PointerEvent} event */
  beginStroke(event) {
    this.doing = "stroke";
    this.path = [this.place(event)];
    this.pressure = event.pointerType === "pen" ? [event.pressure] : null;
  }

  /** @param {PointerEvent} event */
  addTo(event) {
    if (event.shiftKey) {
      this.path = [this.start, this.snapped(this.place(event))];
      this.pressure &&= [event.pressure, event.pressure];
    } else {
      const between = event.getCoalescedEvents?.() ?? [];
      for (const each of between.length ? between : [event]) {
        const p = this.place(each), q = this.path[this.path.length - 1];
        if (Math.hypot(p[0] - q[0], p[1] - q[1]) < 1) continue;
        this.path.push(p);
        this.pressure?.push(each.pressure);
      }
    }
    this.app.inked(false);
  }

  /**
   * The end of a straight line, turned to a multiple of 15 degrees.
   * @param {number[]} to
   */
  snapped(to) {
    const [dx, dy] = [to[0] - this.start[0], to[1] - this.start[1]];
    const angle = (Math.round((Math.atan2(dy, dx) * 12) / Math.PI) * Math.PI) / 12;
    const length = Math.hypot(dx, dy);
    return [this.start[0] + length * Math.cos(angle), this.start[1] + length * Math.sin(angle)];
  }

  /** @param {PointerEvent} event */
  endStroke(event) {
    const path = this.path, pressure = this.pressure;
    this.path = [];
    if (path.length < 2) {
      this.app.inked();
      return this.tap(event);
    }
    this.app.drawn(path.map(([x, y]) => this.app.camera.toPlane(x, y)), pressure);
  }

  /**
   * A tap without a stroke chooses a curve; with Alt it puts a vertex at the end.
   * @param {PointerEvent} event
   */
  tap(event) {
    const [x, y] = this.place(event);
    if (event.altKey) return this.app.put(this.app.camera.toPlane(x, y));
    this.chooseCurve(x, y, this.near(event) * 1.5);
  }

  // ---- vertices -----------------------------------------------------------------------------------------------------

  /**
   * The vertex at a place: of the chosen curve first.
   * @param {number} x
   * @param {number} y
   * @param {number} near
   */
  vertexAt(x, y, near) {
    const { drawing, camera, selected } = this.app;
    if (!this.app.shows("polygon")) return null;
    let best = null, least = near;
    drawing.curves.forEach((curve, index) => {
      if (index !== selected && this.app.tool !== "edit") return;
      curve.points.forEach((p, vertex) => {
        const [sx, sy] = camera.toScreen(p);
        const away = Math.hypot(sx - x, sy - y) + (index === selected ? 0 : 2);
        if (away <= least) [best, least] = [{ index, vertex }, away];
      });
    });
    return /** @type {{index: number, vertex: number} | null} */ (best);
  }

  /** @param {{index: number, vertex: number}} hit @param {PointerEvent} event */
  grasp({ index, vertex }, event) {
    const app = this.app;
    if (index !== app.selected) app.choose(index);
    if (event.shiftKey && app.tool === "edit") {
      if (!app.vertices.delete(vertex)) app.vertices.add(vertex);
      return app.chosen();
    }
    if (!app.vertices.has(vertex)) app.vertices = new Set([vertex]);
    this.doing = "drag";
    app.chosen();
  }

  /** @param {number} x @param {number} y @param {boolean} snap @returns {[number, number]} */
  movedBy(x, y, snap) {
    let [dx, dy] = [x - this.start[0], y - this.start[1]];
    if (snap) Math.abs(dx) > Math.abs(dy) ? (dy = 0) : (dx = 0);
    return [dx / this.app.camera.scale, -dy / this.app.camera.scale];
  }

  /** @param {number} x @param {number} y @param {PointerEvent} event */
  beginSelection(x, y, event) {
    if (!event.shiftKey) this.app.vertices = new Set();
    this.chooseCurve(x, y, this.near(event) * 1.5);
    this.doing = "select";
  }

  /** @param {number} x @param {number} y @param {number} near */
  chooseCurve(x, y, near) {
    const hit = this.curveAt(x, y, near);
    if (hit) this.app.choose(hit.index);
  }

  /** @param {number} x @param {number} y @param {number} near */
  curveAt(x, y, near) {
    const { drawing, camera } = this.app;
    const p = camera.toPlane(x, y);
    let best = null, least = near / camera.scale;
    drawing.curves.forEach((curve, index) => {
      const found = nearest(curve, p);
      if (found.away <= least) [best, least] = [{ index, ...found }, found.away];
    });
    return /** @type {{index: number, away: number, u: number, point: number[]} | null} */ (best);
  }

  /** @param {number} x @param {number} y @param {number} near */
  knotAt(x, y, near) {
    const hit = this.curveAt(x, y, near);
    if (hit) this.app.insertKnot(hit.index, hit.u);
    else this.app.say("", "Point at the curve, where the knot is to go.");
  }

  // ---- two fingers --------------------------------------------------------------------------------------------------

  pinch() {
    if (this.doing === "stroke" || this.doing === "drag" || this.doing === "select") this.stop();
    this.doing = "pinch";
  }

  spread() {
    const [a, b] = [...this.fingers.values()];
    return b ? { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, size: Math.hypot(a.x - b.x, a.y - b.y) || 1 } : { x: a.x, y: a.y, size: 1 };
  }

  /** @param {{x: number, y: number, size: number}} before @param {{x: number, y: number, size: number}} after */
  pinched(before, after) {
    this.app.pan(after.x - before.x, after.y - before.y);
    if (this.fingers.size > 1) this.app.zoom(after.size / before.size, after.x, after.y);
  }
}
