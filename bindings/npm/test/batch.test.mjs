// Acrobots of a batch have the bits of acrobots alone. Memory is used again.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { setFlagsFromString } from "node:v8";
import { runInNewContext } from "node:vm";

import { Acrobot, Batch } from "../dist/index.js";
import { instance, sealed } from "./module.mjs";

const COUNT = 21; // the last block is partly filled
const OPTIONS = { seed: 42n, count: COUNT, maxSteps: 25, params: { torqueNoise: 0.5, mass1: 1.5 } };

/**
 * The acrobots of a batch alone, each with a child of the seed as NumPy's `SeedSequence` spawns it.
 * Index 0 has no such seed.
 */
const alone = ({ seed, maxSteps, params }) =>
  Array.from({ length: COUNT }, (_, i) => new Acrobot({ seed: seed + (BigInt(i) << 128n), maxSteps, params }));

// A linear congruential generator, so that each run has the same actions.
let random = 1;
const action = () => ((random = (Math.imul(random, 1664525) + 1013904223) >>> 0), Math.floor((random / 2 ** 32) * 3));

/** The row of an array with six numbers for each acrobot. */
const row = (array, i) => array.slice(6 * i, 6 * i + 6);

for (const autoreset of ["NextStep", "SameStep", "Disabled"]) {
  test(`with ${autoreset}, acrobots of a batch have the bits of acrobots alone`, () => {
    const batch = new Batch({ ...OPTIONS, autoreset });
    const others = alone(OPTIONS);
    const ended = new Array(COUNT).fill(false);
    let resets = 0;
    for (let steps = 0; steps < 80; steps++) {
      const actions = Uint8Array.from({ length: COUNT }, action);
      const given = steps % 2 ? actions : [...actions];
      const results = batch.step(given);
      for (let i = 1; i < COUNT; i++) {
        if (autoreset === "NextStep" && ended[i]) {
          const found = [row(results.observations, i), results.rewards[i], results.terminated[i], results.truncated[i]];
          assert.deepEqual(found, [others[i].reset(), 0, 0, 0]);
          ended[i] = false;
          continue;
        }
        const step = others[i].step(actions[i]);
        ended[i] = (autoreset === "Disabled" && ended[i]) || step.terminated || step.truncated;
        assert.equal(results.ended[i], Number(ended[i]));
        assert.equal(results.rewards[i], step.reward);
        assert.deepEqual([results.terminated[i], results.truncated[i]], [step.terminated, step.truncated].map(Number));
        if (autoreset === "SameStep" && ended[i]) {
          resets++;
          assert.deepEqual(row(results.finalObservations, i), step.observation);
          assert.deepEqual(row(results.observations, i), others[i].reset());
        } else {
          assert.deepEqual(row(results.observations, i), step.observation);
        }
        assert.deepEqual(batch.state(i), others[i].state);
      }
      assert.equal("finalObservations" in results, autoreset === "SameStep");
      if (autoreset !== "Disabled") continue;
      ended[0] = results.ended[0] === 1; // acrobot 0 has no other
      if (steps % 10 !== 9) continue;
      const seed = steps > 60 ? 7n : undefined;
      const observations = batch.resetMasked(steps % 20 < 10 ? results.ended : ended, seed);
      for (let i = 1; i < COUNT; i++) {
        if (ended[i]) resets += others[i].reset(seed && seed + (BigInt(i) << 128n)).length > 0;
        assert.deepEqual([row(observations, i), batch.elapsed(i)], [others[i].observation, others[i].elapsed]);
      }
      ended.fill(false);
    }
    assert.equal(resets > 0, autoreset !== "NextStep");
  });
}

test("a reset draws the next initial states, or those of a seed", () => {
  const [batch, others] = [new Batch(OPTIONS), alone(OPTIONS)];
  const observations = batch.reset();
  assert.equal(observations, batch.observations);
  for (let i = 1; i < COUNT; i++) assert.deepEqual(row(observations, i), others[i].reset());
  assert.deepEqual(batch.reset(42), new Batch(OPTIONS).observations);
  assert.deepEqual(batch.params, others[0].params);
});

test("acrobots of a batch can have other states", () => {
  const batch = new Batch(OPTIONS);
  const others = alone(OPTIONS);
  const state = { theta1: 1, theta2: -2, dtheta1: 3, dtheta2: -4 };
  batch.step(new Uint8Array(COUNT));
  others.forEach((other) => other.step(0));
  batch.setState(5, state);
  others[5].state = state;
  assert.deepEqual(row(batch.observations, 5), others[5].observation);
  assert.equal(batch.elapsed(5), 1);
  const { observations } = batch.step(new Uint8Array(COUNT).fill(2));
  for (let i = 1; i < COUNT; i++) assert.deepEqual(row(observations, i), others[i].step(2).observation);
  assert.deepEqual([...new Set(batch.sample())].sort(), [0, 1, 2]);
});

test("a batch's snapshot continues with the same bits", () => {
  for (const autoreset of ["NextStep", "SameStep", "Disabled"]) {
    const batch = new Batch({ ...OPTIONS, autoreset });
    // The last step ends all episodes that have not ended before.
    for (let steps = 0; steps < OPTIONS.maxSteps; steps++) batch.step(Uint8Array.from({ length: COUNT }, action));
    const resumed = Batch.restore(batch.snapshot());
    assert.deepEqual(resumed.settings, batch.settings);
    assert.deepEqual(resumed.snapshot(), batch.snapshot());
    assert.deepEqual(resumed.observations, batch.observations);
    assert.deepEqual(resumed.params, batch.params);
    for (let steps = 0; steps < 40; steps++) {
      const actions = Uint8Array.from({ length: COUNT }, action);
      const { finalObservations: finals, ...results } = resumed.step(actions);
      const { finalObservations: expected, ...others } = batch.step(actions);
      assert.deepEqual(results, others);
      assert.deepEqual(resumed.elapsed(9), batch.elapsed(9));
    }
  }
});

test("acrobots with own parameters have the bits of acrobots alone, also after a snapshot", () => {
  const batch = new Batch({ ...OPTIONS, ownParams: true });
  const others = alone(OPTIONS);
  others.forEach((other, i) => {
    const changes = { mass2: 1 + i / 8, dynamics: i % 2 ? "nips" : "book" };
    batch.setParamsOf(i, changes);
    other.setParams(changes);
    assert.deepEqual(batch.paramsOf(i), other.params);
  });
  const resumed = Batch.restore(batch.snapshot());
  assert.deepEqual(resumed.snapshot(), batch.snapshot());
  for (let steps = 0; steps < 20; steps++) {
    const actions = Uint8Array.from({ length: COUNT }, action);
    for (const each of [batch, resumed]) each.step(actions);
    for (let i = 1; i < COUNT; i++) {
      others[i].step(actions[i]);
      for (const each of [batch, resumed]) assert.deepEqual(each.state(i), others[i].state);
    }
  }
  // Parameters that a change does not name stay those of each acrobot.
  batch.setParams({ dt: 0.1, torques: [-2, 0, 2] });
  others.forEach((other, i) => {
    other.setParams({ dt: 0.1, torques: [-2, 0, 2] });
    assert.deepEqual(batch.paramsOf(i), other.params);
  });
  batch.setParamsOf(COUNT - 1, { centerOfMass1: 0 });
  const all = () => others.map((_, i) => batch.paramsOf(i));
  const changed = all();
  assert.throws(() => batch.setParams({ inertia1: 0 }), /^RangeError: inertia1 must be above 0 kg m²/);
  assert.deepEqual(all(), changed);
  const before = batch.paramsOf(3);
  assert.throws(() => batch.setParamsOf(3, { mass1: -1 }), /^RangeError: mass1 must be finite and above 0 kg, got -1$/);
  assert.throws(() => batch.setParamsOf(COUNT, { mass1: 1 }), /index must be/);
  assert.deepEqual(batch.paramsOf(3), before);
  assert.throws(() => new Batch(OPTIONS).setParamsOf(0, { mass1: 2 }), /must be made with ownParams/);
  assert.throws(() => new Batch({ ...OPTIONS, ownParams: 1 }), /^TypeError: ownParams must be true or false, got 1$/);
});

test('with "Disabled" a snapshot is that of Rust, then `ended`, each with a checksum', () => {
  const make = (autoreset) => new Batch({ ...OPTIONS, autoreset });
  const [batch, other] = ["Disabled", "NextStep"].map(make);
  const rust = Buffer.from(other.snapshot().subarray(0, -4));
  assert.equal(rust[30], 0);
  rust[30] = 2; // the mode
  const ended = Buffer.alloc(COUNT);
  assert.deepEqual(Buffer.from(batch.snapshot()), sealed(Buffer.concat([sealed(rust), ended])));
  // One of Rust does not have `ended`.
  for (const wrong of [sealed(rust), sealed(Buffer.concat([sealed(rust), ended.fill(2)]))]) {
    assert.throws(() => Batch.restore(wrong), /^RangeError: the snapshot must be a valid one of a batch/);
  }
});

test("a batch's snapshot has the bytes of Rust's postcard, and any other is rejected", () => {
  // What version 1 stored for two acrobots with own parameters from a range: here both have those
  // of the first.
  const stored = readFileSync(new URL("../../../tests/data/snapshots_1.txt", import.meta.url), "utf8");
  const rust = Buffer.from(/^03056261746368.*$/m.exec(stored)[0], "hex");
  const bounds = Buffer.from(Float64Array.of(-0.1, 0.1).buffer);
  const parts = [rust.subarray(0, 13), bounds, rust.subarray(29, 31), Buffer.of(0, 0), rust.subarray(179, 313), rust.subarray(179, 252), rust.subarray(386)];
  const snapshot = sealed(Buffer.concat(parts));
  const batch = Batch.restore(snapshot);
  assert.deepEqual(batch.settings, { count: 2, maxSteps: 30, autoreset: "NextStep", ownParams: false });
  assert.deepEqual(Buffer.from(batch.snapshot()), snapshot);
  assert.notDeepEqual(batch.state(0), batch.state(1));

  const restores = (bytes) => {
    try {
      const batch = Batch.restore(bytes);
      batch.step(Uint8Array.of(2, 2));
      return true;
    } catch ({ name, message }) {
      assert.match(`${name}: ${message}`, /^(RangeError|TypeError): the snapshot must /);
      return false;
    }
  };
  const content = snapshot.subarray(0, -4);
  for (let length = 0; length < content.length; length++) assert.ok(!restores(sealed(content.subarray(0, length))));
  for (const other of [sealed(Buffer.concat([content, Buffer.of(0)])), content, new Acrobot().snapshot(), new Uint8Array(1000), "x", null]) {
    assert.ok(!restores(other));
  }
  for (let byte = 0; byte < content.length; byte++) {
    for (const value of [0, 127, 128, 255]) {
      const changed = Buffer.from(content);
      changed[byte] = value;
      const restored = restores(sealed(changed));
      // The settings before the limit of steps have only one value.
      if (byte < 29) assert.equal(restored, value === content[byte]);
    }
  }
  // A NaN in the state of acrobot 0.
  assert.ok(!restores(sealed(Buffer.concat([content.subarray(0, 106), Buffer.of(0, 0, 0xc0, 0x7f), content.subarray(110)]))));
  assert.throws(() => new Acrobot().restore(sealed(Buffer.alloc(300))), { message: /^the snapshot must be a valid one of "acrobot", .*, got 300 bytes$/ });
});

const ELEMENT = "must be 0 (negative torque), 1 (none) or 2 (positive), got ";

test("invalid arguments are rejected, and nothing changes", () => {
  const batch = new Batch({ seed: 1, count: 3 });
  const before = batch.observations.slice();
  const FIT = "acrobots must fit into WebAssembly's memory of at most 4 GiB, got ";
  for (const [call, name, message] of [
    [() => batch.step(new Uint8Array(2)), "RangeError", "actions must have 3 elements, got 2"],
    [() => batch.step(), "TypeError", "actions must have 3 elements, got undefined"],
    [() => batch.step(3), "TypeError", "actions must have 3 elements, got 3"],
    [() => batch.step("012"), "TypeError", `actions[0] ${ELEMENT}"0"`],
    [() => batch.step(Uint8Array.of(0, 3, 1)), "RangeError", `actions[1] ${ELEMENT}3`],
    [() => batch.step([0, 1, 258]), "RangeError", `actions[2] ${ELEMENT}258`],
    [() => batch.step([0, 1, "2"]), "TypeError", `actions[2] ${ELEMENT}"2"`],
    [() => batch.step([0, , 1]), "TypeError", `actions[1] ${ELEMENT}undefined`],
    [() => batch.step(Int32Array.of(0, -1, 1)), "RangeError", `actions[1] ${ELEMENT}-1`],
    [() => batch.resetMasked([1, 1]), "RangeError", "mask must have 3 elements, got 2"],
    [() => batch.resetMasked(), "TypeError", "mask must have 3 elements, got undefined"],
    [() => batch.resetMasked([1, 2, 1]), "RangeError", "mask[1] must be true, false, 1 or 0, got 2"],
    [() => batch.resetMasked([1, 1, 1], -1), "RangeError", /^seed must be .*, got -1$/],
    [() => batch.setState(0, { theta1: 0, theta2: NaN, dtheta1: 0, dtheta2: 0 }), "RangeError", "theta2 must be a finite number of rad, got NaN"],
    [() => batch.setState(3, {}), "RangeError", "index must be an integer from 0 to 2, got 3"],
    [() => batch.elapsed(-1), "RangeError", "index must be an integer from 0 to 2, got -1"],
    [() => batch.state(3), "RangeError", "index must be an integer from 0 to 2, got 3"],
    [() => batch.state("0"), "TypeError", 'index must be an integer from 0 to 2, got "0"'],
    [() => batch.setParams({ dt: NaN }), "RangeError", "dt must be finite and above 0 s, got NaN"],
    [() => new Batch(), "TypeError", "options must be an object, got undefined"],
    [() => new Batch({}), "TypeError", "count must be an integer from 1 to 2^32 - 1, got undefined"],
    [() => new Batch({ count: 0 }), "RangeError", "count must be an integer from 1 to 2^32 - 1, got 0"],
    [() => new Batch({ count: 2e8 }), "RangeError", `${FIT}200000000 more`],
    [() => new Batch({ count: 2 ** 32 - 1 }), "RangeError", `${FIT}4294967295 more`],
    [() => new Batch({ count: 1, autoreset: "nextStep" }), "TypeError", 'autoreset must be NextStep, SameStep, Disabled, got "nextStep"'],
    [() => new Batch({ count: 1, params: { dt: NaN } }), "RangeError", "dt must be finite and above 0 s, got NaN"],
  ]) {
    assert.throws(call, { name, message });
    assert.deepEqual(batch.observations, before);
    assert.deepEqual(batch.reset(1), before);
  }
  batch.free();
  for (const use of [() => batch.step([0, 0, 0]), () => batch.reset(), () => batch.state(0), () => batch.observations, () => batch.params, () => batch.elapsed(0), () => batch.snapshot(), () => batch.resetMasked([1, 1, 1])]) {
    assert.throws(use, { name: "Error", message: "the batch has been freed" });
  }
});

test("memory grows while batches are in use, and is used again after free and after garbage collection", async () => {
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
  for (let i = 0; i < 200; i++) {
    new Batch({ count: 1 + ((i * 7919) % 50_000), seed: i }).free();
    assert.throws(() => new Batch({ count: 1000, params: { dt: -1 } }));
  }
  for (let i = 0; i < 2000; i++) {
    const acrobots = Array.from({ length: 10 }, () => new Acrobot());
    for (const acrobot of acrobots) acrobot.free();
  }
  assert.equal(size(), grown);

  setFlagsFromString("--expose-gc");
  const collect = runInNewContext("gc");
  for (let i = 0; i < 100; i++) {
    for (let j = 0; j < 20; j++) new Batch({ count: 1000, seed: j });
    collect();
    await new Promise((resolve) => setTimeout(resolve));
  }
  assert.ok(size() < grown + 20e6, `${size()} bytes after ${grown}`);
});
