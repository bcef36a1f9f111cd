// What results.test.mjs does not show of control, and invalid arguments.

import assert from "node:assert/strict";
import { test } from "node:test";

import {
  Controller, Estimator, Planner, Regression, Replanner, deviationFrom, dlqe, fitParams, identify,
  planTorque, regulator,
} from "../dist/control.js";
import { assertRejected } from "./module.mjs";

const state = (theta1, theta2 = 0, dtheta1 = 0, dtheta2 = 0) =>
  ({ theta1, theta2, dtheta1, dtheta2 });
const HANGING = state(0);
const UPRIGHT = state(Math.PI);
const EYE = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]];
const PARAMS = { dt: 0.05 };
const planned = () => {
  const planner = new Planner(PARAMS, 8);
  return [planner, planner.plan(HANGING, { steps: 80, seed: 3 })];
};

test("a plan is improved in place for other weights and another start", () => {
  const [planner, plan] = planned();
  const jumps = ({ torques }) =>
    torques.slice(1).reduce((sum, torque, i) => sum + (torque - torques[i]) ** 2, 0);
  const before = jumps(plan);
  new Planner(PARAMS, 8, { torqueChange: 10, angles: [0.1, 0] }).improve(state(0.05), 30, plan);
  assert.ok(jumps(plan) < before / 2);
  assert.equal(plan.states[0], Math.fround(0.05));
  // A rejected plan is as before.
  const copy = structuredClone(plan);
  const rule = /must be finite in each element/;
  assert.throws(() => planner.improve(state(0, 0, 3e38), 2, plan), rule);
  assert.deepEqual(plan, copy);
  assert.equal(planner.plan(HANGING, { steps: 10, tries: 3 }), null);
});

test("a planner holds where link 2 stays below its bound, or is clamped to it", () => {
  const planner = new Planner({ dt: 0.02, maxVelocity2: 0.5 }, 10);
  const held = () => [HANGING, state(3.1), UPRIGHT].map((each) => planner.holdsFrom(each));
  assert.deepEqual(held(), [false, false, true]);
  planner.withVelocityClamp();
  assert.deepEqual(held(), [false, true, true]);
});

const SETTINGS = { params: { dt: 0.002, maxVelocity1: Infinity }, limit: 6, counts: [4096, 1024] };

test("estimates follow what is measured", () => {
  const estimator = new Estimator(PARAMS, { angleStd: 0.001, torqueStd: 0.01 });
  assert.equal(estimator.stateStd.theta1, Infinity);
  estimator.correct(0.5, -0.25);
  assert.deepEqual(estimator.state, state(0.5, -0.25));
  estimator.predict(0);
  assert.ok(estimator.state.dtheta1 < 0 && estimator.stateStd.theta1 < 0.5);
  const controller = new Controller(SETTINGS);
  controller.tick(1024, 128);
  const { theta1, theta2 } = deviationFrom(controller.state, state(Math.PI / 2, Math.PI / 4));
  assert.ok(Math.abs(theta1) + Math.abs(theta2) < 0.01);
  assert.equal(controller.params.maxVelocity1, 3.4028234663852886e38);
});

test("invalid arguments are rejected with Rust's messages", () => {
  const [planner, plan] = planned();
  const make = (limit, cost) => () => new Planner(PARAMS, limit, cost);
  const hold = (q, params = PARAMS) => () => regulator(params, q, 1, UPRIGHT);
  const settings = SETTINGS;
  const [regression, stdErrors] = [new Regression(), new Float64Array(10)];
  const add = (dt, gravity = 9.8, half = 1, window = 1) => () =>
    regression.add({ angles: [0, 0], torques: [0] }, dt, gravity, half, window);
  const fit = regression.fit();
  assert.equal(fit.rankDeficiency, 10);
  const model = { a: EYE, b: [0, 0, 0, 0] };
  assertRejected([
    ["RangeError", "dt must be finite and above 0 s", ["-1", hold(EYE, { dt: -1 })]],
    ["TypeError", "q[0][1] must be a number",
      ["null", hold([[1, null, 0, 0], ...EYE.slice(1)])]],
    ["RangeError", "limit must be finite and above 0 N m", ["-0.3", make(-0.3)]],
    ["RangeError", "torqueChange must be finite and at least 0 per (N m)²",
      ["-0.1", make(1, { torqueChange: -0.1 })]],
    ["RangeError", "angles must be finite and at least 0 per s",
      ["-0.1", make(1, { angles: [-0.1, -0.2] })]],
    ["RangeError", "steps must be an integer from 1 to 2^16 - 1",
      ["65536", () => planner.plan(HANGING, { steps: 65_536 })]],
    ["RangeError",
      "seed must be an integer from 0 to 2^53 - 1, or a BigInt from 0 to 2^64 - 1",
      [`${2n ** 64n}n`, () => planner.plan(HANGING, { steps: 9, seed: 2n ** 64n })]],
    ["TypeError", "plan must be one that a planner returns",
      ["null", () => planTorque(null, 0, HANGING)]],
    ["TypeError", "plan[0][5] must be a finite number",
      ["undefined", () => planTorque({ ...plan, gains: [] }, 0, HANGING)]],
    ["RangeError", "step must be an integer of at least 0",
      ["-1", () => planTorque(plan, -1, HANGING)]],
    ["RangeError", "theta2 must be a finite number of rad",
      ["NaN", () => planTorque(plan, 0, state(0, NaN))],
      ["1e+39, which is Infinity in single precision",
        () => planTorque(plan, plan.torques.length, state(0, 1e39))]],
    ["RangeError", "angleStd must be above 0 and at most 2 rad",
      ["3", () => new Estimator(PARAMS, { angleStd: 3, torqueStd: 1 })]],
    ["RangeError", "recording.angles must have 2 elements",
      ["1", () => identify({ angles: [1], torques: [1] }, PARAMS)]],
    ["RangeError", "angles must be finite in each element",
      ["NaN", () => identify({ angles: [1, NaN], torques: [1] }, PARAMS)]],
    ["RangeError", "dt must be finite and above 0 s", ["0", add(0)]],
    ["TypeError", "gravity must be a number", ["null", add(0.01, null)]],
    ["RangeError", "half must be an integer from 1 to 2^32 - 1", ["0", add(0.01, 9.8, 0)]],
    ["RangeError", "window must be an integer from 1 to 2^32 - 1", ["1.5", add(0.01, 9.8, 1, 1.5)]],
    ["RangeError", "torques must be finite in each element",
      ["Infinity", () => regression.add({ angles: [0, 0], torques: [Infinity] }, 1, 1, 1, 1)]],
    ["RangeError",
      "mass11 must be determined by recordings in which both links move long enough, in kg m²",
      ["0", () => fitParams(fit, PARAMS)]],
    ["RangeError", "fit.values must have 10 elements",
      ["1", () => fitParams({ ...fit, values: [1] }, PARAMS)]],
    ["TypeError", "fit.stdErrors must be an array of 10 elements",
      ["undefined", () => fitParams({ values: fit.values }, PARAMS)]],
    ["RangeError", "length1 must be finite and above 0 m",
      ["-1", () => fitParams({ values: [3, 1, 1, 1, 1, -1, 0, 0, 0, 0], stdErrors }, PARAMS)]],
    ["RangeError", "s must be finite and above 0 rad²",
      ["-2", () => dlqe(model, EYE, [1, -2])]],
    ["RangeError", "w must be symmetric and positive semidefinite",
      ["0.5", () => dlqe(model, [[1, 0.5, 0, 0], ...EYE.slice(1)], [1, 1])]],
    ["RangeError", "counts must be finite and above 0 for a turn",
      ["-4096", () => new Controller({ ...settings, counts: [4096, -4096] })]],
    ["RangeError", "count2 must be an integer of 32 bits",
      ["1.5", () => new Controller(settings).tick(1, 1.5)]],
    ["TypeError", "controller must be a Controller",
      ["[object Planner]", () => new Replanner(settings).exchange(planner)]],
  ]);
  const rejects = (call, message) => assert.throws(call, { name: "RangeError", message });
  rejects(hold(EYE, { gravity: 0 }), /^the torque must reach each motion that grows/);
  rejects(() => dlqe(model, EYE, [1, 1]), /^the measured angles must show each motion/);
  planner.free();
  planner.free();
  const freed = { name: "Error", message: "the planner has been freed" };
  assert.throws(() => planner.plan(HANGING, { steps: 10 }), freed);
});
