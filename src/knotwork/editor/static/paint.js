// The curves on their canvas, the marks (polygon, vertices, knots, lenses) in SVG above it.

import { at } from "./drawing.js";

/** @typedef {import("./app.js").App} App */

const SVG = "http://www.w3.org/2000/svg";
/** vertices in sight up to which handles are drawn one by one */
const HANDLES = 1500;
/** pixels below which the steps of a polygon or a curve are not told apart */
const FINE = 0.7;

/** @param {string} name */
export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

/** @param {HTMLCanvasElement} canvas @returns {CanvasRenderingContext2D} */
export function fitted(canvas) {
  const ratio = devicePixelRatio || 1;
  const { clientWidth: w, clientHeight: h } = canvas;
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
  const pen = fitted(app.canvas);
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
  const { width: w, height: h } = camera, last = points.length - 1;
  let d = "", pen = "M", [px, py] = [NaN, NaN];
  /** @type {[number, number]} */
  let before = [0, 0];
  for (let i = 0; i <= last; i++) {
    const p = camera.toScreen(points[i]), [x, y] = p, [bx, by] = before;
    before = p;
    if (!i || Math.max(x, bx) < 0 || Math.min(x, bx) > w || Math.max(y, by) < 0 || Math.min(y, by) > h) {
      if (i && pen === "L") d += `L${bx.toFixed(1)} ${by.toFixed(1)}`;
      pen = "M";
      continue;
    }
    if (pen === "M") d += `M${bx.toFixed(1)} ${by.toFixed(1)}`;
    if (pen === "L" && i < last && Math.abs(x - px) < FINE && Math.abs(y - py) < FINE) continue;
    d += `L${x.toFixed(1)} ${y.toFixed(1)}`;
    pen = "L";
    [px, py] = p;
  }
  return d;
}

/** @param {App} app */
function marks(app) {
  const { camera, drawing } = app;
  const made = document.createDocumentFragment();
  drawing.curves.forEach((curve, i) => {
    const chosen = i === app.selected;
    if (app.shows("polygon")) {
      const round = curve.closed ? [...curve.points, curve.points[0]] : curve.points;
      made.append(element("path", { d: path(camera, round), class: chosen ? "polygon chosen" : "polygon" }));
    }
    if (!chosen) return;
    if (app.shows("knots"))
      for (const k of inSight(camera, curve.pieces)) if (k || curve.closed) dot(made, camera, curve.pieces[k], 2.6, "knot");
    if (app.shows("comb") && app.lens.comb) comb(made, app);
    if (app.shows("nodes") && app.lens.nodes)
      for (const k of inSight(camera, app.lens.nodes)) dot(made, camera, app.lens.nodes[k], 2.4, "node");
    for (const k of inSight(camera, curve.points)) {
      const p = curve.points[k];
      dot(made, camera, p, app.vertices.has(k) ? 6 : 4.5, app.vertices.has(k) ? "vertex chosen" : "vertex");
      const letters = app.shows("blossoms") && app.lens.blossoms?.[k];
      if (letters) made.append(label(camera, p, letters.join(" ")));
    }
  });
  if (drawing.pending) {
    made.append(element("path", { d: path(camera, drawing.pending.chain), class: "pending" }));
    for (const p of drawing.pending.chain) dot(made, camera, p, 3, "pending");
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
  for (let k = 0; k < points.length && seen.length <= HANDLES; k++) {
    const [x, y] = camera.toScreen(points[k]);
    if (x > -20 && y > -20 && x < camera.width + 20 && y < camera.height + 20) seen.push(k);
  }
  return seen.length <= HANDLES ? seen : [];
}

/** @param {DocumentFragment} into @param {App["camera"]} camera @param {number[]} p @param {number} r @param {string} kind */
function dot(into, camera, p, r, kind) {
  const [cx, cy] = camera.toScreen(p);
  into.append(element("circle", { cx: cx.toFixed(1), cy: cy.toFixed(1), r, class: kind }));
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
    into.append(element("path", { d: path(app.camera, level), class: `level level-${Math.min(r, 4)}` }));
    level.forEach((p, q) => {
      dot(into, app.camera, p, r === told.levels.length - 1 ? 5.5 : 3.2, `level level-${Math.min(r, 4)}`);
      into.append(label(app.camera, p, told.arguments[r][q].join(" ")));
    });
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
    dot(into, app.camera, step.point, 5, "boehm");
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

/**
 * The stroke that is being drawn, wider where the pen presses.
 * @param {App} app
 */
export function ink(app) {
  const pen = fitted(app.ink);
  const { path: drawn, pressure } = app.hand;
  if (drawn.length < 1) return;
  pen.strokeStyle = colour("ink");
  pen.lineCap = pen.lineJoin = "round";
  for (let i = 1; i < drawn.length; i++) {
    pen.lineWidth = pressure ? 1 + 5 * pressure[i] : 2.5;
    pen.beginPath();
    pen.moveTo(drawn[i - 1][0], drawn[i - 1][1]);
    pen.lineTo(drawn[i][0], drawn[i][1]);
    pen.stroke();
  }
}

/**
 * The knots below the sheet, and the basis functions over them.
 * @param {App} app
 */
export function knotline(app) {
  const svg = app.knotline;
  const curve = app.drawing.curves[app.selected];
  svg.parentElement?.classList.toggle("shown", !!curve && app.shows("knots"));
  svg.parentElement?.classList.toggle("tall", app.shows("functions"));
  if (!curve) return svg.replaceChildren();
  const width = svg.clientWidth || 600, height = svg.clientHeight || 60, base = height - 22;
  const [a, b] = [curve.knots[0], curve.knots[curve.knots.length - 1]];
  const x = (/** @type {number} */ u) => 24 + ((u - a) / (b - a || 1)) * (width - 48);
  const made = document.createDocumentFragment();
  if (app.shows("functions") && app.lens.functions) {
    const { u, functions } = app.lens.functions;
    functions.forEach((/** @type {any} */ f, /** @type {number} */ i) => {
      const d = f.values.map((/** @type {number} */ y, /** @type {number} */ k) => `${k ? "L" : "M"}${x(u[f.at + k]).toFixed(1)} ${(base - y * (base - 8)).toFixed(1)}`).join("");
      made.append(element("path", { d, class: app.vertices.has(i) ? "function chosen" : "function" }));
    });
  }
  made.append(element("path", { d: `M${x(a)} ${base}H${x(b)}`, class: "axis" }));
  if (app.shows("nodes")) for (const u of curve.nodes) if (u <= b) made.append(element("circle", { cx: x(u), cy: base, r: 3, class: "node" }));
  /** @type {Map<number, number>} */
  const seen = new Map();
  if (curve.knots.length <= HANDLES)
    curve.knots.forEach((u, i) => {
      const copies = seen.get(u) ?? 0;
      seen.set(u, copies + 1);
      const inner = curve.closed ? i > 0 && i < curve.knots.length - 1 : i > curve.degree && i < curve.knots.length - curve.degree - 1;
      const mark = element("circle", { cx: x(u).toFixed(1), cy: base - copies * 9, r: 4.5, class: inner ? "knot inner" : "knot", "data-knot": i, tabindex: inner ? 0 : -1, role: "slider", "aria-label": `knot ${i}`, "aria-valuenow": u, "aria-valuetext": String(+u.toPrecision(6)) });
      mark.append(element("title", {}, String(+u.toPrecision(6))));
      made.append(mark);
    });
  made.append(element("text", { x: x(a), y: height - 4, class: "end" }, String(+a.toPrecision(4))), element("text", { x: x(b), y: height - 4, class: "end last" }, String(+b.toPrecision(4))));
  svg.replaceChildren(made);
}

export { at };
