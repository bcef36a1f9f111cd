// What the worker of the user's controller has: functions of the machine that is set, and answers
// to states. loops.js writes the calls of `$loop`.

import { deviationFrom, linearize, planTorque, regulator } from "./acrobot-rs/control.js";
import { Acrobot } from "./acrobot-rs/index.js";
import { findPlan } from "./horizons.js";

/** The longest time of a loop, ms. */
const LIMIT = 1000;
/** The part of the motor's torque for plans. The rest is for corrections. */
const PLANNED = 0.9;
const UPRIGHT = { theta1: Math.PI, theta2: 0, dtheta1: 0, dtheta2: 0 };

let deadline = 0;
let count = 0;

/** Throws in a loop that takes too long. Otherwise it is true. */
function $loop(line) {
  if (count++ % 256 > 0 || performance.now() < deadline) return true;
  const error = new Error(`the loop did not end within ${LIMIT / 1000} s`);
  throw Object.assign(error, { ownLine: line });
}

/** The functions that the user's code calls. */
function libraryOf(params) {
  const model = new Acrobot({ task: "balance", params });
  const limit = params.torques[2];
  return {
    $loop,
    UPRIGHT,
    params: { ...params, torque: limit },
    energy(state) {
      model.state = state;
      return model.energy;
    },
    deviation: (state) => Object.values(deviationFrom(state, UPRIGHT)),
    diagonal: (values) => values.map((value, i) => values.map((_, j) => (i === j ? value : 0))),
    linearize: (state, torque = 0) => linearize(state, torque, params),
    regulator: (q, r) => regulator(params, q, r),
    plan(state) {
      const plan = findPlan(params, PLANNED * limit, state, 1);
      if (plan === null) throw new Error("plan finds no way up from this state");
      deadline = performance.now() + LIMIT;
      return plan;
    },
    planTorque: (plan, t, state) => planTorque(plan, Math.round(t / params.dt), state),
  };
}

let torque;

/** Answers a state, of a new machine if there are `params`, by the `make` of own.js. */
export function answer(make, { id, params, state, t }) {
  deadline = performance.now() + LIMIT;
  try {
    if (params) torque = make(libraryOf(params));
    if (typeof torque !== "function") throw new Error("the code needs function torque(state, t)");
    const value = torque(state, t);
    if (!Number.isFinite(value)) {
      throw new Error(`torque must return a finite number, N m, got ${value}`);
    }
    postMessage({ id, torque: value });
  } catch (error) {
    // The user's code is the only blob.
    const [, line] = /blob:\S*?:(\d+):\d+/.exec(error?.stack) ?? [];
    const name = error?.name === "Error" || !error?.name ? "" : `${error.name}: `;
    const message = `${name}${error?.message ?? error}`;
    postMessage({ id, message, line: error?.ownLine ?? (line && line - 1) });
  }
}
