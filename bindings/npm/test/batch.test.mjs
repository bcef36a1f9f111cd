// Acrobots of a batch have the bits of acrobots alone. Memory is used again.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { setFlagsFromString } from "node:v8";
import { runInNewContext } from "node:vm";

import { Acrobot, Batch } from "../dist/index.js";
import { ACTION, SEED, assertRejected, changed, instance, randoms, sealed } from "./module.mjs";

const COUNT = 21; // the last block is partly filled
const PARAMS = { torqueNoise: 0.5, mass1: 1.5, torques: [-1, 0, 1.5] };
const OPTIONS = { seed: 42n, count: COUNT, maxSteps: 25, params: PARAMS };

/** The seed's `i`-th child, which NumPy's `SeedSequence` spawns. Acrobot 0 has no such seed. */
const child = (seed, i) => seed + (BigInt(i) << 128n);
const alone = ({ count, seed, ...options }) =>
  Array.from({ length: count }, (_, i) => new Acrobot({ seed: child(seed, i), ...options }));

const random = randoms();
const randomActions = () => Uint8Array.from({ length: COUNT }, () => random(3));
const all = (action) => new Uint8Array(COUNT).fill(action);

/** The row of an array with six numbers for each acrobot. */
const row = (array, i) => array.slice(6 * i, 6 * i + 6);

/** Returns a function that steps a batch and acrobots alone by one method, and compares them. */
function together(batch, others) {
  const { autoreset } = batch.settings;
  const ended = new Array(COUNT).fill(false);
  return (method, inputs) => {
    const results = batch[method](inputs);
    for (let i = 1; i < COUNT; i++) {
      const [other, found] = [others[i], [results.rewards[i], results.ended[i]]];
      if (autoreset === "NextStep" && ended[i]) {
        other.reset();
        ended[i] = false;
        assert.deepEqual(found, [0, 0]);
      } else {
        const isOver = autoreset === "Disabled" && ended[i] && other.elapsedSteps > 0;
        const { observation, reward, terminated, truncated } = other[method](inputs[i]);
        ended[i] = isOver || terminated || truncated;
        assert.deepEqual(found, [reward, Number(ended[i])]);
        const flags = [results.terminated[i], results.truncated[i]];
        assert.deepEqual(flags, [Number(terminated), Number(truncated)]);
        if (autoreset === "SameStep" && ended[i]) {
          assert.deepEqual(row(results.finalObservations, i), observation);
          other.reset();
        }
      }
      assert.deepEqual(row(results.observations, i), other.observation);
      const seen = [batch.stateOf(i), batch.elapsedStepsOf(i), batch.paramsOf(i)];
      assert.deepEqual(seen, [other.state, other.elapsedSteps, other.params]);
    }
    assert.equal("finalObservations" in results, autoreset === "SameStep");
    return results;
  };
}

for (const autoreset of ["NextStep", "SameStep", "Disabled"]) {
  test(`with ${autoreset}, acrobots of a batch have the bits of acrobots alone`, () => {
    const [batch, others] = [new Batch({ ...OPTIONS, autoreset }), alone(OPTIONS)];
    const step = together(batch, others);
    for (let steps = 0; steps < 80; steps++) {
      const actions = randomActions();
      const { ended } = step("step", steps % 2 ? actions : [...actions]);
      if (autoreset !== "Disabled" || steps % 10 !== 9) continue;
      const mask = Array.from(ended, Boolean);
      const seed = steps > 60 ? 7n : undefined;
      const observations = batch.resetMasked(steps % 20 < 10 ? ended : mask, seed);
      for (let i = 1; i < COUNT; i++) {
        if (mask[i]) others[i].reset(seed && child(seed, i));
        assert.deepEqual(row(observations, i), others[i].observation);
        assert.equal(batch.elapsedStepsOf(i), others[i].elapsedSteps);
      }
    }
  });
}

test("other tasks, whose resets draw parameters, have the bits of acrobots alone", () => {
  const torques = ["fixed", "fixed", [1, 2]];
  const draws = { friction1: [0, 0.1], mass2: [0.8, 1.2], gravity: [9.8, 9.8], torques };
  const shared = { ...OPTIONS, params: { torqueNoise: 0.1 }, draws };
  for (const [task, autoreset] of [["swingup", "NextStep"], ["balance", "SameStep"]]) {
    const options = { ...shared, task };
    const [batch, others] = [new Batch({ ...options, autoreset }), alone(options)];
    const step = together(batch, others);
    const masses = new Set();
    for (let steps = 0; steps < 60; steps++) {
      const torques = Float32Array.from(all(0), () => random(401) / 100 - 2);
      if (steps % 3 === 0) step("step", randomActions());
      else step("stepTorque", steps % 2 ? torques : [...torques]);
      for (const { params } of others) masses.add(params.mass2);
    }
    assert.ok(masses.size > 2 * COUNT, `${masses.size} masses`);
    const resumed = Batch.restore(batch.snapshot());
    assert.deepEqual(resumed.settings, batch.settings);
    // A snapshot has the draws.
    for (let steps = 0; steps < 30; steps++) {
      const [one, other] = [resumed, batch].map((each) => each.step(all(2)));
      assert.deepEqual([one.observations, one.rewards], [other.observations, other.rewards]);
    }
    batch.setDraws({});
    const { mass2 } = batch.paramsOf(3);
    batch.reset();
    assert.equal(batch.paramsOf(3).mass2, mass2);
  }
});

test("resets draw as NumPy does, after the initial state, alone and in a batch", () => {
  const draws = {
    mass2: [0.8, 1.2],
    inertia1: { logUniform: [0.5, 2] },
    inertia2: "asBefore",
    gravity: { normal: [9.8, 0.1, 9.5, 10.1] },
  };
  const batch = new Batch({ seed: 42, count: 3, draws });
  const file = new URL("../../../tests/data/draws.csv", import.meta.url);
  const rows = readFileSync(file, "utf8").trimEnd().split("\n").slice(1);
  const found = ({ mass2, inertia1, inertia2, gravity }, state) =>
    [mass2, inertia1, inertia2, gravity, ...Object.values(state)];
  for (const row of rows) {
    const [seed, child, ...drawn] = row.split(",");
    const expected = drawn.map((number) => Math.fround(number));
    const acrobot = new Acrobot({ seed: Number(seed), draws });
    for (const reset of [() => {}, () => (batch.reset(42), acrobot.reset(Number(seed)))]) {
      reset();
      const { params, state } = acrobot;
      const inBatch = () => found(batch.paramsOf(Number(child)), batch.stateOf(Number(child)));
      assert.deepEqual(child ? inBatch() : found(params, state), expected);
    }
  }
  assert.equal(rows.length, 13);
  batch.setParamsOf(1, { mass1: 3 });
  batch.resetMasked([0, 1, 0], 7);
  assert.deepEqual([0, 1].map((i) => batch.paramsOf(i).mass1), [1, 3]);
});

test("draws and parameters are checked together, and a restored acrobot draws nothing", () => {
  const acrobot = new Acrobot({ seed: 1, draws: { inertia1: [0, 1] } });
  const message = /^inertia1 must be above 0 if the centre of mass is on the joint, .*, got 0$/;
  assert.throws(() => acrobot.setParams({ centerOfMass1: 0 }), { message });
  assert.equal(acrobot.params.centerOfMass1, 0.5);
  acrobot.reset();
  const { inertia1 } = acrobot.params;
  assert.notEqual(inertia1, 1);
  acrobot.restore(acrobot.snapshot());
  acrobot.reset();
  assert.equal(acrobot.params.inertia1, inertia1);
});

test("acrobots of a batch can have other states", () => {
  const [batch, others] = [new Batch(OPTIONS), alone(OPTIONS)];
  const states = Array.from(batch.states);
  [0.5, -0.5, 1, -1].forEach((number, i) => (states[4 * 7 + i] = number));
  batch.setStates(states);
  batch.setStateOf(5, { theta1: 1, theta2: -2, dtheta1: 3, dtheta2: -4 });
  for (const i of [5, 7]) {
    others[i].state = batch.stateOf(i);
    assert.deepEqual(row(batch.observations, i), others[i].observation);
    assert.deepEqual([...batch.states.slice(4 * i, 4 * i + 4)], Object.values(others[i].state));
  }
  assert.equal(others[7].state.theta2, -0.5);
  together(batch, others)("step", all(2));
});

test("a batch's snapshot continues with the same bits", () => {
  for (const autoreset of ["NextStep", "SameStep", "Disabled"]) {
    const batch = new Batch({ ...OPTIONS, autoreset });
    batch.setStateOf(1, { theta1: Math.PI, theta2: 0, dtheta1: 0, dtheta2: 0 });
    batch.step(all(1));
    // With "Disabled" it has ended all the same.
    batch.setStateOf(1, { theta1: 0, theta2: 0, dtheta1: 0, dtheta2: 0 });
    const resumed = Batch.restore(batch.snapshot());
    for (const name of ["settings", "observations", "params"]) {
      assert.deepEqual(resumed[name], batch[name]);
    }
    assert.deepEqual(resumed.snapshot(), batch.snapshot());
    for (let steps = 0; steps < 40; steps++) {
      const actions = randomActions();
      // Rows of acrobots that did not end are not in a snapshot.
      const [results, expected] = [resumed, batch].map((each) => each.step(actions));
      assert.deepEqual({ ...results, finalObservations: 0 }, { ...expected, finalObservations: 0 });
    }
  }
});

test("acrobots with own parameters have the bits of acrobots alone, also after a snapshot", () => {
  const batch = new Batch({ ...OPTIONS, ownParams: true });
  const others = alone(OPTIONS);
  const params = () => others.map((_, i) => batch.paramsOf(i));
  others.forEach((other, i) => {
    const torques = [-1 - i / 8, 0, 1];
    const changes = { mass2: 1 + i / 8, dynamics: i % 2 ? "nips" : "book", torques };
    batch.setParamsOf(i, changes);
    other.setParams(changes);
  });
  const resumed = Batch.restore(batch.snapshot());
  assert.deepEqual(resumed.snapshot(), batch.snapshot());
  const step = together(batch, others);
  for (let steps = 0; steps < 20; steps++) {
    const actions = randomActions();
    assert.deepEqual(step("step", actions), resumed.step(actions));
  }
  // Parameters that a change does not name stay those of each acrobot.
  for (const each of [batch, ...others]) each.setParams({ dt: 0.1, torques: [-2, 0, 2] });
  assert.deepEqual(params(), others.map(({ params }) => params));
  batch.setParamsOf(COUNT - 1, { centerOfMass1: 0 });
  const before = params();
  for (const [call, message] of [
    [() => batch.setParams({ inertia1: 0 }), /^RangeError: inertia1 must be above 0 if/],
    [() => batch.setParamsOf(COUNT, { mass1: 1 }), /index must be/],
    [() => new Batch({ ...OPTIONS, ownParams: 1 }), /^TypeError: ownParams must be .*, got 1$/],
  ]) {
    assert.throws(call, message);
    assert.deepEqual(params(), before);
  }
});

test("a batch's snapshot has the bytes of Rust's postcard, and any other is rejected", () => {
  // What version 4 stored for two acrobots with own parameters, draws and other bounds.
  const stored = new URL("../../../tests/data/snapshots_4.txt", import.meta.url);
  const [line] = /^03056261746368.*$/m.exec(readFileSync(stored, "utf8"));
  const content = Buffer.from(line, "hex");
  const snapshot = sealed(content);
  const batch = Batch.restore(snapshot);
  const task = "acrobot";
  const settings = { count: 2, maxSteps: 30, autoreset: "NextStep", ownParams: true, task };
  assert.deepEqual(batch.settings, settings);
  assert.deepEqual(Buffer.from(batch.snapshot()), snapshot);
  assert.notDeepEqual(batch.stateOf(0), batch.stateOf(1));
  const { mass2 } = batch.paramsOf(0);
  batch.reset();
  assert.notEqual(batch.paramsOf(0).mass2, mass2);

  const restores = (bytes) => {
    try {
      const batch = Batch.restore(bytes);
      batch.step(Uint8Array.of(2, 2));
      batch.free();
      return true;
    } catch ({ name, message }) {
      assert.match(`${name}: ${message}`, /^RangeError: the snapshot must be an undamaged one /);
      return false;
    }
  };
  for (let length = 0; length < content.length; length++) {
    assert.ok(!restores(sealed(content.subarray(0, length))));
    for (const value of [0, 127, 128, 255]) {
      const restored = restores(changed(snapshot, length, value));
      // The number of acrobots and the header have only one value.
      if (length < 23) assert.equal(restored, value === content[length]);
    }
  }
  assert.ok(!restores(sealed(Buffer.concat([content, Buffer.of(0)]))));
  assert.ok(!restores(new Acrobot().snapshot()));
});

test("invalid arguments are rejected, and nothing changes", () => {
  const batch = new Batch({ seed: 1, count: 3 });
  const before = batch.observations.slice();
  const step = (actions) => () => batch.step(actions);
  const torque = (torques) => () => batch.stepTorque(torques);
  const reset = (...given) => () => batch.resetMasked(...given);
  const make = (options) => () => new Batch(options);
  const rows = [
    ["RangeError", "actions must have 3 elements", ["2", step(new Uint8Array(2))]],
    ["TypeError", "actions must be an array of 3 elements", ["undefined", step()], ["3", step(3)]],
    ["RangeError", `actions[1] ${ACTION}`,
      ["3", step(Uint8Array.of(0, 3, 1))], ["-1", step(Int32Array.of(0, -1, 1))],
      ["258", step([0, 258, 1])]],
    ["TypeError", `actions[1] ${ACTION}`,
      ["undefined", step([0, , 1])], ['"2"', step([0, "2", 1])]],
    ["RangeError", "torques[1] must be a finite number of N m",
      ["NaN", torque(Float32Array.of(0, NaN, 1))],
      ["1e+39, which is Infinity in single precision", torque([0, 1e39, 1])]],
    ["RangeError", "states must have 12 elements", ["3", () => batch.setStates([1, 2, 3])]],
    ["RangeError", "states[6] must be a finite number of rad or rad/s",
      ["Infinity", () => batch.setStates([0, 0, 0, 0, 0, 0, Infinity, 0, 0, 0, 0, 0])]],
    ["RangeError", "mask[1] must be true, false, 1 or 0", ["2", reset([1, 2, 1])]],
    ["RangeError", SEED, ["-1", reset([1, 1, 1], -1)]],
    ["RangeError", "index must be an integer from 0 to 2",
      ["3", () => batch.setStateOf(3, {})],
      ["-1", () => batch.elapsedStepsOf(-1)]],
    ["TypeError", "index must be an integer from 0 to 2", ['"0"', () => batch.stateOf("0")]],
    ["RangeError", "ownParams must be true for parameters of each acrobot",
      ["false", () => batch.setParamsOf(0, { mass1: 2 })],
      ["false", () => batch.setDraws({ mass1: [1, 2] })],
      ["false", make({ count: 1, draws: { mass1: [1, 2] }, ownParams: false })]],
    ["TypeError", "options must be a plain object", ["undefined", make()]],
    ["TypeError", "count must be an integer from 1 to 2^32 - 1", ["undefined", make({})]],
    ["RangeError", "acrobots must fit into WebAssembly's memory of at most 4 GiB",
      ["200000000 more", make({ count: 2e8 })], ["4294967295 more", make({ count: 2 ** 32 - 1 })]],
    ["TypeError", 'autoreset must be "NextStep" or "SameStep" or "Disabled"',
      ['"nextStep"', make({ count: 1, autoreset: "nextStep" })]],
  ];
  assertRejected(rows, () => {
    assert.deepEqual(batch.observations, before);
    assert.deepEqual(batch.reset(1), before);
  });
  batch.free();
  for (const use of [
    step([0, 0, 0]),
    () => batch.setStates(new Float32Array(12)),
    reset([1, 1, 1]),
    ...["reset", "stateOf", "elapsedStepsOf", "snapshot"].map((name) => () => batch[name](0)),
    ...["params", "states"].map((name) => () => batch[name]),
  ]) {
    assert.throws(use, /^Error: the batch has been freed$/);
  }
});

test("memory grows while batches are in use, and is used again once they are freed", async () => {
  const { Acrobot, Batch, size } = await instance();
  const [batch, same] = [new Batch({ seed: 5, count: 100 }), new Batch({ seed: 5, count: 100 })];
  const acrobot = new Acrobot({ seed: 5 });
  const expected = new Acrobot({ seed: 5 }).step(2);
  const actions = new Uint8Array(100).fill(2);
  const results = batch.step(actions);
  const before = size();
  const large = new Batch({ seed: 1, count: 50_000 });
  assert.ok(size() > before, "the memory must have grown");
  assert.deepEqual(same.step(actions), results);
  assert.deepEqual(batch.step(actions), same.step(actions));
  assert.deepEqual(acrobot.step(2), expected);
  large.free();

  const grown = size();
  // Two acrobots that claim to be ten million.
  const content = new Batch({ count: 2 }).snapshot().subarray(1, -4);
  const claim = sealed(Buffer.concat([Buffer.from("81ade204", "hex"), content]));
  assert.throws(() => Batch.restore(claim), /with invalid contents$/);
  for (let i = 0; i < 50; i++) {
    new Batch({ count: 1 + ((i * 7919) % 50_000), seed: i }).free();
    assert.throws(() => new Batch({ count: 1000, params: { dt: -1 } }));
  }
  for (let i = 0; i < 200; i++) {
    for (const acrobot of Array.from({ length: 100 }, () => new Acrobot())) acrobot.free();
  }
  assert.equal(size(), grown);

  setFlagsFromString("--expose-gc");
  const collect = runInNewContext("gc");
  for (let i = 0; i < 20; i++) {
    for (let j = 0; j < 20; j++) new Batch({ count: 1000, seed: j });
    collect();
    await new Promise((resolve) => setTimeout(resolve));
  }
  assert.ok(size() < grown + 20e6, `${size()} bytes after ${grown}`);
});
