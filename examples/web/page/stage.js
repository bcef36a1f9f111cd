// Draws the acrobot in the page's colours, the path of the tip to come, and the spring.

import { newAcrobot } from "./game.js";
import { placeOf, placesOf } from "./places.js";
import { color } from "./plot.js";

const [picture, behind] = ["#picture", "#behind"].map((id) => document.querySelector(id));

/** The picture's side in lengths of both links. */
const PART = 2.2;
let model = null;

/** A canvas's context, at the display's resolution. */
function contextOf(canvas) {
  const side = Math.max(Math.round(canvas.clientWidth * devicePixelRatio), 1);
  if (canvas.width !== side) canvas.width = canvas.height = side;
  return canvas.getContext("2d");
}

/** Draws a game, or nothing, behind the picture. */
export function drawRival(game, part) {
  behind.hidden = game === null;
  if (game === null) return;
  const colors = { background: "transparent", target: "transparent", torque: "transparent" };
  const shown = { ...colors, link: color("--muted"), joint: color("--text") };
  draw(contextOf(behind), shown, game, part);
}

/** Draws a game's acrobot as if its links had 2 m, and returns its state. */
function draw(context, colors, game, part) {
  const { length1, length2 } = game.params;
  const { state } = game.between(part);
  const scale = 2 / (length1 + length2);
  model ??= newAcrobot();
  model.setParams({ length1: scale * length1, length2: scale * length2 });
  // The arrow is that of the last step.
  model.stepTorque(game.numbers[6]);
  model.state = state;
  model.draw(context, { colors });
  return state;
}

/** The place in metres, y up, of a place in the picture in CSS pixels. */
export function placeAt(x, y, { length1, length2 }) {
  const side = picture.clientWidth;
  const metre = side / PART / (length1 + length2);
  return [(x - side / 2) / metre, (side / 2 - y) / metre];
}

/**
 * Draws a game at a part of its last step, from 0 to 1, with the path of the tip to come, and with
 * what pulls: a `point` of a link and a `target`, or null; and with the state that policies see as
 * a ghost, or null.
 */
export function drawStage(game, part, path, pulled, ghost) {
  const names = ["--text", "--link", "--joint", "--torque", "--accent", "--second", "--muted"];
  const [target, link, joint, torque, accent, second, muted] = names.map(color);
  // The arrow fades with the torque.
  const share = Math.min(Math.abs(game.numbers[6]) / game.params.torque || 0, 1);
  const faded = `${torque}${Math.round(255 * share).toString(16).padStart(2, "0")}`;
  const context = contextOf(picture);
  const { width: side } = picture;
  const colors = { background: "transparent", target, link, joint, torque: faded };
  const state = draw(context, colors, game, part);

  const { length1, length2 } = game.params;
  const metre = side / PART / (length1 + length2);
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
  if (path.length > 0) line([placesOf(state, game.params)[1], ...path], accent, [1, 2]);
  if (ghost) line([[0, 0], ...placesOf(ghost, game.params)], muted, []);
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
