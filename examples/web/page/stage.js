// Draws the acrobot in the page's colours.

import { color } from "./plot.js";

const picture = document.querySelector("#picture");

/** Draws a game at a part of its last step, from 0 to 1. */
export function drawStage(game, part) {
  const side = Math.max(Math.round(picture.clientWidth * devicePixelRatio), 1);
  if (picture.width !== side) picture.width = picture.height = side;
  const [target, link, joint, torque] = ["--text", "--link", "--joint", "--torque"].map(color);
  const colors = { background: "transparent", target, link, joint, torque };
  game.draw(picture.getContext("2d"), part, colors);
}
