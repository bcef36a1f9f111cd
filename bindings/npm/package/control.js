// Linear models, regulators, plans and swinging up without one, in a separate module, as
// control.d.ts describes them.

import {
  Kept, accept, allocated, call, checkNumber, elements, parameters, readSlots, writeSeed,
  writeSlots, writeState,
} from "./kept.js";
import {
  camelCase, checked, integers, invalid, isFinite32, isNumber, numbers, positive, randomSeed, text,
  wasm,
} from "./wasm.js";

export { moduleBytes, setModule } from "./wasm.js";

/** The weights of a plan's cost, in the order of the module: their words follow the parameters. */
const COST = [
  "angles[0]", "angles[1]", "torque", "torqueChange", "power", "below", "height", "margin",
  "arrival",
];
/**
 * The first words of a regulator's weights, of a cost's matrices, and of a state, which is written
 * after all other arguments, because reading these can run code.
 */
const [WEIGHTS, MATRICES, STATE_WORD] = [22, 31, 64];
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
    "the state must be in equilibrium: at rest, accelerating at most 0.25 % of a fall, " +
    `got ${value}`,
  () => "the torque must reach each motion that grows or persists, but does not reach one",
  () => "q must weight each motion that persists, but does not weight one",
  (value) => `the relative error of the gain must be at most 1e-9, got ${value}`,
];
const NOT_FOUND = 11;

/** As `accept`, with the errors of models and regulators. */
function acceptAll(kind, given) {
  if (kind < 4) return accept(kind, given);
  const [value, , , other] = numbers();
  throw new RangeError(MESSAGES[kind - 4](value, camelCase(text(1)), other));
}

/** Returns the matrix and the vector that a function of the module writes. */
function compute(name, state, torque, params, option, weights = []) {
  const names = parameters();
  const given = readSlots("params", params, names);
  checkNumber("torque", torque);
  const at = writeState(state, STATE_WORD);
  const mask = writeSlots(given, names);
  numbers().set(weights, WEIGHTS);
  acceptAll(wasm()[name](mask, torque, option), { ...given, ...at, torque, r: weights.at(-1) });
  const rows = [0, 4, 8, 12, 16].map((from) => numbers().slice(from, from + 4));
  return [rows.slice(0, 4), rows[4]];
}

export function linearize(state, torque, params) {
  const [a, b] = compute("linear_model", state, torque, params, false);
  return { a, b };
}

export function linearizeStep(state, torque, params) {
  const [a, b] = compute("linear_model", state, torque, params, true);
  return { a, b };
}

/** The elements of a matrix by rows. */
const matrix = (name, rows) =>
  elements(name, rows, 4, () => true).flatMap((row, i) =>
    elements(`${name}[${i}]`, row, 4, isNumber, "must be a number"),
  );

export function regulator(params, q, r, state = UPRIGHT, torque = 0) {
  const weights = matrix("q", q);
  checkNumber("r", r);
  const weighted = [...weights, r];
  const [costToGo, gain] = compute("regulator", state, torque, params, undefined, weighted);
  return { gain, costToGo };
}

/** The arrays of a plan, with their elements for a step: a row in the module. */
const PLAN = { states: 4, torques: 1, gains: 4 };
/** The numbers of what holds the target after a plan. */
const AFTER = 46;

function lengthOf(plan) {
  const length = plan?.torques?.length;
  if (length === undefined) throw invalid("plan must be one that a planner returns", plan, []);
  return length;
}

function knotOf(plan, step) {
  const row = Object.entries(PLAN).flatMap(([name, size]) =>
    Array.from({ length: size }, (_, i) => plan[name]?.[size * step + i]),
  );
  return elements(`plan[${step}]`, row, 9, isFinite32, "must be a finite number");
}

const NONE = new Float32Array(16);

export class Planner extends Kept {
  constructor(params, limit, { q, qf, ...cost } = {}, elbow = 0) {
    const names = parameters();
    const [given, weights] = [readSlots("params", params, names), readSlots("cost", cost, COST)];
    const what = "the largest torque";
    checkNumber(what, limit);
    checkNumber("elbow", elbow);
    const matrices = Object.entries({ q, qf }).map(([name, rows]) =>
      rows === undefined ? NONE : matrix(name, rows),
    );
    const masks = [writeSlots(given, names), writeSlots(weights, COST, WEIGHTS)];
    numbers().set(matrices.flatMap((each) => [...each]), MATRICES);
    acceptAll(wasm().make(...masks, limit, elbow), { ...given, ...weights, elbow, [what]: limit });
    super("planner", allocated("planners", 1, integers()[0]));
  }

  #resize(steps) {
    allocated("steps", steps, call(this, "resize", steps));
  }

  /** Copies the module's plan into the arrays of one. */
  #read(plan) {
    for (let step = 0; step < plan.torques.length; step++) {
      call(this, "read_knot", step);
      let from = 0;
      for (const [name, size] of Object.entries(PLAN)) {
        for (let i = 0; i < size; i++) plan[name][size * step + i] = numbers()[from++];
      }
    }
  }

  plan(start, options) {
    const given = checked("options", options, ["tries", "seed", "steps"]);
    const { tries = 64, seed = randomSeed(), steps } = given;
    positive("tries", tries);
    positive("steps", steps);
    const state = writeState(start, STATE_WORD);
    this.#resize(steps);
    const kind = call(this, "plan", writeSeed(seed), tries);
    if (kind === NOT_FOUND) return null;
    acceptAll(kind, state);
    const [length] = integers();
    const plan = {};
    for (const [name, size] of Object.entries(PLAN)) plan[name] = new Float32Array(size * length);
    this.#read(plan);
    call(this, "feedback");
    plan.after = numbers().slice(0, AFTER);
    return plan;
  }

  improve(start, iterations, plan) {
    positive("iterations", iterations);
    const knots = Array.from({ length: lengthOf(plan) }, (_, step) => knotOf(plan, step));
    const state = writeState(start, STATE_WORD);
    this.#resize(knots.length);
    knots.forEach((knot, step) => {
      numbers().set(knot);
      call(this, "set_knot", step);
    });
    acceptAll(call(this, "improve", iterations), state);
    const [cost] = numbers();
    this.#read(plan);
    return cost;
  }
}

export class SwingUp extends Kept {
  constructor(params, limit) {
    const names = parameters();
    const given = readSlots("params", params, names);
    const what = "the largest torque";
    checkNumber(what, limit);
    acceptAll(wasm().make_swing_up(writeSlots(given, names), limit), { ...given, [what]: limit });
    super("swing-up", allocated("swing-ups", 1, integers()[0]));
  }

  torque(state) {
    const at = writeState(state, STATE_WORD);
    acceptAll(call(this, "swing_up_torque"), at);
    return numbers()[0];
  }
}

export function planTorque(plan, step, state) {
  if (!Number.isInteger(step) || step < 0) {
    throw invalid("step must be an integer of at least 0", step);
  }
  const isPlanned = step < lengthOf(plan);
  const knot = isPlanned ? knotOf(plan, step) : [];
  const rule = "must be a finite number";
  const after = isPlanned ? [] : elements("plan.after", plan.after, AFTER, isFinite32, rule);
  writeState(state, STATE_WORD);
  numbers().set(knot);
  numbers().set(after, 9);
  return wasm().plan_torque(isPlanned);
}
