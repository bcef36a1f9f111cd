// The plots of an episode: torque, energy, angles and velocities.

import { uprightEnergy } from "./acrobot-rs/policies.js";
import { color, minus, plot, rangeOf } from "./plot.js";

const $ = (id) => document.getElementById(id);

export const number = (value, digits = 2) => {
  if (!Number.isFinite(value)) return "too large";
  return minus(Math.abs(value) < 1e6 ? value.toFixed(digits) : value.toPrecision(4));
};

export function showCharts(game) {
  /** Draws a plot of columns, and a caption with their last values and `more` HTML. */
  const show = (id, title, names, unit, columns, options, more = "") => {
    const colors = [color("--accent"), color("--second")];
    const series = columns.map((values, i) => ({ values, color: colors[i] }));
    const start = game.first;
    plot($(id), { series, start, end: Math.max(game.steps, 50), unit: "steps", ...options });
    const last = columns.map((column, i) => {
      const text = `${names[i]} ${number(column.at(-1))} ${unit}`;
      return `<span class="${["first", "second"][i]}">${text}</span>`;
    });
    $(`${id}-caption`).innerHTML = `<span>${title}</span>${last.join("")}${more}`;
  };

  const { torque } = game.params;
  const limits = [-torque, torque].map((limit) => [limit, color("--muted")]);
  const room = { range: [-1.2, 1.2].map((part) => part * (torque || 1)), marks: limits };
  const largest = `<span class="hint">limit: ${number(torque)} N m</span>`;
  show("torques", "Torque", [""], "N m", [game.column(6)], room, largest);

  const columns = [0, 1, 2, 3, 4, 5].map((index) => game.column(index));
  const [energy, heights] = columns.slice(4);
  const [angles, velocities] = [columns.slice(0, 2), columns.slice(2, 4)];
  const standing = uprightEnergy(game.acrobot.params);
  const more = `<span class="hint">upright: ${number(standing)} J</span>
    <span>tip height ${number(heights.at(-1))} m</span>`;
  const range = rangeOf([...energy, standing, -standing]);
  const marks = [[standing, color("--muted")]];
  show("energy", "Energy", [""], "J", [energy], { range, marks }, more);
  const cycle = { range: [-Math.PI, Math.PI], period: 2 * Math.PI };
  show("angles", "Angles", ["θ1", "θ2"], "rad", angles, cycle);
  const fastest = 1.06 * Math.max(2, ...velocities.flat().map(Math.abs));
  const bounds = { range: [-fastest, fastest] };
  show("velocities", "Velocities", ["θ1′", "θ2′"], "rad/s", velocities, bounds);
}
