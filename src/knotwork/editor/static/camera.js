// Which part of the plane the sheet shows. The plane's y points up, the screen's down.

export class Camera {
  constructor() {
    this.x = 0;
    this.y = 0;
    this.scale = 1;
    this.width = 1;
    this.height = 1;
  }

  /** @param {number[]} p @returns {[number, number]} */
  toScreen([x, y]) {
    return [(x - this.x) * this.scale + this.width / 2, this.height / 2 - (y - this.y) * this.scale];
  }

  /** @param {number} x @param {number} y @returns {[number, number]} */
  toPlane(x, y) {
    return [(x - this.width / 2) / this.scale + this.x, (this.height / 2 - y) / this.scale + this.y];
  }

  /**
   * Move by pixels.
   * @param {number} dx
   * @param {number} dy
   */
  pan(dx, dy) {
    this.x -= dx / this.scale;
    this.y += dy / this.scale;
  }

  /**
   * Scale about a place on the screen.
   * @param {number} factor
   * @param {number} x
   * @param {number} y
   */
  zoom(factor, x = this.width / 2, y = this.height / 2) {
    const [px, py] = this.toPlane(x, y);
    this.scale = Math.min(1e9, Math.max(1e-9, this.scale * factor));
    const [qx, qy] = this.toPlane(x, y);
    this.x += px - qx;
    this.y += py - qy;
  }

  /**
   * Show a box in what is free of the sheet.
   * @param {number[] | null} box  its lower left and upper right corner
   * @param {{right: number, bottom: number}} covered  pixels at the sides that something else covers
   */
  show(box, { right, bottom }) {
    if (!box) return;
    const [a, b, c, d] = box, width = this.width - right, height = this.height - bottom;
    const size = Math.max((c - a) / Math.max(width - 160, 80), (d - b) / Math.max(height - (bottom ? 160 : 260), 80));
    this.scale = size > 0 ? 1 / size : 1;
    this.x = (a + c) / 2 + right / 2 / this.scale;
    this.y = (b + d) / 2 - bottom / 2 / this.scale;
  }
}
