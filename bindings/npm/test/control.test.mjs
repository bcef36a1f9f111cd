// What results.test.mjs does not show of control, and invalid arguments.

import assert from "node:assert/strict";
import { test } from "node:test";

import {
  Controller, Estimator, Planner, Regression, Replanner, SwingUp, deviationFrom, dlqe, fitParams,
  identify, planTorque, regulator,
} from "../dist/control.js";
import { Acrobot } from "../dist/index.js";
import { assertRejected } from "./module.mjs";

const state = (theta1, theta2 = 0, dtheta1 = 0, dtheta2 = 0) =>
  ({ theta1, theta2, dtheta1, dtheta2 });
const HANGING = state(0);
const UPRIGHT = state(Math.PI);
const EYE = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]];
const PARAMS = { dt: 0.01 };
const planned = () => {
  const planner = new Planner(PARAMS, 7);
  return [planner, planner.plan(HANGING, { steps: 1100, seed: 0 })];
};
test("a plan is improved in place for other weights and another start", () => {
  const [, plan] = planned();
  const jumps = ({ torques }) =>
    torques.slice(1).reduce((sum, torque, i) => sum + (torque - torques[i]) ** 2, 0);
  const before = jumps(plan);
  const smooth = new Planner(PARAMS, 7, { torqueChange: 10, angles: [0.1, 0] });
  const costs = [1, 30, 30].map((iterations) => smooth.improve(state(0.05), iterations, plan));
  assert.ok(costs[0] > costs[1] && costs[1] >= costs[2], costs.join());
  assert.ok(jumps(plan) < before / 2);
  assert.equal(plan.states[0], Math.fround(0.05));
  assert.ok(smooth.holdsFrom(UPRIGHT) && !smooth.withVelocityClamp().holdsFrom(HANGING));
  // A rejected plan is as before.
  const copy = structuredClone(plan);
  assert.throws(() => smooth.improve(state(0, 0, 3e38), 2, plan), /must be finite in each element/);
  assert.deepEqual(plan, copy);
});

const near = (one, other, most) => assert.ok(Math.abs(one - other) < most, `${one}, ${other}`);

test("a controller and a replanner swing a machine with encoders up", () => {
  // RealAIGym's acrobot, whose motor has 6 N m.
  const links = { length1: 0.2, length2: 0.3, mass1: 0.523, mass2: 0.626 };
  const centers = { centerOfMass1: 0.2, centerOfMass2: 0.256, inertia1: 0.011, inertia2: 0.0099 };
  const bounds = { maxVelocity1: Infinity, maxVelocity2: Infinity };
  const params = { ...links, ...centers, ...bounds, dt: 0.002 };
  const settings = { params, limit: 6, counts: [4096, 4096], ticks: 5 };
  const [controller, replanner] = [new Controller(settings), new Replanner(settings)];
  const machine = new Acrobot({ params });
  machine.state = state(0.05);
  for (let tick = 0; tick < 4000; tick++) {
    const { theta1, theta2 } = machine.state;
    const counts = [theta1, theta2].map((angle) => Math.round((angle / 2 / Math.PI) * 4096));
    machine.stepTorque(controller.tick(...counts));
    if (tick % 10) continue;
    replanner.exchange(controller);
    replanner.work();
  }
  near(deviationFrom(machine.state, UPRIGHT).theta1, 0, 0.1);
  near(controller.state.theta2, machine.state.theta2, 0.01);
  near(controller.params.mass2, 0.626, 0.1);
  assert.equal(controller.params.maxVelocity1, 3.4028234663852886e38);
});

test("without a plan, the torque pumps energy and then holds", () => {
  const swingUp = new SwingUp(PARAMS, 7);
  const acrobot = new Acrobot({ seed: 42, params: PARAMS });
  for (let i = 0; i < 6000; i++) acrobot.stepTorque(swingUp.torque(acrobot.state));
  assert.ok(acrobot.tipHeight > 1.999);
  assert.equal(new Planner(PARAMS, 7).plan(HANGING, { steps: 10, tries: 3 }), null);
});

test("invalid arguments are rejected with Rust's messages", () => {
  const [planner, plan] = planned();
  const make = (limit, cost) => () => new Planner(PARAMS, limit, cost);
  const hold = (q, r = 1, at = UPRIGHT, params = PARAMS) => () => regulator(params, q, r, at);
  const first = (...row) => [row, ...EYE.slice(1)];
  const settings = { params: PARAMS, limit: 6, counts: [4096, 4096], ticks: 5 };
  const [regression, stdErrors] = [new Regression(), new Float64Array(10)];
  const add = (dt, gravity = 9.8, half = 1, window = 1) => () =>
    regression.add({ angles: [0, 0], torques: [0] }, dt, gravity, half, window);
  const fit = regression.fit();
  assert.equal(fit.rankDeficiency, 10);
  const model = { a: EYE, b: [0, 0, 0, 0] };
  assertRejected([
    ["RangeError", "dt must be finite and above 0 s", ["-1", hold(EYE, 1, UPRIGHT, { dt: -1 })]],
    ["RangeError", "r must be finite and above 0 per (N m)²", ["-0.1", hold(EYE, -0.1)]],
    ["TypeError", "q[0][1] must be a number", ["null", hold(first(1, null, 0, 0))]],
    ["RangeError", "q must be symmetric and positive semidefinite",
      ["0.5", hold(first(1, 0.5, 0, 0))], ["1", hold(first(-1, 0, 0, 0))]],
    ["RangeError",
      "target must be in equilibrium: at rest, accelerating at most 0.25 % of a fall",
      ["0.5", hold(EYE, 1, state(0, 0, 0.5))]],
    ["RangeError", "limit must be finite and above 0 N m", ["-0.3", make(-0.3)]],
    ["TypeError", "steps must be an integer from 1 to 2^16 - 1",
      ["undefined", () => planner.plan(HANGING, {})]],
    ["RangeError", "steps must be an integer from 1 to 2^16 - 1",
      ["65536", () => planner.plan(HANGING, { steps: 65_536 })]],
    ["RangeError",
      "seed must be an integer from 0 to 2^53 - 1, or a BigInt from 0 to 2^64 - 1",
      [`${2n ** 64n}n`, () => planner.plan(HANGING, { steps: 9, seed: 2n ** 64n })]],
    ["RangeError", "theta1 must be a finite number of rad",
      ["NaN", () => planner.plan(state(NaN), { steps: 10 })]],
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
    ["TypeError", "torqueStd must be a number",
      ["undefined", () => new Estimator(PARAMS, { angleStd: 1 })]],
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
      ["0.5", () => dlqe(model, first(1, 0.5, 0, 0), [1, 1])]],
    ["RangeError", "counts must be finite and above 0 for a turn",
      ["-4096", () => new Controller({ ...settings, counts: [4096, -4096] })]],
    ["RangeError", "count2 must be an integer of 32 bits",
      ["1.5", () => new Controller(settings).tick(1, 1.5)]],
    ["TypeError", "controller must be a Controller",
      ["[object Planner]", () => new Replanner(settings).exchange(planner)]],
  ]);
  const rejects = (call, message) => assert.throws(call, { name: "RangeError", message });
  const [one, two] = [-0.1, [-0.1, -0.2]];
  const single = { torque: one, torqueChange: one, power: one, below: one, margin: one };
  const weights = { ...single, arrival: one, angles: two };
  for (const [name, weight] of Object.entries(weights)) {
    rejects(make(1, { [name]: weight }), new RegExp(`^${name} must be finite and .*, got -0.1$`));
  }
  const reach = "the torque must reach each motion that grows or persists, but does not reach one";
  rejects(hold(EYE, 1, UPRIGHT, { gravity: 0 }), reach);
  const shown = /^the measured angles must show each motion that grows or persists, but do not/;
  rejects(() => dlqe(model, EYE, [1, 1]), shown);
  planner.free();
  planner.free();
  const message = "the planner has been freed";
  assert.throws(() => planner.plan(HANGING, { steps: 10 }), { name: "Error", message });
});
