// Plans outside the page's thread. It receives the parameters, a torque and a state, and posts a
// plan, or null, with the milliseconds it took.

import { findPlan } from "./horizons.js";

/** The last request. Those before it are obsolete. */
let last = null;

function plan() {
  const { id, params, limit, start, seed } = last;
  last = null;
  try {
    const began = performance.now();
    const plan = findPlan(params, limit, start, seed);
    postMessage({ id, plan, duration: performance.now() - began });
  } catch ({ message }) {
    postMessage({ id, error: message });
  }
}

onmessage = ({ data }) => {
  if (last === null) setTimeout(plan);
  last = data;
};
