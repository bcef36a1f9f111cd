// Reading an argument can run code of the caller, or be of memory that other threads write.

import assert from "node:assert/strict";
import { test } from "node:test";

import { Acrobot, Batch } from "../dist/index.js";

const PARAMS = { dt: 0.05, torques: [-2, 0, 2], torqueNoise: 0.1 };
const STATE = { theta1: 1, theta2: 2, dtheta1: 3, dtheta2: 4 };
const SNAPSHOT = new Acrobot({ seed: 3, params: PARAMS }).snapshot();

/** Arguments and their uses. */
const USES = {
  acrobot: [
    [PARAMS, (acrobot, params) => acrobot.setParams(params)],
    [{ mass1: [1, 2] }, (acrobot, draws) => acrobot.setDraws(draws)],
    [[1, 2], (acrobot, mass1) => acrobot.setDraws({ mass1 })],
    [STATE, (acrobot, state) => (acrobot.state = state)],
  ],
  batch: [
    [[2, 2, 2], (batch, actions) => batch.step(actions)],
    [[2, -2, 0.5], (batch, torques) => batch.stepTorque(torques)],
    [[true, 0, 1], (batch, mask) => batch.resetMasked(mask)],
    [new Array(12).fill(0.5), (batch, states) => batch.setStates(states)],
    [STATE, (batch, state) => batch.setStateOf(1, state)],
    [PARAMS, (batch, params) => batch.setParams(params)],
  ],
};
const make = {
  acrobot: () => new Acrobot({ seed: 1 }),
  batch: () => new Batch({ seed: 1, count: 3 }),
};
const both = () => [make.acrobot(), make.batch()];
const snapshots = (all) => all.map((each) => each.snapshot());

/** The object, whose getters call `act` first. */
function acting(object, act) {
  const made = Array.isArray(object) ? [] : {};
  for (const [name, value] of Object.entries(object)) {
    Object.defineProperty(made, name, { get: () => (act(), value), enumerable: true });
  }
  return made;
}

for (const kind of ["acrobot", "batch"]) {
  test(`an argument that frees the ${kind} is rejected, and changes no other memory`, () => {
    for (const [given, use] of USES[kind]) {
      const [one, others] = [make[kind](), []];
      // Others get its memory.
      const argument = acting(given, () => (one.free(), others.push(...both())));
      const message = `the ${kind} has been freed`;
      assert.throws(() => use(one, argument), { name: "Error", message });
      assert.deepEqual(snapshots(others.slice(0, 2)), snapshots(both()));
    }
  });

  test(`an argument that uses the ${kind}, and makes the memory grow, acts before the call`, () => {
    for (const [given, use] of USES[kind]) {
      const [one, other] = [make[kind](), make[kind]()];
      use(one, acting(given, () => (one.setParams({}), new Batch({ count: 20_000 }))));
      use(other, given);
      assert.deepEqual(one.snapshot(), other.snapshot(), String(use));
    }
  });
}

test("arrays in shared and detached memory have the elements that they have", () => {
  const shared = (bytes) => {
    const array = new Uint8Array(new SharedArrayBuffer(bytes.length));
    array.set(bytes);
    return array;
  };
  const [one, other] = [make.batch(), make.batch()];
  assert.deepEqual(one.step(shared([0, 1, 2])), other.step([0, 1, 2]));
  assert.deepEqual(Acrobot.restore(shared(SNAPSHOT)).snapshot(), SNAPSHOT);

  const detached = Uint8Array.of(0, 1, 2);
  structuredClone(detached, { transfer: [detached.buffer] });
  assert.throws(() => one.step(detached), /^RangeError: actions must have 3 elements, got 0$/);
});

test("results that the caller changes or transfers do not change later ones", () => {
  const options = { seed: 1, count: 3, autoreset: "SameStep" };
  const [one, other] = [new Batch(options), new Batch(options)];
  const results = one.step([0, 1, 2]);
  other.step([0, 1, 2]);
  const { observations } = results;
  results.rewards = results.more = delete results.truncated;
  const taken = one.step([0, 1, 2]);
  assert.deepEqual(taken, other.step([0, 1, 2]));
  assert.equal(one.observations, observations);

  structuredClone(taken, { transfer: Object.values(taken).map(({ buffer }) => buffer) });
  assert.deepEqual(one.observations, other.observations);
  assert.deepEqual(one.step([0, 1, 2]), other.step([0, 1, 2]));
});
