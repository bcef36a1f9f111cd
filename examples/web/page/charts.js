// The plots of an episode: torque, energy, angles and velocities.

import { uprightEnergy } from "./acrobot-rs/policies.js";
import { color, minus, plot, rangeOf } from "./plot.js";

const $ = (id) => document.getElementById(id);

export const number = (value, digits = 2) => {
  if (!Number.isFinite(value)) return "too large";
  return minus(Math.abs(value) < 1e6 ? value.toFixed(digits) : value.toPrecision(4));
};

/** Draws a plot of columns, and a caption with their last values and `more` HTML. */
function show(game, id, title, names, unit, columns, options, more = "") {
  const colors = [color("--accent"), color("--second")];
  const series = columns.map((values, i) => ({ values, color: colors[i] }));
  const start = game.first;
  plot($(id), { series, start, end: Math.max(game.steps, 50), unit: "steps", ...options });
  const last = columns.map((column, i) => {
    const text = `${names[i]} ${number(column.at(-1))} ${unit}`;
    return `<span class="${["first", "second"][i]}">${text}</span>`;
  });
  $(`${id}-caption`).innerHTML = `<span>${title}</span>${last.join("")}${more}`;
}

function showTorques(game) {
  const { torque } = game.params;
  const limits = [-torque, torque].map((limit) => [limit, color("--muted")]);
  const room = { range: [-1.2, 1.2].map((part) => part * (torque || 1)), marks: limits };
  const largest = `<span class="hint">limit: ${number(torque)} N m</span>`;
  show(game, "torques", "Torque", [""], "N m", [game.column(6)], room, largest);
}

function showEnergy(game) {
  const energy = game.column(4);
  const standing = uprightEnergy(game.acrobot.params);
  const more = `<span class="hint">upright: ${number(standing)} J</span>
    <span>tip height ${number(game.numbers[5])} m</span>`;
  const range = rangeOf([...energy, standing, -standing]);
  const marks = [[standing, color("--muted")]];
  show(game, "energy", "Energy", [""], "J", [energy], { range, marks }, more);
}

function showAngles(game) {
  const angles = [game.column(0), game.column(1)];
  const cycle = { range: [-Math.PI, Math.PI], period: 2 * Math.PI };
  show(game, "angles", "Angles", ["θ1", "θ2"], "rad", angles, cycle);
}

function showVelocities(game) {
  const velocities = [game.column(2), game.column(3)];
  const fastest = 1.06 * Math.max(2, ...velocities.flat().map(Math.abs));
  const bounds = { range: [-fastest, fastest] };
  show(game, "velocities", "Velocities", ["θ1′", "θ2′"], "rad/s", velocities, bounds);
}

export const CHARTS = [showTorques, showEnergy, showAngles, showVelocities];
