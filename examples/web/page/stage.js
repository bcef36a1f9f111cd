// Draws the acrobot over the trail of its tip.

import { color } from "./plot.js";

/** The number of frames after which a part of the trail disappears. */
const TRAIL = 90;

export class Stage {
  #picture = document.querySelector("#picture");
  #trail = document.querySelector("#trail");
  /** Recent positions of the tip, [x, y] in m. */
  #tips = [];

  clearTrail() {
    this.#tips = [];
  }

  /** Draws a game at a part of its last step, from 0 to 1. */
  draw(game, part, withTrail) {
    const side = Math.max(Math.round(this.#picture.clientWidth * devicePixelRatio), 1);
    for (const canvas of [this.#picture, this.#trail]) {
      if (canvas.width !== side) canvas.width = canvas.height = side;
    }
    const [target, link, joint, torque] = ["--text", "--link", "--joint", "--torque"].map(color);
    game.draw(this.#picture.getContext("2d"), part, { background: "transparent", target, link, joint, torque });

    const { length1, length2 } = game.params;
    // The scale of the package's picture.
    const metre = side / 2 / (length1 + length2 + 0.2);
    const { theta1, theta2 } = game.between(part);
    const x = length1 * Math.sin(theta1) + length2 * Math.sin(theta1 + theta2);
    const y = -length1 * Math.cos(theta1) - length2 * Math.cos(theta1 + theta2);
    const last = this.#tips.at(-1);
    if (last === undefined || Math.hypot(x - last[0], y - last[1]) * metre > 1) this.#tips.push([x, y]);
    this.#tips.splice(0, this.#tips.length - TRAIL);
    const context = this.#trail.getContext("2d");
    context.clearRect(0, 0, side, side);
    if (!withTrail) return;
    context.strokeStyle = color("--trail");
    context.lineWidth = metre / 30;
    for (let i = 1; i < this.#tips.length; i++) {
      context.globalAlpha = (0.7 * i) / this.#tips.length;
      context.beginPath();
      for (const [x, y] of this.#tips.slice(i - 1, i + 1)) context.lineTo(side / 2 + metre * x, side / 2 - metre * y);
      context.stroke();
    }
  }
}
