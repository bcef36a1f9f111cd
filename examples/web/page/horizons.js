// Searches for a plan that ends upright.

import { Planner } from "./acrobot-rs/control.js";

/** Durations of plans, s: the shortest in which a try succeeds. */
const HORIZONS = [1.6, 3.2, 6.4, 12.8, 25.6];
/** The most steps of a plan, so that a tiny time step does not take minutes. */
const STEPS = 3000;
const TRIES = 6;

/** A plan from a state with a largest torque, or null. */
export function findPlan(params, limit, start, seed) {
  const planner = new Planner(params, limit);
  let plan = null;
  for (const seconds of HORIZONS) {
    const steps = Math.min(Math.ceil(seconds / params.dt), STEPS);
    plan ??= planner.plan(start, { steps, tries: TRIES, seed });
  }
  planner.free();
  return plan;
}
