// Draws the acrobot, which the module paints, over the trail of its tip.

import { color } from "./plot.js";

/** The picture's maximum width and height in pixels: the module has no more memory. */
const SIDE = 1024;
/** The number of frames after which a part of the trail disappears. */
const TRAIL = 90;

export class Stage {
  #acrobot;
  #picture = document.querySelector("#picture");
  #trail = document.querySelector("#trail");
  #pixels;
  /** Recent positions of the tip, [x, y] in m. */
  #tips = [];

  constructor(acrobot) {
    this.#acrobot = acrobot;
    this.#fit();
    this.repaint();
    new ResizeObserver(() => this.#fit()).observe(this.#picture);
  }

  /** At least two pixels for each CSS pixel, for smooth edges on any display. */
  #fit() {
    const side = Math.min(Math.max(Math.round(this.#picture.clientWidth * Math.max(devicePixelRatio, 2)), 1), SIDE);
    if (side === this.#pixels?.width) return;
    this.#pixels = this.#acrobot.resize(side);
    for (const canvas of [this.#picture, this.#trail]) canvas.width = canvas.height = side;
  }

  /** Paints in the current colours of the style sheet, which the colour scheme changes. */
  repaint() {
    const colors = ["--line", "--link", "--joint", "--torque"].map((name) => {
      const [red, green, blue] = color(name).match(/\w\w/g).map((digits) => parseInt(digits, 16));
      return ((255 << 24) | (blue << 16) | (green << 8) | red) >>> 0;
    });
    this.#acrobot.paint(...colors);
  }

  clearTrail() {
    this.#tips = [];
  }

  /** Draws the acrobot at a part of its last step, from 0 to 1. `reach` is the total length of the links, m. */
  draw(part, reach, withTrail) {
    const half = this.#pixels.width / 2;
    // The scale of the crate's picture.
    const metre = half / (reach + 0.2);
    const [x, y] = this.#acrobot.draw(part);
    this.#picture.getContext("2d").putImageData(this.#pixels, 0, 0);

    const last = this.#tips.at(-1);
    if (last === undefined || Math.hypot(x - last[0], y - last[1]) * metre > 1) this.#tips.push([x, y]);
    this.#tips.splice(0, this.#tips.length - TRAIL);
    const context = this.#trail.getContext("2d");
    context.clearRect(0, 0, 2 * half, 2 * half);
    if (!withTrail) return;
    context.strokeStyle = color("--trail");
    context.lineWidth = metre / 30;
    for (let i = 1; i < this.#tips.length; i++) {
      context.globalAlpha = (0.7 * i) / this.#tips.length;
      context.beginPath();
      for (const [x, y] of this.#tips.slice(i - 1, i + 1)) context.lineTo(half + metre * x, half - metre * y);
      context.stroke();
    }
  }
}
