// Plans outside the page's thread. It receives the parameters, a torque and a state, and posts a
// plan, or null, with the milliseconds it took.

import { Planner } from "./acrobot-rs/control.js";

/** Durations of plans, s: the shortest in which a try succeeds. */
const HORIZONS = [1.6, 3.2, 6.4, 12.8, 25.6];
/** The most steps of a plan, so that a tiny time step does not take minutes. */
const STEPS = 3000;
const TRIES = 6;

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
    planner.free();
    postMessage({ id, plan, duration: performance.now() - began });
  } catch ({ message }) {
    postMessage({ id, error: message });
  }
}

onmessage = ({ data }) => {
  if (last === null) setTimeout(plan);
  last = data;
};
