// The curves on their canvas, the marks (polygon, vertices, knots, lenses) in SVG above it.

import { at } from "./drawing.js";

/** @typedef {import("./app.js").App} App */

const SVG = "http://www.w3.org/2000/svg";
/** vertices in sight up to which handles are drawn one by one */
export const HANDLES = 1500;
/** pixels below which the steps of a polygon or a curve are not told apart */
const FINE = 0.7;

/** @type {Map<string, string>} */
const colours = new Map();
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => colours.clear());

/** @param {string} name @returns {string} */
export function colour(name) {
  const known = colours.get(name);
  if (known) return known;
  const read = getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  colours.set(name, read);
  return read;
}

/**
 * A clean canvas of the size of the sheet. That is known: to ask the page for it here would have it laid out again.
 * @param {HTMLCanvasElement} canvas @param {App["camera"]} camera @returns {CanvasRenderingContext2D}
 */
function fitted(canvas, { width: w, height: h }) {
  const ratio = devicePixelRatio || 1;
  if (canvas.width !== Math.round(w * ratio) || canvas.height !== Math.round(h * ratio)) {
    canvas.width = Math.round(w * ratio);
    canvas.height = Math.round(h * ratio);
  }
  const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, w, h);
  return pen;
}

/** @param {App} app */
export function paint(app) {
  const { camera, drawing } = app;
  const pen = fitted(app.canvas, camera);
  pen.lineJoin = pen.lineCap = "round";
  grid(pen, camera);
  if (app.shows("ghost") && drawing.ghost) trace(pen, camera, drawing.ghost.pieces, colour("ghost"), 2);
  if (app.preview && drawing.curves[app.selected]) {
    trace(pen, camera, drawing.curves[app.selected].pieces, colour("band"), Math.max(2, 2 * app.preview.tolerance * camera.scale));
  }
  drawing.curves.forEach((curve, i) => {
    const chosen = i === app.selected;
    trace(pen, camera, curve.pieces, colour(chosen ? "chosen" : "curve"), chosen ? 2.5 : 2);
  });
  if (app.preview) trace(pen, camera, app.preview.pieces, colour("preview"), 2);
  marks(app);
}

/**
 * A quiet grid, a line every power of ten.
 * @param {CanvasRenderingContext2D} pen
 * @param {App["camera"]} camera
 */
function grid(pen, camera) {
  const step = 10 ** Math.ceil(Math.log10(36 / camera.scale));
  const [left, top] = camera.toPlane(0, 0);
  const [right, bottom] = camera.toPlane(camera.width, camera.height);
  pen.fillStyle = colour("grid");
  for (let x = Math.ceil(left / step) * step; x <= right; x += step)
    for (let y = Math.ceil(bottom / step) * step; y <= top; y += step) {
      const [sx, sy] = camera.toScreen([x, y]);
      pen.fillRect(sx - 0.75, sy - 0.75, 1.5, 1.5);
    }
}

/**
 * Draw cubic pieces: those in sight, and those shorter than a pixel as one line.
 * @param {CanvasRenderingContext2D} pen @param {App["camera"]} camera
 * @param {number[][]} pieces @param {string} ink @param {number} width
 */
function trace(pen, camera, pieces, ink, width) {
  const { scale, x: cx, y: cy, width: w, height: h } = camera;
  const ox = w / 2 - cx * scale, oy = h / 2 + cy * scale;
  pen.strokeStyle = ink;
  pen.lineWidth = width;
  pen.beginPath();
  let [ex, ey] = [NaN, NaN]; // where the last piece ends
  let [px, py] = [NaN, NaN]; // where the pen is
  for (const p of pieces) {
    const ax = ox + p[0] * scale, bx = ox + p[2] * scale, dx = ox + p[4] * scale, fx = ox + p[6] * scale;
    const ay = oy - p[1] * scale, by = oy - p[3] * scale, dy = oy - p[5] * scale, fy = oy - p[7] * scale;
    const jump = p[0] !== ex || p[1] !== ey;
    ex = p[6];
    ey = p[7];
    const [left, right, top, bottom] = [Math.min(ax, bx, dx, fx), Math.max(ax, bx, dx, fx), Math.min(ay, by, dy, fy), Math.max(ay, by, dy, fy)];
    if (right < -width || left > w + width || bottom < -width || top > h + width) {
      if (px === px) pen.lineTo(ax, ay);
      px = py = NaN;
      continue;
    }
    if (jump || px !== px) pen.moveTo((px = ax), (py = ay));
    if (Math.max(Math.abs(left - px), Math.abs(right - px), Math.abs(top - py), Math.abs(bottom - py)) < FINE && !jump) continue;
    pen.bezierCurveTo(bx, by, dx, dy, (px = fx), (py = fy));
  }
  pen.stroke();
}

/** @param {string} name @param {Record<string, string | number>} attributes @param {string} [text] */
export function element(name, attributes, text) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  if (text !== undefined) made.textContent = text;
  return made;
}

/**
 * A polygon as the text of a path: only what is in sight, and steps shorter than a pixel as one.
 * @param {App["camera"]} camera @param {number[][]} points
 */
function path(camera, points) {
  const { scale, width: w, height: h } = camera, last = points.length - 1;
  const ox = w / 2 - camera.x * scale, oy = h / 2 + camera.y * scale;
  let d = "", pen = "M", px = NaN, py = NaN, x = 0, y = 0;
  for (let i = 0; i <= last; i++) {
    const bx = x, by = y;
    x = ox + points[i][0] * scale;
    y = oy - points[i][1] * scale;
    if (!i || Math.max(x, bx) < 0 || Math.min(x, bx) > w || Math.max(y, by) < 0 || Math.min(y, by) > h) {
      if (i && pen === "L") d += `L${bx.toFixed(1)} ${by.toFixed(1)}`;
      pen = "M";
      continue;
    }
    if (pen === "M") d += `M${bx.toFixed(1)} ${by.toFixed(1)}`;
    if (pen === "L" && i < last && Math.abs(x - px) < FINE && Math.abs(y - py) < FINE) continue;
    d += `L${x.toFixed(1)} ${y.toFixed(1)}`;
    pen = "L";
    px = x;
    py = y;
  }
  return d;
}

/**
 * The marks, a few paths however many they are: an element for each would take a frame of its own.
 * @param {App} app
 */
function marks(app) {
  const { camera, drawing } = app;
  const made = document.createDocumentFragment();
  drawing.curves.forEach((curve, i) => {
    const chosen = i === app.selected;
    if (app.shows("polygon")) {
      const points = app.pointsOf(i), round = curve.closed ? [...points, points[0]] : points;
      made.append(element("path", { d: path(camera, round), class: chosen ? "polygon chosen" : "polygon" }));
    }
    if (!chosen) return;
    if (app.shows("knots")) {
      const inner = curve.closed ? curve.pieces : curve.pieces.slice(1);
      made.append(dots(camera, inSight(camera, inner).map((k) => inner[k]), 2.6, "knot"));
    }
    if (app.shows("comb") && app.lens.comb) comb(made, app);
    if (app.shows("nodes") && app.lens.nodes)
      made.append(dots(camera, inSight(camera, app.lens.nodes).map((k) => app.lens.nodes[k]), 2.4, "node"));
    const points = app.pointsOf(i), seen = inSight(camera, points);
    made.append(dots(camera, seen.filter((k) => !app.vertices.has(k)).map((k) => points[k]), 4.5, "vertex"));
    made.append(dots(camera, seen.filter((k) => app.vertices.has(k)).map((k) => points[k]), 6, "vertex chosen"));
    if (app.shows("blossoms") && app.lens.blossoms)
      for (const k of seen) if (app.lens.blossoms[k]) made.append(label(camera, points[k], app.lens.blossoms[k].join(" ")));
  });
  if (drawing.pending) {
    made.append(element("path", { d: path(camera, drawing.pending.chain), class: "pending" }));
    made.append(dots(camera, drawing.pending.chain, 3, "pending"));
  }
  triangle(made, app);
  if (app.boehm) boehm(made, app);
  app.marks.replaceChildren(made);
}

/**
 * Which points are in sight: their indices, or none where they are too many to be told apart.
 * @param {App["camera"]} camera @param {number[][]} points
 */
function inSight(camera, points) {
  /** @type {number[]} */
  const seen = [];
  const [left, bottom] = camera.toPlane(-20, camera.height + 20), [right, top] = camera.toPlane(camera.width + 20, -20);
  for (let k = 0; k < points.length && seen.length <= HANDLES; k++) {
    const p = points[k];
    if (p[0] > left && p[0] < right && p[1] > bottom && p[1] < top) seen.push(k);
  }
  return seen.length <= HANDLES ? seen : [];
}

/** @param {App["camera"]} camera @param {number[][]} points @param {number} r @param {string} kind */
function dots(camera, points, r, kind) {
  const turn = `a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0`;
  const d = points.map((p) => {
    const [x, y] = camera.toScreen(p);
    return `M${(x - r).toFixed(1)} ${y.toFixed(1)}${turn}`;
  });
  return element("path", { d: d.join(""), class: `dots ${kind}` });
}

/** @param {App["camera"]} camera @param {number[]} p @param {string} text */
function label(camera, p, text) {
  const [x, y] = camera.toScreen(p);
  return element("text", { x: (x + 8).toFixed(1), y: (y - 8).toFixed(1), class: "label" }, text);
}

/**
 * De Boor's triangle at the pointer, each point with the arguments of its blossom.
 * @param {DocumentFragment} into
 * @param {App} app
 */
function triangle(into, app) {
  const told = app.lens.triangle;
  if (!told) return;
  told.levels.forEach((/** @type {number[][]} */ level, /** @type {number} */ r) => {
    const kind = `level level-${Math.min(r, 4)}`;
    into.append(element("path", { d: path(app.camera, level), class: kind }));
    into.append(dots(app.camera, level, r === told.levels.length - 1 ? 5.5 : 3.2, kind));
    level.forEach((p, q) => into.append(label(app.camera, p, told.arguments[r][q].join(" "))));
  });
}

/**
 * Boehm's construction: new vertices on the sides of the old polygon.
 * @param {DocumentFragment} into
 * @param {App} app
 */
function boehm(into, app) {
  const { steps, shown } = /** @type {any} */ (app.boehm);
  steps.slice(0, shown).forEach((/** @type {any} */ step) => {
    into.append(element("path", { d: path(app.camera, [step.from, step.to]), class: "side" }));
    into.append(dots(app.camera, [step.point], 5, "boehm"));
    into.append(label(app.camera, step.point, step.share.toFixed(3).replace(/0+$/, "").replace(/\.$/, "")));
  });
}

/** @param {DocumentFragment} into @param {App} app */
function comb(into, app) {
  const { points, normals, curvature } = app.lens.comb;
  const most = curvature.reduce((/** @type {number} */ least, /** @type {number} */ k) => Math.max(least, Math.abs(k)), 1e-300);
  const ends = points.map((/** @type {number[]} */ p, /** @type {number} */ i) => {
    const length = (70 / app.camera.scale) * (curvature[i] / most);
    return [p[0] - normals[i][0] * length, p[1] - normals[i][1] * length];
  });
  let teeth = "";
  points.forEach((/** @type {number[]} */ p, /** @type {number} */ i) => (teeth += path(app.camera, [p, ends[i]])));
  into.append(element("path", { d: teeth, class: "teeth" }), element("path", { d: path(app.camera, ends), class: "comb" }));
}

/** how much of which stroke is on its canvas */
let inked = { path: /** @type {number[][]} */ ([]), to: 0 };

/**
 * The stroke that is being drawn, wider where the pen presses: what came since the last time, or all of it anew.
 * @param {App} app @param {boolean} [anew]
 */
export function ink(app, anew = true) {
  const { path: drawn, pressure } = app.hand;
  if (anew || inked.path !== drawn) inked = { path: drawn, to: 0 };
  const pen = inked.to ? /** @type {CanvasRenderingContext2D} */ (app.ink.getContext("2d")) : fitted(app.ink, app.camera);
  pen.strokeStyle = colour("ink");
  pen.lineCap = pen.lineJoin = "round";
  for (let i = inked.to + 1; i < drawn.length; i++) {
    pen.lineWidth = pressure ? 1 + 5 * pressure[i] : 2.5;
    pen.beginPath();
    pen.moveTo(drawn[i - 1][0], drawn[i - 1][1]);
    pen.lineTo(drawn[i][0], drawn[i][1]);
    pen.stroke();
  }
  inked.to = Math.max(0, drawn.length - 1);
}

export { at };
