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
/** The first words of a regulator's weights and of a state. */
const [WEIGHTS, STATE_WORD] = [19, 64];
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

/** Writes a state. It comes after all other arguments, because reading these can run code. */
function writeState(state) {
  const given = checkedState(state);
  numbers().set(STATE.map((name) => given[name]), STATE_WORD);
  return given;
}

export function regulator(params, q, r, state = UPRIGHT, torque = 0) {
  const names = parameters();
  const given = readSlots("params", params, names);
  const weights = elements("q", q, 4, () => true).flatMap((row, i) =>
    elements(`q[${i}]`, row, 4, isNumber, "must be a number"),
  );
  checkNumber("r", r);
  checkNumber("torque", torque);
  const at = writeState(state);
  const mask = writeSlots(given, names);
  numbers().set([...weights, r], WEIGHTS);
  acceptAll(wasm().regulator(mask, torque), { ...given, ...at, torque, r });
  const [a, b, c, d, gain] = [0, 4, 8, 12, 16].map((from) => numbers().slice(from, from + 4));
  return { gain, costToGo: [a, b, c, d] };
}

/** The arrays of a plan, with their elements for a step: a row in the module. */
const PLAN = { states: 4, torques: 1, gains: 4 };

export class Planner extends Kept {
  constructor(params, limit, cost = {}) {
    const names = parameters();
    const given = { ...readSlots("params", params, names), ...readSlots("cost", cost, COST) };
    const what = "the largest torque";
    checkNumber(what, limit);
    const mask = writeSlots(given, [...names, ...COST]);
    acceptAll(wasm().make(mask, limit), { ...given, [what]: limit });
    super("planner", allocated("planners", 1, integers()[0]));
  }

  plan(start, options) {
    const given = checked("options", options, ["tries", "seed", "steps"]);
    const { tries = 64, seed = randomSeed(), steps } = given;
    positive("tries", tries);
    positive("steps", steps);
    const state = writeState(start);
    allocated("steps", steps, call(this, "resize", steps));
    const kind = call(this, "plan", writeSeed(seed), tries);
    if (kind === NOT_FOUND) return null;
    acceptAll(kind, state);
    const [length] = integers();
    const plan = {};
    for (const [name, size] of Object.entries(PLAN)) plan[name] = new Float32Array(size * length);
    for (let step = 0; step < length; step++) {
      call(this, "read_knot", step);
      let from = 0;
      for (const [name, size] of Object.entries(PLAN)) {
        plan[name].set(numbers().subarray(from, from + size), size * step);
        from += size;
      }
    }
    return plan;
  }

  follow(plan, step, state) {
    if (!Number.isInteger(step) || step < 0) {
      throw invalid("step must be an integer of at least 0", step);
    }
    const length = plan?.torques?.length;
    if (length === undefined) throw invalid("plan must be one that a planner returns", plan, []);
    const isPlanned = step < length;
    const row = Object.entries(PLAN).flatMap(([name, size]) =>
      Array.from({ length: isPlanned ? size : 0 }, (_, i) => plan[name]?.[size * step + i]),
    );
    const rule = "must be a finite number";
    const knot = elements(`plan[${step}]`, row, isPlanned ? 9 : 0, isFinite32, rule);
    writeState(state);
    numbers().set(knot);
    return call(this, "follow", isPlanned);
  }

  decide(state) {
    const at = writeState(state);
    acceptAll(call(this, "decide"), at);
    return numbers()[0];
  }
}
