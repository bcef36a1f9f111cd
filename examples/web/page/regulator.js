// The panel "Hold it by a regulator": weights, gain, poles, and the plane of θ1 and θ1′ with the
// states from which the regulator holds.

import { linearizeStep, regulator } from "./acrobot-rs/control.js";
import { number } from "./charts.js";
import { levelOf } from "./game.js";
import { eigenvalues, leanOf, torqueBy } from "./law.js";
import { axes, color, minus, valuesAt } from "./plot.js";
import { reasonOf } from "./settings.js";

/** The states of the grid in both directions. */
const SIZE = 48;
/** The least time between two pictures of the plane, and between two regions, ms. */
const [PERIOD, REGION_PERIOD] = [30, 100];
/** How much of the path is shown, s. */
const PATH = 4;
const UPRIGHT = { theta1: Math.PI, theta2: 0, dtheta1: 0, dtheta2: 0 };
const SIDES = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const NAMES = ["θ1", "θ2", "θ1′", "θ2′", "Torque"];

const $ = (id) => document.getElementById(id);

/** Half of the plane's width, rad, and height, rad/s: as far as the motor could hold the links. */
function rangeOf({ mass1, mass2, length1, centerOfMass1, centerOfMass2, gravity, torques }) {
  const level = gravity * (mass1 * centerOfMass1 + mass2 * (length1 + centerOfMass2));
  const width = Math.min(0.6, (1.2 * torques[2]) / Math.abs(level)) || 0.6;
  return [width, 5 * width];
}

/** Calls `play` with a state that the user has chosen in the plane. Returns the policy. */
export function regulatorPanel({ game, play, changed }) {
  let weights = NAMES.map(() => 1);
  /** The gain, or null, and what it is of. */
  let [gain, of, reason] = [null, null, ""];
  let [worker, asked, region] = [null, null, null];
  const canvas = $("plane");
  let drawn = 0;

  /** Computes the gain for the machine, if it has changed. */
  const design = () => {
    const { params } = game;
    if (of?.params === params && of.weights === weights) return;
    of = { params, weights };
    const q = weights.slice(0, 4).map((weight, i, all) => all.map((_, j) => (i === j) * weight));
    try {
      gain = regulator(game.acrobot.params, q, weights[4]).gain;
      const { a, b } = linearizeStep(UPRIGHT, 0, game.acrobot.params);
      const closed = a.map((row, i) => Array.from(row, (value, j) => value - b[i] * gain[j]));
      const poles = eigenvalues(closed).map(([x, y]) => {
        const [growth, turn] = [Math.log(Math.hypot(x, y)), Math.atan2(y, x)];
        return [growth, turn].map((value) => value / params.dt);
      });
      poles.sort(([a], [b]) => a - b);
      const texts = poles.filter(([, turn]) => turn > -1e-3).map(([growth, turn]) =>
        `${number(growth)}${turn < 1e-3 ? "" : ` ± ${number(turn)} i`}`);
      $("gain").textContent = Array.from(gain, (k) => number(k, 1)).join(", ");
      $("poles").textContent = texts.join(", ");
      reason = "";
    } catch ({ message }) {
      [gain, region] = [null, null];
      reason = reasonOf(params) ?? minus(message);
      for (const id of ["gain", "poles"]) $(id).textContent = "–";
    }
    $("regulator-reason").textContent = reason;
    changed();
  };

  /** What has the angle and the velocity of link 2: the state, if it is in sight, or upright. */
  const sliceOf = ([width, height]) => {
    const { state } = game.acrobot;
    const isIn = Math.abs(leanOf(state.theta1)) < width && Math.abs(state.dtheta1) < height;
    return isIn ? state : UPRIGHT;
  };
  /** Asks for the region in the plane. */
  const ask = ([width, height]) => {
    const { params, state } = game.acrobot;
    const { theta2, dtheta2 } = sliceOf([width, height]);
    const now = [gain, ...Object.values(state)].join();
    if (gain === null || now === asked) return;
    if (worker === null) {
      worker = new Worker(new URL("region.js", import.meta.url), { type: "module" });
      worker.onmessage = ({ data }) => {
        region = data;
        setTimeout(() => (worker.isBusy = false), REGION_PERIOD);
      };
      worker.onerror = ({ message }) => ($("regulator-reason").textContent = message);
    }
    if (worker.isBusy) return;
    [worker.isBusy, asked] = [true, now];
    const part = (i) => (2 * i + 1) / SIZE - 1;
    const [xs, ys] = [1, -1].map((sign) => Array.from({ length: SIZE }, (_, i) => sign * part(i)));
    worker.postMessage({
      params, gain, theta2, dtheta2, state: Object.values(state),
      xs: xs.map((x) => x * width), ys: ys.map((y) => y * height),
    });
  };

  const draw = ([width, height]) => {
    const ranges = [[-width, width], "rad", [-height, height]];
    const { context, x, y, line } = axes(canvas, ...ranges);
    context.fillStyle = color("--region");
    const edge = (i) => (2 * i) / SIZE - 1;
    for (let i = 0; region !== null && i < SIZE * SIZE; i++) {
      const [column, row] = [i % SIZE, Math.floor(i / SIZE)];
      const [left, right] = [column, column + 1].map((i) => Math.round(x(width * edge(i))));
      const [top, bottom] = [row, row + 1].map((i) => Math.round(y(-height * edge(i))));
      if (region[i]) context.fillRect(left, top, right - left, bottom - top);
    }
    const end = game.steps - game.span[0] + 1;
    const first = Math.max(end - Math.ceil(PATH / game.params.dt), 0);
    const path = game.rows.slice(first, end);
    const points = path.map(({ numbers }) => [x(leanOf(numbers[0])), y(numbers[2])]);
    line(points, color("--second"));
    context.fillStyle = color("--second");
    context.beginPath();
    context.arc(...points.at(-1), 4, 0, 2 * Math.PI);
    context.fill();
    context.restore();
  };

  $("weights").innerHTML = NAMES.map((name, i) => `<label for="weight${i}">${name}</label>
    <input id="weight${i}" type="range" min="-3" max="3" step="0.1" value="0">
    <span id="weight${i}-value">1</span>`).join("");
  $("weights").oninput = () => {
    weights = NAMES.map((_, i) => 10 ** Number($(`weight${i}`).value));
    weights.forEach((weight, i) => {
      $(`weight${i}-value`).textContent = Number(weight.toPrecision(2));
      $(`weight${i}`).ariaValueText = weight.toPrecision(2);
    });
    design();
  };
  canvas.onclick = ({ offsetX, offsetY }) => {
    const range = rangeOf(game.acrobot.params);
    const [x, y] = valuesAt(canvas, offsetX, offsetY);
    const [theta1, dtheta1] = [Math.PI + x * range[0], y * range[1]];
    play({ ...sliceOf(range), theta1, dtheta1 });
  };

  canvas.onkeydown = (event) => {
    if (!(event.key in SIDES)) return;
    event.preventDefault();
    const range = rangeOf(game.acrobot.params);
    const state = sliceOf(range);
    const [x, y] = SIDES[event.key].map((side, i) => (2 * side * range[i]) / SIZE);
    play({ ...state, theta1: state.theta1 + x, dtheta1: state.dtheta1 + y });
  };

  return {
    frame(now) {
      if (now - drawn < PERIOD) return;
      drawn = now;
      design();
      const range = rangeOf(game.acrobot.params);
      ask(range);
      draw(range);
      const verdict = region === null ? "" : region.at(-1) ? "it holds from here" : "it falls";
      if ($("verdict-now").textContent !== verdict) $("verdict-now").textContent = verdict;
    },
    act({ seen, params }) {
      design();
      if (gain === null) throw new Error(reason);
      return levelOf(torqueBy(gain, seen), params.torque);
    },
  };
}
