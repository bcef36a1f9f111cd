// Draws the acrobot over the trail of its tip.

import { color } from "./plot.js";

/** The trail's time in s, and its number of points. */
const [TRAIL, POINTS] = [1.5, 90];

const [picture, trail] = ["#picture", "#trail"].map((id) => document.querySelector(id));

/** Draws a game at a part of its last step, from 0 to 1. */
export function drawStage(game, part, withTrail) {
  const side = Math.max(Math.round(picture.clientWidth * devicePixelRatio), 1);
  for (const canvas of [picture, trail]) {
    if (canvas.width !== side) canvas.width = canvas.height = side;
  }
  const [target, link, joint, torque] = ["--text", "--link", "--joint", "--torque"].map(color);
  const colors = { background: "transparent", target, link, joint, torque };
  game.draw(picture.getContext("2d"), part, colors);

  // The scale of the package's picture.
  const metre = side / 2 / (game.params.length1 + game.params.length2 + 0.2);
  const context = trail.getContext("2d");
  context.clearRect(0, 0, side, side);
  if (!withTrail) return;
  context.strokeStyle = color("--trail");
  context.lineWidth = metre / 30;
  const points = game.trail(part, TRAIL, POINTS);
  for (let i = 1; i < points.length; i++) {
    context.globalAlpha = 0.7 * (1 - i / POINTS);
    context.beginPath();
    for (const [x, y] of points.slice(i - 1, i + 1)) {
      context.lineTo(side / 2 + metre * x, side / 2 - metre * y);
    }
    context.stroke();
  }
}
