// What results.test.mjs does not show of a single acrobot.

import assert from "node:assert/strict";
import { test } from "node:test";

import { Acrobot, Batch } from "../dist/index.js";

test("an action has its torque, and a step what the acrobot's properties have", () => {
  const options = { seed: 42, params: { torques: [-2, 0.25, 3], dynamics: "nips" } };
  const [acrobot, other] = [new Acrobot(options), new Acrobot(options)];
  [2, 0, 1].forEach((action, i) => {
    const step = acrobot.step(action);
    assert.deepEqual(step, other.stepTorque(options.params.torques[action]));
    assert.deepEqual(step.observation, acrobot.observation);
    assert.equal(acrobot.elapsedSteps, i + 1);
  });
});

test("seeds are numbers or BigInts of any size", () => {
  const state = (seed) => new Acrobot({ seed }).state;
  const acrobot = new Acrobot({ seed: 1 });
  acrobot.reset();
  acrobot.reset(7n);
  assert.deepEqual(acrobot.state, state(7));
  const seeds = [0, 2 ** 53 - 1, 2n ** 2048n - 1n, undefined, undefined];
  assert.equal(new Set(seeds.map((seed) => Object.values(state(seed)).join())).size, 5);
});

test("parameters are what was set", () => {
  const acrobot = new Acrobot();
  const names = Object.keys(acrobot.params);
  const numbers = Object.fromEntries(names.map((name, i) => [name, i + 0.5]));
  const others = { torques: [-3, 0.25, 4], dynamics: "nips", gravity: -0, rotor: 0.125 };
  const params = { ...numbers, ...others };
  acrobot.setParams(params);
  assert.deepEqual(acrobot.params, params);
  assert.deepEqual(Acrobot.restore(acrobot.snapshot()).params, params);
  const { gravity, dt, damping2 } = new Acrobot({ task: "swingup" }).params;
  assert.deepEqual([gravity, dt, damping2], [9.81, 0.01, 0.05].map(Math.fround));
  // No bound is stored as the largest number.
  const unbounded = { params: { maxVelocity2: Infinity }, count: 2 };
  const batches = [true, false].map((ownParams) => new Batch({ ...unbounded, ownParams }));
  for (const { params } of [new Acrobot({ params: unbounded.params }), ...batches]) {
    assert.equal(params.maxVelocity2, 3.4028234663852886e38);
  }
});

test("reset, limit, state, energy and height are the crate's", () => {
  const { task, maxSteps } = new Acrobot({ task: "swingup" });
  assert.deepEqual([task, maxSteps], ["swingup", 1000]);
  const acrobot = new Acrobot({ seed: 42, maxSteps: 3 });
  assert.equal(acrobot.maxSteps, 3);
  const truncated = [1, 1, 1, 1].map((action) => acrobot.step(action).truncated);
  assert.deepEqual(truncated, [false, false, true, true]);
  const observation = acrobot.reset();
  assert.deepEqual(observation, acrobot.observation);
  assert.equal(acrobot.elapsedSteps, 0);
  acrobot.state = { theta1: Math.PI / 2, theta2: 0, dtheta1: 0, dtheta2: 3 };
  assert.ok(Math.abs(acrobot.tipHeight) < 1e-6);
  // Both links are level, so the energy is link 2's: ½ (I2 + m2 lc2²) θ̇2².
  assert.ok(Math.abs(acrobot.energy - 0.5 * 1.25 * 9) < 1e-5);
  // Arrays are copies, and objects are frozen ones.
  observation.fill(9);
  assert.notDeepEqual(observation, acrobot.observation);
  const { state, params } = acrobot;
  for (const copy of [state, params, params.torques]) assert.ok(Object.isFrozen(copy));
});

test("random actions with a seed are Gymnasium's", () => {
  const acrobot = new Acrobot();
  // space.seed(42) and space.sample() of Gymnasium 1.4.0: Discrete(3), MultiDiscrete([3] * 6).
  const samples = Array.from({ length: 12 }, (_, i) => acrobot.sample(i ? undefined : 42));
  assert.deepEqual(samples, [0, 2, 1, 1, 1, 2, 0, 2, 0, 0, 1, 2]);
  const batch = new Batch({ count: 6 });
  assert.deepEqual([...batch.sample(42n), ...batch.sample()], [2, 1, 2, 2, 0, 2, 2, 2, 0, 1, 1, 2]);
  // Without a seed they are random, also after a snapshot.
  const snapshot = new Batch({ count: 40, seed: 1 }).snapshot();
  assert.notDeepEqual(Batch.restore(snapshot).sample(), Batch.restore(snapshot).sample());
});

test("a picture has an arrow with the torque of the last step, and options", () => {
  const acrobot = new Acrobot();
  /** The calls of a canvas's context, with the colour of each. */
  const drawn = (options) => {
    const target = { calls: [], canvas: { width: 300, height: 200 } };
    const record = (name) => (...given) => {
      const style = name.startsWith("fill") ? "fillStyle" : "strokeStyle";
      target.calls.push([name, target[style], ...given].join(" "));
    };
    const get = (target, name) => target[name] ?? record(name);
    acrobot.draw(new Proxy(target, { get }), options);
    return target.calls;
  };
  /** Whether there is an arrow, and to which side. */
  const arrow = () => drawn().join("\n").match(/scale #0cc (-?0.3) 0.3/)?.[1];
  for (const [torque, width] of [[1, "0.3"], [0, undefined], [-1, "-0.3"]]) {
    acrobot.step(torque + 1);
    assert.equal(arrow(), width);
  }
  acrobot.stepTorque(0.5);
  assert.equal(arrow(), "0.3");
  acrobot.reset();
  assert.equal(arrow(), undefined);
  assert.ok(drawn().includes("fillRect white 0 0 200 200"));
  const calls = drawn({ size: 50, colors: { background: "red", link: "blue" } });
  assert.ok(calls.includes("fillRect red 0 0 50 50") && calls.includes("stroke blue"));
});
