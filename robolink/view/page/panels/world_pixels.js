// Pixel layer of the world panel: beams, points and trails, written into one image a frame.

const BEAMS = 24; // of a scan that are drawn as lines
const EIGHTH = 0x1f1f1f1f;

/** Colour "#rrggbb" as one pixel of an ImageData. */
export function pixel(colour) {
  const value = parseInt(colour.slice(1), 16);
  return (0xff000000 | ((value & 0xff) << 16) | (value & 0xff00) | (value >> 16)) >>> 0;
}

/** The same pixel as a colour of the style sheet. */
export function shown(value) { return `rgba(${value & 255},${(value >> 8) & 255},${(value >> 16) & 255},${(value >>> 24) / 255})`; }

/** Colour "#rrggbb", translucent. */
export function faint(colour, alpha) { return `${colour}${Math.round(alpha * 255).toString(16).padStart(2, "0")}`; }

export class Pixels {
  constructor(view) {
    this.view = view;
    this.canvas = document.createElement("canvas");
    this.context = this.canvas.getContext("2d", { alpha: false, willReadFrequently: true });
    this.width = this.height = 0;
  }

  /** Follow the size of the view's canvas; true if it changed. */
  resize() {
    const { width, height } = this.view.canvas;
    if (width === this.width && height === this.height) return false;
    this.width = this.canvas.width = width;
    this.height = this.canvas.height = height;
    this.image = this.context.createImageData(width, height);
    this.pixels = new Uint32Array(this.image.data.buffer);
    this.ground = new Uint32Array(this.pixels.length);
    return true;
  }

  /** Take what was drawn into `context` as the ground that each frame begins with. */
  keepGround() {
    this.ground.set(new Uint32Array(this.context.getImageData(0, 0, this.width, this.height).data.buffer));
  }

  begin() { this.pixels.set(this.ground); }

  /** Draw a sequence of points [x0, y0, x1, y1 ...] in metres, with a colour for each or one for all; NaN is nowhere. */
  points(places, count, colours) {
    const { view, width, height, pixels } = this, { scale } = view;
    const left = width / 2 - view.x * scale, top = height / 2 + view.y * scale;
    const isOne = typeof colours === "number";
    for (let i = 0; i < count; i++) {
      const x = (left + places[2 * i] * scale) | 0, y = (top - places[2 * i + 1] * scale) | 0;
      if (x < 1 || y < 1 || x >= width || y >= height) continue;
      const at = y * width + x;
      pixels[at] = pixels[at - 1] = pixels[at - width] = pixels[at - width - 1] = isOne ? colours : colours[i];
    }
  }

  /** Draw the ends of beams from a place, and some beams. */
  fan({ x, y }, ends, colour) {
    const { view } = this, every = 2 * Math.ceil(ends.length / 2 / BEAMS), left = view.toX(x), top = view.toY(y);
    for (let i = 0; i < ends.length; i += every) this._beam(left, top, (ends[i] - x) * view.scale, (y - ends[i + 1]) * view.scale, colour);
    this.points(ends, ends.length / 2, colour);
  }

  /** Blend an eighth of a colour into the pixels of a line: four colours at once, which stay within their bytes. */
  _beam(x, y, dx, dy, colour) {
    const { width, height, pixels } = this, steps = Math.min(4096, Math.ceil(Math.max(Math.abs(dx), Math.abs(dy)))), part = (colour >>> 3) & EIGHTH;
    const ix = dx / steps, iy = dy / steps;
    for (let i = 0; i < steps; i++, x += ix, y += iy) {
      if (x < 0 || y < 0 || x >= width || y >= height) continue;
      const at = (y | 0) * width + (x | 0), before = pixels[at];
      pixels[at] = before - ((before >>> 3) & EIGHTH) + part;
    }
  }

  /** Draw a line into the ground, between two places in metres, with an edge that is seen on any floor. */
  groundLine(x0, y0, x1, y1, colour) {
    const { view } = this;
    for (const wide of [2, 1]) this.line(view.toX(x0), view.toY(y0), view.toX(x1), view.toY(y1), wide > 1 ? this.halo : colour, this.ground, wide);
  }

  /** Draw a line between two places in pixels, one or two pixels wide, into the picture or the ground. */
  line(ax, ay, bx, by, colour, pixels = this.pixels, wide = 2) {
    const { width, height } = this;
    if (Math.max(ax, bx) < 0 || Math.max(ay, by) < 0 || Math.min(ax, bx) >= width || Math.min(ay, by) >= height) return;
    const steps = Math.min(4096, Math.max(1, Math.ceil(Math.max(Math.abs(bx - ax), Math.abs(by - ay)))));
    const dx = (bx - ax) / steps, dy = (by - ay) / steps;
    for (let i = 0, x = ax, y = ay; i <= steps; i++, x += dx, y += dy) {
      if (x < 1 || y < 1 || x >= width || y >= height) continue;
      const at = (y | 0) * width + (x | 0);
      pixels[at] = colour;
      if (wide > 1) pixels[at - 1] = pixels[at - width] = colour;
    }
  }

  end() { this.context.putImageData(this.image, 0, 0); }
}
