// Draws an acrobot on a canvas, with the geometry of the crate's pictures and of Gymnasium's.

import { checked, invalid } from "./wasm.js";

/** Gymnasium's colours. Its pictures have no torque. */
const COLORS = {
  background: "white", target: "black", link: "#0cc", joint: "#cc0", torque: "#c00",
};

/** Draws into the square from (0, 0) to (size, size) of the context's coordinates. */
export function draw(context, state, params, torque, options = {}) {
  if (typeof context?.arc !== "function") {
    throw invalid("context must be a canvas's 2D context", context, []);
  }
  const given = checked("options", options, ["size", "colors"]);
  const { canvas } = context;
  const { size = Math.min(canvas?.width, canvas?.height), colors: own = {} } = given;
  if (!(Number.isFinite(size) && size >= 0)) {
    throw invalid("options.size must be finite and at least 0 pixels", size);
  }
  const colors = { ...COLORS, ...checked("options.colors", own, Object.keys(COLORS)) };
  for (const [name, color] of Object.entries(colors)) {
    if (typeof color !== "string") {
      throw invalid(`options.colors.${name} must be a string`, color, []);
    }
  }
  const [{ theta1, theta2 }, { length1, length2 }] = [state, params];
  const reach = length1 + length2 + 0.2;
  const metre = size / 2 / reach;

  const stroke = (color, width, points) => {
    context.strokeStyle = color;
    context.lineWidth = width;
    context.beginPath();
    for (const [x, y] of points) context.lineTo(x, y);
    context.stroke();
  };

  context.save();
  context.clearRect(0, 0, size, size);
  context.fillStyle = colors.background;
  context.fillRect(0, 0, size, size);
  // From here in metres, y up.
  context.translate(size / 2, size / 2);
  context.scale(metre, -metre);
  stroke(colors.target, 1 / metre, [[-reach, 1], [reach, 1]]);
  for (const [angle, length] of [[theta1, length1], [theta2, length2]]) {
    context.rotate(angle);
    stroke(colors.link, 0.2, [[0, 0], [0, -length]]);
    context.fillStyle = colors.joint;
    context.beginPath();
    context.arc(0, 0, 0.1, 0, 2 * Math.PI);
    context.fill();
    context.translate(0, -length);
  }
  if (torque !== 0) {
    // Three quarters of a turn around the elbow, open below, with a head at the end.
    context.translate(0, length2);
    context.rotate(-theta1 - theta2);
    context.scale(torque > 0 ? 0.3 : -0.3, 0.3);
    const [start, end] = [-Math.PI / 4, (5 * Math.PI) / 4];
    context.strokeStyle = colors.torque;
    context.lineWidth = 1 / 6;
    context.beginPath();
    context.arc(0, 0, 1, start, end);
    context.stroke();
    const [x, y] = [Math.cos(end), Math.sin(end)];
    stroke(colors.torque, 1 / 6, [[x - 0.49, y + 0.25], [x, y], [x + 0.17, y + 0.52]]);
  }
  context.restore();
}
