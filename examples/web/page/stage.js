// Draws the acrobot in the page's colours, the path of the tip to come, and the spring.

import { FULL } from "./game.js";
import { placeOf, placesOf } from "./push.js";
import { color } from "./plot.js";

const picture = document.querySelector("#picture");

/** The place in metres, y up, of a place in the picture in CSS pixels. */
export function placeAt(x, y, { length1, length2 }) {
  const side = picture.clientWidth;
  const metre = side / 2 / (length1 + length2 + 0.2);
  return [(x - side / 2) / metre, (side / 2 - y) / metre];
}

/**
 * Draws a game at a part of its last step, from 0 to 1, with the path of the tip to come, and with
 * what pulls: a `point` of a link and a `target`, or null.
 */
export function drawStage(game, part, path, pulled) {
  const side = Math.max(Math.round(picture.clientWidth * devicePixelRatio), 1);
  if (picture.width !== side) picture.width = picture.height = side;
  const names = ["--text", "--link", "--joint", "--torque", "--accent", "--second"];
  const [target, link, joint, torque, accent, second] = names.map(color);
  // The arrow fades with the torque.
  const share = Math.round((255 * Math.abs(game.levels.at(-1) ?? 0)) / FULL);
  const faded = `${torque}${share.toString(16).padStart(2, "0")}`;
  const context = picture.getContext("2d");
  const colors = { background: "transparent", target, link, joint, torque: faded };
  const acrobot = game.between(part);
  acrobot.draw(context, { colors });

  const { length1, length2 } = game.params;
  const metre = side / 2 / (length1 + length2 + 0.2);
  context.save();
  const at = ([x, y]) => [side / 2 + x * metre, side / 2 - y * metre];
  const line = (points, style, dashes) => {
    context.strokeStyle = style;
    context.lineWidth = side / 150;
    context.setLineDash(dashes.map((dash) => (dash * side) / 150));
    context.beginPath();
    for (const point of points) context.lineTo(...at(point));
    context.stroke();
  };
  const { state } = acrobot;
  if (path.length > 0) line([placesOf(state, game.params)[1], ...path], accent, [1, 2]);
  if (pulled !== null) {
    const from = placeOf(pulled.point, state, game.params);
    line([from, pulled.target], second, []);
    context.fillStyle = second;
    context.beginPath();
    context.arc(...at(pulled.target), side / 50, 0, 2 * Math.PI);
    context.fill();
  }
  context.restore();
}
