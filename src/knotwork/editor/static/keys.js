// The keyboard: everything that the hand can do.

/** @typedef {import("./app.js").App} App */

/** @type {[string, string][]} */
export const KEYS = [
  ["P V K L H", "draw, edit, knot, look, pan"],
  ["Tab, Shift+Tab", "next, previous vertex; N, Shift+N: curve"],
  ["arrows", "move the chosen vertices; with Shift by ten"],
  ["Delete", "delete the chosen vertices; with Shift the knot there, keeping the shape"],
  ["A", "add a vertex at the end, one step on"],
  ["Enter, Esc", "end a pending region; give up"],
  ["Ctrl+Z, Ctrl+Shift+Z", "undo, redo"],
  ["Ctrl+A", "choose all vertices"],
  ["C", "close the curve, or open it"],
  ["1 … 9", "degree of the curve"],
  ["+ − 0", "larger, smaller, everything"],
  ["space", "held: move the sheet"],
  ["Shift", "held: straight, in steps of 15 degrees"],
  ["Alt", "with a click: put a vertex at the end"],
  ["I, ?", "curve panel, this list"],
  ["Ctrl+O", "drawings"],
];

/** @param {App} app */
export function listen(app) {
  document.addEventListener("keyup", (event) => {
    if (event.key === " ") app.hand.space = false;
  });
  document.addEventListener("keydown", (event) => {
    const on = /** @type {HTMLElement} */ (event.target);
    if (document.querySelector("dialog[open]") || on.closest("input:not([type=checkbox]), select, #knotline")) return;
    const command = event.ctrlKey || event.metaKey;
    if (act(app, event, command, on)) event.preventDefault();
  });
}

/**
 * @param {App} app @param {KeyboardEvent} event @param {boolean} command @param {HTMLElement} on
 * @returns {boolean} whether the key was ours
 */
function act(app, event, command, on) {
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  if (command) {
    if (key === "z") app.history(event.shiftKey ? "redo" : "undo");
    else if (key === "y") app.history("redo");
    else if (key === "o") app.documents.show();
    else if (key === "a") app.chooseAll();
    else return false;
    return true;
  }
  const onSheet = on === app.sheet || on === document.body;
  /** @type {Record<string, () => void>} */
  const plain = {
    p: () => app.setTool("draw"), v: () => app.setTool("edit"), k: () => app.setTool("knot"), l: () => app.setTool("lens"), h: () => app.setTool("hand"),
    n: () => app.chooseNext(event.shiftKey ? -1 : 1),
    a: () => app.appendByKey(),
    c: () => app.toggleClosed(),
    i: () => app.togglePanel(),
    "?": () => app.showKeys(),
    "+": () => app.zoom(1.25), "=": () => app.zoom(1.25), "-": () => app.zoom(0.8), 0: () => app.showAll(),
    Escape: () => app.escape(),
    Delete: () => app.remove(event.shiftKey), Backspace: () => app.remove(event.shiftKey),
  };
  if (/^[1-9]$/.test(key)) return app.setDegree(Number(key)), true;
  if (key in plain) return plain[key](), true;
  if (!onSheet) return false;
  if (key === " ") return (app.hand.space = true);
  if (key === "Enter") return app.settle(), true;
  if (key === "Tab" && app.drawing.curves.length && !(event.shiftKey ? app.atFirstVertex() : app.atLastVertex())) return app.nextVertex(event.shiftKey ? -1 : 1), true;
  /** @type {Record<string, [number, number]>} */
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  if (key in arrows && app.vertices.size) return app.nudge(arrows[key], event.shiftKey ? 10 : 1), true;
  return false;
}
