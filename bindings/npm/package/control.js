// Control in a separate module, as control.d.ts describes it.

import {
  call, checkNumber, elements, empty, fields, lengthOf, matrix, pack, readAll, readChanges, unpack,
} from "./kept.js";
import { SIZES, STRUCTS } from "./layout.js";
import { Made, machine } from "./machine.js";
import { checked, invalid, isFinite32, positive, randomSeed, seedWords } from "./wasm.js";

export {
  Controller, Estimator, ParameterEstimator, Regression, Replanner, calibrate, fitParams, identify,
  predictionError,
} from "./machine.js";
export { moduleBytes, setModule } from "./wasm.js";

const {
  acrobot_cost_t: COST, acrobot_covariances_t: COVARIANCES, acrobot_feedback_t: FEEDBACK,
  acrobot_forces_t: FORCES, acrobot_knot_t: KNOT, acrobot_linear_model_t: MODEL,
  acrobot_lqe_t: LQE, acrobot_lqr_t: LQR, acrobot_problem_t: PROBLEM, acrobot_rates_t: RATES,
  acrobot_state_t: STATE, acrobot_weights_t: WEIGHTS,
} = STRUCTS;

const UPRIGHT = { theta1: Math.PI, theta2: 0, dtheta1: 0, dtheta2: 0 };

const readState = (state, what = "state") => readAll(what, state, STATE);

const part = (words, [at, count]) => words.slice(at, at + count);
const rows = (words, width = 4) =>
  Array.from({ length: words.length / width }, (_, i) => part(words, [width * i, width]));

/** Calls a function of a machine in a state, with more arguments. Returns what it writes. */
function compute(name, words, params, state, more = {}, given = more) {
  const changes = readChanges(params);
  const [at, stateWords] = readState(state);
  for (const [what, value] of Object.entries(more)) {
    if (!ArrayBuffer.isView(value)) checkNumber(what, value);
  }
  const all = { ...changes, ...at, ...given };
  call(all, name, machine(changes), stateWords, ...Object.values(more), words);
  return words;
}

export function deviationFrom(state, target) {
  const [[given, from], [, to]] = [readState(state), readState(target, "target")];
  const words = empty(STATE);
  call(given, "acrobot_deviation_from", from, to, words);
  return unpack(words, STATE);
}

export function derivative(state, torque, params) {
  return unpack(compute("acrobot_derivative", empty(RATES), params, state, { torque }), RATES);
}

export function massMatrix(state, params) {
  return rows(compute("acrobot_mass_matrix", new Float32Array(4), params, state), 2);
}

export function inverseDynamics(state, ddtheta1, ddtheta2, params) {
  const accelerations = { ddtheta1, ddtheta2 };
  const words = empty(FORCES);
  return unpack(compute("acrobot_inverse_dynamics", words, params, state, accelerations), FORCES);
}

const modelOf = (words) => ({ a: rows(part(words, MODEL.a)), b: part(words, MODEL.b) });

export function linearize(state, torque, params) {
  return modelOf(compute("acrobot_linearize", empty(MODEL), params, state, { torque }));
}

export function linearizeStep(state, torque, params) {
  return modelOf(compute("acrobot_linearize_step", empty(MODEL), params, state, { torque }));
}

function readModel(what, model) {
  const { a, b } = checked(what, model, Object.keys(MODEL));
  const given = { a: matrix(`${what}.a`, a), b: elements(`${what}.b`, b, 4) };
  return pack(empty(MODEL), given, MODEL);
}

/** A copy of weights, and their words. */
function readWeights(q, r) {
  const given = { q: matrix("q", q), r };
  checkNumber("r", r);
  return [given, pack(empty(WEIGHTS), given, WEIGHTS)];
}

const regulatorOf = (words) => ({
  gain: part(words, LQR.gain),
  costToGo: rows(part(words, LQR.costToGo)),
});

export function regulator(params, q, r, target = UPRIGHT, torque = 0) {
  const [given, weights] = readWeights(q, r);
  const more = { torque, weights };
  const all = { torque, ...given };
  return regulatorOf(compute("acrobot_regulator", empty(LQR), params, target, more, all));
}

function solve(name, model, q, r) {
  const [own, [given, weights]] = [readModel("model", model), readWeights(q, r)];
  const words = empty(LQR);
  call(given, name, own, weights, words);
  return regulatorOf(words);
}

export function lqr(model, q, r) {
  return solve("acrobot_lqr", model, q, r);
}

export function dlqr(model, q, r) {
  return solve("acrobot_dlqr", model, q, r);
}

export function tvlqr(models, q, r, costToGo) {
  const each = elements("models", models, undefined, () => true);
  const count = each.length;
  const words = each.flatMap((model, i) => [...readModel(`models[${i}]`, model)]);
  const [given, weights] = readWeights(q, r);
  const cost = Float32Array.from(matrix("costToGo", costToGo));
  const gains = new Float32Array(4 * count);
  call(given, "acrobot_tvlqr", Float32Array.from(words), weights, cost, gains, count);
  return { gains: rows(gains), costToGo: rows(cost) };
}

export function dlqe(model, w, s) {
  const own = readModel("model", model);
  const given = { w: matrix("w", w), s: elements("s", s, 2) };
  const words = empty(LQE);
  call(given, "acrobot_dlqe", own, pack(empty(COVARIANCES), given, COVARIANCES), words);
  const [gain, covariance] = [part(words, LQE.gain), part(words, LQE.priorCovariance)];
  return { gain: rows(gain, 2), priorCovariance: rows(covariance) };
}

/** The arrays of a plan, and their places in a knot. */
const PLAN = {
  states: KNOT.state, torques: KNOT.torque, gains: KNOT.gain, workspace: KNOT.workspace,
};
const WIDTH = empty(KNOT).length;

/** A plan's number of steps. */
function stepsOf(plan) {
  const length = lengthOf(plan?.torques);
  if (length === undefined) throw invalid("plan must be one that a planner returns", plan, []);
  return length;
}

function knotOf(plan, step) {
  const row = Object.entries(PLAN).flatMap(([name, [, size]]) =>
    Array.from({ length: size }, (_, i) => plan[name]?.[size * step + i]),
  );
  return elements(`plan[${step}]`, row, WIDTH, isFinite32, "must be a finite number");
}

/** Copies knots into the arrays of a plan. */
function writePlan(plan, knots) {
  for (const [name, [at, size]] of Object.entries(PLAN)) {
    for (let i = 0; i < plan[name].length; i++) {
      const step = Math.floor(i / size);
      plan[name][i] = knots[WIDTH * step + at + (i % size)];
    }
  }
  return plan;
}

export class Planner extends Made {
  static kind = "planner";

  constructor(params, limit, cost = {}, elbow = 0) {
    const [changes, weights] = [readChanges(params), fields("cost", cost, COST)];
    checkNumber("limit", limit);
    checkNumber("elbow", elbow);
    const given = { ...changes, ...weights, limit, elbow };
    const problem = empty(PROBLEM);
    call(given, "acrobot_problem_init", problem, machine(changes), limit, elbow);
    pack(problem.subarray(PROBLEM.cost[0]), weights, COST);
    super(SIZES.planner, given, "acrobot_planner_init", problem);
  }

  plan(start, options) {
    const given = checked("options", options, ["tries", "seed", "steps"]);
    const { tries = 64, seed = randomSeed(), steps } = given;
    positive("tries", tries);
    positive("steps", steps, 16);
    seedWords(seed, 64);
    const [at, state] = readState(start);
    const [knots, length] = [new Float32Array(WIDTH * steps), new Uint32Array(1)];
    const planned = [this, state, tries, BigInt(seed), knots, steps, length];
    if (!call(at, "acrobot_planner_plan", ...planned)) return null;
    const after = empty(FEEDBACK);
    call({}, "acrobot_planner_feedback", this, after);
    const arrays = Object.entries(PLAN).map(([name, [, size]]) => [
      name, new Float32Array(size * length[0]),
    ]);
    return writePlan({ ...Object.fromEntries(arrays), after }, knots);
  }

  improve(start, iterations, plan) {
    positive("iterations", iterations);
    const steps = stepsOf(plan);
    const rows = Array.from({ length: steps }, (_, step) => knotOf(plan, step));
    const knots = Float32Array.from(rows.flat());
    const [at, state] = readState(start);
    const [improved, cost] = [knots.slice(), new Float32Array(1)];
    call(at, "acrobot_planner_improve", this, state, iterations, knots, improved, steps, cost);
    writePlan(plan, improved);
    return cost[0];
  }

  withVelocityClamp() {
    call({}, "acrobot_planner_with_velocity_clamp", this);
    return this;
  }

  holdsFrom(state) {
    const [[at, words], holds] = [readState(state), new Uint8Array(1)];
    call(at, "acrobot_planner_holds_from", this, words, holds);
    return holds[0] !== 0;
  }
}

export class SwingUp extends Made {
  static kind = "swing-up";

  constructor(params, limit) {
    const changes = readChanges(params);
    checkNumber("limit", limit);
    const given = { ...changes, limit };
    super(SIZES.swingUp, given, "acrobot_swing_up_init", machine(changes), limit);
  }

  torque(state) {
    const [[at, words], torque] = [readState(state), new Float32Array(1)];
    call(at, "acrobot_swing_up_torque", this, words, torque);
    return torque[0];
  }
}

export function planTorque(plan, step, state) {
  if (!Number.isInteger(step) || step < 0) {
    throw invalid("step must be an integer of at least 0", step);
  }
  const isPlanned = step < stepsOf(plan);
  const knot = isPlanned ? Float32Array.from(knotOf(plan, step)) : empty(KNOT);
  const after = empty(FEEDBACK);
  if (!isPlanned) {
    const rule = "must be a finite number";
    after.set(elements("plan.after", plan.after, after.length, isFinite32, rule));
  }
  const [[at, words], torque] = [readState(state), new Float32Array(1)];
  call(at, "acrobot_plan_torque", knot, Number(isPlanned), after, 0, words, torque);
  return torque[0];
}
