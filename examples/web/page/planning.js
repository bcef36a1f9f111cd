// Plans outside the page's thread. It receives the parameters, a torque and a state, and posts a
// plan, or null, with the milliseconds it took, and the gain −K of the regulator after the plan.

import { Planner } from "./acrobot-rs/control.js";

/** Durations of plans, s: the shortest in which a try succeeds. */
const HORIZONS = [1.6, 3.2, 6.4, 12.8, 25.6];
/** The most steps of a plan, so that a tiny time step does not take minutes. */
const STEPS = 3000;
const TRIES = 6;
/** The deviation from upright at which the gain is read, rad and rad/s. */
const DEVIATION = 0.25;

/** −K, from the torque −K x that follows a plan of no steps. */
function gainOf(planner) {
  const nothing = { states: [], torques: [], gains: [] };
  const upright = { theta1: Math.PI, theta2: 0, dtheta1: 0, dtheta2: 0 };
  return Object.entries(upright).map(([name, value]) => {
    const state = { ...upright, [name]: value + DEVIATION };
    return planner.follow(nothing, 0, state) / DEVIATION;
  });
}

/** The last request. Those before it are obsolete. */
let last = null;

function plan() {
  const { id, params, limit, start, seed } = last;
  last = null;
  try {
    const began = performance.now();
    const planner = new Planner(params, limit);
    let plan = null;
    for (const seconds of HORIZONS) {
      const steps = Math.min(Math.ceil(seconds / params.dt), STEPS);
      plan ??= planner.plan(start, { steps, tries: TRIES, seed });
    }
    postMessage({ id, plan, gain: gainOf(planner), duration: performance.now() - began });
    planner.free();
  } catch ({ message }) {
    postMessage({ id, error: message });
  }
}

onmessage = ({ data }) => {
  if (last === null) setTimeout(plan);
  last = data;
};
