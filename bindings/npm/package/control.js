// Regulators and a planner, in a separate module. control.d.ts describes the interface.

import {
  Kept, STATE, accept, allocated, call, checkNumber, checkedState, elements, isFinite32, isNumber,
  parameters, readSlots, writeSeed, writeSlots,
} from "./kept.js";
import {
  camelCase, checked, integers, invalid, numbers, positive, randomSeed, text, wasm,
} from "./wasm.js";

export { moduleBytes, setModule } from "./wasm.js";

/** The weights of a plan's cost, in the order of the module: their words follow the parameters. */
const COST = [
  "angles[0]", "angles[1]", "velocities[0]", "velocities[1]", "torque", "torqueChange", "power",
  "below", "height", "margin", "arrival",
];
/** The word from which on the module has the weights of a regulator. */
const WEIGHTS = 20;
const UPRIGHT = { theta1: Math.PI, theta2: 0, dtheta1: 0, dtheta2: 0 };

/** Rust's messages, by the kind of error less 4. */
const MESSAGES = [
  (value, name) => `${name} must be finite in each element, got ${value}`,
  (value, name, other) =>
    `${name} must be symmetric, got ${value} and ${other} on both sides of the diagonal`,
  (value, name) =>
    `${name} must be positive semidefinite, got elements of up to ${value} in size after the ` +
    "elimination of its positive pivots",
  (value) =>
    "the state must be in equilibrium, with velocities of 0 and accelerations of at most 0.01 " +
    `rad/s², got ${value}`,
  () => "the torque must reach each motion that grows or persists, but does not reach one",
  () => "q must weight each motion that persists, but does not weight one",
  (value) => `the relative error of the gain must be at most 1e-9, got ${value}`,
];
const NOT_FOUND = 11;

/** As `accept`, with the errors of Rust's `ControlError`. */
function acceptAll(kind, given) {
  if (kind < 4) return accept(kind, given);
  const [value, , , other] = numbers();
  throw new RangeError(MESSAGES[kind - 4](value, camelCase(text(1)), other));
}

const row = (what, array) => elements(what, array, 4, isNumber, "must be a number");

const matrix = (what, rows) =>
  elements(what, rows, 4, () => true).flatMap((each, i) => row(`${what}[${i}]`, each));

function weights(q, r) {
  checkNumber("r", r);
  return [...matrix("q", q), r];
}

/** The matrix and the vector that the module has written. */
const results = () => [
  [0, 4, 8, 12].map((from) => numbers().slice(from, from + 4)),
  numbers().slice(16, 20),
];

const valuesOf = (state) => STATE.map((name) => state[name]);

/** Calls a function of the module for a pendulum. The last of the weights is R. */
function compute(name, state, torque, params, weights = []) {
  const names = parameters();
  const given = readSlots("params", params, names);
  const at = checkedState(state);
  checkNumber("torque", torque);
  const mask = writeSlots(given, names);
  numbers().set(weights, WEIGHTS);
  const kind = wasm()[name](mask, torque, ...valuesOf(at));
  acceptAll(kind, { ...given, ...at, torque, r: weights.at(-1) });
  return results();
}

export function linearize(state, torque, params) {
  const [a, b] = compute("linearize", state, torque, params);
  return { a, b };
}

export function linearizeStep(state, torque, params) {
  const [a, b] = compute("linearize_one_step", state, torque, params);
  return { a, b };
}

export function regulator(params, q, r, state = UPRIGHT, torque = 0) {
  const [costToGo, gain] = compute("regulator", state, torque, params, weights(q, r));
  return { gain, costToGo };
}

export function lqr(model, q, r) {
  numbers().set([...matrix("a", model?.a), ...row("b", model?.b), ...weights(q, r)]);
  acceptAll(wasm().regulator_of_model(), { r });
  const [costToGo, gain] = results();
  return { gain, costToGo };
}

function lengthOf(plan) {
  const length = plan?.torques?.length;
  if (length === undefined) throw invalid("plan must be one that a planner returns", plan, []);
  return length;
}

/** The arrays of a plan, with their elements for a step: a row in the module. */
const PLAN = { states: 4, torques: 1, gains: 4 };

function rowOf(plan, step) {
  const row = Object.entries(PLAN).flatMap(([name, size]) =>
    Array.from({ length: size }, (_, i) => plan[name]?.[size * step + i]),
  );
  return elements(`plan[${step}]`, row, 9, isFinite32, "must be a finite number");
}

/** Copies rows of the module to the arrays of a plan. */
function readRows(address, steps, plan) {
  const rows = new Float32Array(wasm().memory.buffer, address, 9 * steps);
  for (let step = 0, from = 0; step < steps; step++) {
    for (const [name, size] of Object.entries(PLAN)) {
      for (let i = 0; i < size; i++) plan[name][size * step + i] = rows[from++];
    }
  }
}

export class Planner extends Kept {
  constructor(params, limit, cost = {}) {
    const names = parameters();
    const given = { ...readSlots("params", params, names), ...readSlots("cost", cost, COST) };
    const what = "the largest torque";
    checkNumber(what, limit);
    const mask = writeSlots(given, [...names, ...COST]);
    acceptAll(wasm().planner_new(mask, limit), { ...given, [what]: limit });
    super("planner", allocated("planners", 1, integers()[0]));
  }

  /** Makes memory for a plan in the module, and returns its address. */
  #rows(steps) {
    return allocated("steps", steps, call(this, "rows", steps) >>> 0);
  }

  plan(start, options) {
    const given = checked("options", options, ["tries", "seed", "steps"]);
    const { tries = 64, seed = randomSeed(), steps } = given;
    positive("tries", tries);
    positive("steps", steps);
    const state = checkedState(start);
    const words = writeSeed(seed);
    const address = this.#rows(steps);
    const kind = call(this, "plan", words, tries, ...valuesOf(state));
    if (kind === NOT_FOUND) return null;
    acceptAll(kind, state);
    const [length] = integers();
    const entries = Object.entries(PLAN);
    const plan = entries.map(([name, size]) => [name, new Float32Array(size * length)]);
    const found = Object.fromEntries(plan);
    readRows(address, length, found);
    return found;
  }

  improve(start, iterations, plan) {
    positive("iterations", iterations);
    const state = checkedState(start);
    const rows = Array.from({ length: lengthOf(plan) }, (_, step) => rowOf(plan, step));
    const address = this.#rows(rows.length);
    new Float32Array(wasm().memory.buffer, address).set(rows.flat());
    acceptAll(call(this, "improve", iterations, ...valuesOf(state)), state);
    const [cost] = numbers();
    readRows(address, rows.length, plan);
    return cost;
  }

  follow(plan, step, state) {
    if (!Number.isInteger(step) || step < 0) {
      throw invalid("step must be an integer of at least 0", step);
    }
    const isPlanned = step < lengthOf(plan);
    const row = isPlanned ? rowOf(plan, step) : [];
    const at = checkedState(state);
    numbers().set(row);
    return call(this, "follow", isPlanned, ...valuesOf(at));
  }

  decide(state) {
    const at = checkedState(state);
    acceptAll(call(this, "decide", ...valuesOf(at)), at);
    return numbers()[0];
  }
}
