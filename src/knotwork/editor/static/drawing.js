// The drawing as the page has it: arrays that the server patches.

/**
 * @typedef {{degree: number, closed: boolean, points: number[][], knots: number[], domain: number[],
 *   pieces: number[][], breaks: number[], nodes: number[]}} Curve
 */

const ARRAYS = ["points", "knots", "pieces", "breaks", "nodes"];

export class Drawing {
  constructor() {
    /** @type {Curve[]} */
    this.curves = [];
    this.revision = -1;
    /** @type {{curve: number, chain: number[][]} | null} */
    this.pending = null;
    this.undo = false;
    this.redo = false;
    this.degree = 3;
    this.spacing = "even";
    /** the curve before the last change: @type {{index: number, pieces: number[][]} | null} */
    this.ghost = null;
  }

  /**
   * Take in what changed.
   * @param {Record<string, any>} news
   */
  take(news) {
    const changed = news.curves.length === 1 ? news.curves[0].at : -1;
    const before = this.curves[changed];
    if (news.curves.length) this.ghost = before ? { index: changed, pieces: before.pieces } : null;
    for (const change of news.curves) {
      const old = change.whole ? null : this.curves[change.at];
      const curve = /** @type {any} */ (old ? { ...old } : {});
      for (const [name, value] of Object.entries(change)) {
        if (name === "at" || name === "whole") continue;
        if (!ARRAYS.includes(name)) curve[name] = value;
        else if (value.drop === null) curve[name] = value.put;
        else curve[name] = curve[name].slice(0, value.at).concat(value.put, curve[name].slice(value.at + value.drop));
      }
      this.curves[change.at] = curve;
    }
    this.curves.length = news.count;
    for (const name of ["revision", "pending", "undo", "redo", "degree", "spacing"]) {
      /** @type {any} */ (this)[name] = news[name];
    }
  }

  /**
   * The box of all control points, or null.
   * @returns {[number, number, number, number] | null}
   */
  box() {
    let [a, b, c, d] = [Infinity, Infinity, -Infinity, -Infinity];
    for (const { points } of this.curves)
      for (const [x, y] of points) {
        a = Math.min(a, x); b = Math.min(b, y); c = Math.max(c, x); d = Math.max(d, y);
      }
    return a <= c ? [a, b, c, d] : null;
  }
}

/**
 * The point of a cubic piece.
 * @param {number[]} p  its eight coordinates
 * @param {number} t  from 0 to 1
 */
export function at(p, t) {
  const s = 1 - t;
  const [a, b, c, d] = [s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t];
  return [a * p[0] + b * p[2] + c * p[4] + d * p[6], a * p[1] + b * p[3] + c * p[5] + d * p[7]];
}

/**
 * The nearest place on a curve.
 * @param {Curve} curve
 * @param {number[]} point
 * @returns {{away: number, u: number, point: number[]}}
 */
export function nearest(curve, point) {
  let best = { away: Infinity, u: 0, point };
  curve.pieces.forEach((p, i) => {
    const reach = Math.max(Math.hypot(p[2] - p[0], p[3] - p[1]), Math.hypot(p[4] - p[0], p[5] - p[1]), Math.hypot(p[6] - p[0], p[7] - p[1]));
    if (Math.hypot(p[0] - point[0], p[1] - point[1]) - reach > best.away) return;
    for (let k = 0; k <= 16; k++) {
      const q = at(p, k / 16);
      const away = Math.hypot(q[0] - point[0], q[1] - point[1]);
      if (away < best.away) best = { away, u: i + k / 16, point: q };
    }
  });
  const i = Math.min(Math.floor(best.u), curve.pieces.length - 1);
  let t = best.u - i;
  for (let step = 1 / 32; step > 1e-6; step /= 2)
    for (const s of [t - step, t + step]) {
      if (s < 0 || s > 1) continue;
      const q = at(curve.pieces[i], s);
      const away = Math.hypot(q[0] - point[0], q[1] - point[1]);
      if (away < best.away) { best = { away, u: 0, point: q }; t = s; }
    }
  const exact = curve.pieces.length === curve.breaks.length - 1;
  const [a, b] = exact ? [curve.breaks[i], curve.breaks[i + 1]] : curve.domain.map((x, k) => x + (curve.domain[1 - k] - x) * (k ? 1 - (i + 1) / curve.pieces.length : i / curve.pieces.length));
  return { ...best, u: a + t * (b - a) };
}
