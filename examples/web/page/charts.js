// The plots of an episode: torque, energy, angles and velocities.

import { uprightEnergy } from "./acrobot-rs/policies.js";
import { color, minus, plot, rangeOf } from "./plot.js";

const $ = (id) => document.getElementById(id);

export const number = (value, digits = 2) => {
  if (!Number.isFinite(value)) return "too large";
  return minus(Math.abs(value) < 1e6 ? value.toFixed(digits) : value.toPrecision(4));
};

/** Draws a plot of numbers of the states, and a caption with the last ones and `more` HTML. */
function show(game, id, title, names, unit, indices, options, more = "") {
  const colors = [color("--accent"), color("--second")];
  const [start, rows] = game.window;
  const columns = indices.map((index) => rows.map(({ numbers }) => numbers[index]));
  const series = columns.map((values, i) => ({ values, color: colors[i] }));
  const end = Math.max(start + rows.length - 1, start + 1, 50);
  const cursor = game.steps === game.span[1] ? undefined : game.steps;
  const given = options(columns.flat());
  plot($(id), { series, start, end, cursor, unit: "steps", ...given });
  const last = indices.map((index, i) => {
    const text = `${names[i]} ${number(game.numbers[index])} ${unit}`;
    return `<span class="${["first", "second"][i]}">${text}</span>`;
  });
  $(`${id}-caption`).innerHTML = `<span>${title}</span>${last.join("")}${more}`;
}

function showTorques(game) {
  const { torque } = game.params;
  const limits = [-torque, torque].map((limit) => [limit, color("--muted")]);
  const room = { range: [-1.2, 1.2].map((part) => part * (torque || 1)), marks: limits };
  const largest = `<span class="hint">limit: ${number(torque)} N m</span>`;
  show(game, "torques", "Torque", [""], "N m", [6], () => room, largest);
}

function showEnergy(game) {
  const standing = uprightEnergy(game.acrobot.params);
  const more = `<span class="hint">upright: ${number(standing)} J</span>
    <span>tip height ${number(game.numbers[5])} m</span>`;
  const marks = [[standing, color("--muted")]];
  const options = (energy) => ({ range: rangeOf([...energy, standing, -standing]), marks });
  show(game, "energy", "Energy", [""], "J", [4], options, more);
}

function showAngles(game) {
  const cycle = { range: [-Math.PI, Math.PI], period: 2 * Math.PI };
  show(game, "angles", "Angles", ["θ1", "θ2"], "rad", [0, 1], () => cycle);
}

function showVelocities(game) {
  const bounds = (velocities) => {
    const fastest = 1.06 * Math.max(2, ...velocities.map(Math.abs));
    return { range: [-fastest, fastest] };
  };
  show(game, "velocities", "Velocities", ["θ1′", "θ2′"], "rad/s", [2, 3], bounds);
}

export const CHARTS = [showTorques, showEnergy, showAngles, showVelocities];
