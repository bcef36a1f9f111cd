// Acrobots of a batch have the bits of acrobots alone, also after a snapshot.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { Acrobot, Batch } from "../dist/index.js";
import { randoms, sealed } from "./module.mjs";

const COUNT = 21; // the last block is partly filled
const PARAMS = { torqueNoise: 0.5, mass1: 1.5, torques: [-1, 0, 1.5] };
const OPTIONS = { seed: 42n, maxSteps: 25, params: PARAMS };
const draws = { mass2: [0.8, 1.2], gravity: [9.8, 9.8], torques: ["fixed", "fixed", [1, 2]] };

/** The seed's `i`-th child, which NumPy's `SeedSequence` spawns. Acrobot 0 has no such seed. */
const child = (seed, i) => seed + (BigInt(i) << 128n);
const alone = (options) =>
  Array.from({ length: COUNT }, (_, i) => new Acrobot({ ...options, seed: child(42n, i) }));

const random = randoms();
/** The row of an array with six numbers for each acrobot. */
const row = (array, i) => array.slice(6 * i, 6 * i + 6);

/** Returns a function that steps a batch and acrobots alone by one method, and compares them. */
function together(batch, others) {
  const { autoreset } = batch.settings;
  const done = new Array(COUNT).fill(false);
  return (method, inputs) => {
    const results = batch[method](inputs);
    for (let i = 1; i < COUNT; i++) {
      const [other, found] = [others[i], [results.rewards[i], results.done[i]]];
      if (autoreset === "NextStep" && done[i]) {
        other.reset();
        done[i] = false;
        assert.deepEqual(found, [0, 0]);
      } else {
        const isOver = autoreset === "Disabled" && done[i] && other.elapsedSteps > 0;
        const { observation, reward, terminated, truncated } = other[method](inputs[i]);
        done[i] = isOver || terminated || truncated;
        assert.deepEqual(found, [reward, Number(done[i])]);
        const flags = [results.terminated[i], results.truncated[i]];
        assert.deepEqual(flags, [Number(terminated), Number(truncated)]);
        if (autoreset === "SameStep" && done[i]) {
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

for (const [name, mode, shared] of [
  ["NextStep", { autoreset: "NextStep" }, {}],
  ["Disabled", { autoreset: "Disabled" }, {}],
  ["own parameters", { ownParams: true }, {}],
  ["a swing-up with draws", {}, { task: "swingup", draws: { ...draws, damping1: [0, 0.1] } }],
  ["SameStep and draws", { autoreset: "SameStep" }, { task: "balance", draws }],
]) {
  test(`with ${name}, acrobots of a batch have the bits of acrobots alone`, () => {
    const options = { ...OPTIONS, ...shared };
    const [batch, others] = [new Batch({ ...options, ...mode, count: COUNT }), alone(options)];
    if (mode.ownParams) {
      others.forEach((other, i) => {
        const changes = { mass2: 1 + i / 8, dynamics: i % 2 ? "nips" : "book" };
        batch.setParamsOf(i, changes);
        other.setParams({ ...changes });
      });
    }
    // Parameters that a change does not name stay those of each acrobot.
    for (const each of [batch, ...others]) each.setParams({ dt: 0.15 });
    const step = together(batch, others);
    for (let steps = 0; steps < 80; steps++) {
      const actions = Uint8Array.from({ length: COUNT }, () => random(3));
      const torques = Float32Array.from({ length: COUNT }, () => random(401) / 100 - 2);
      const [method, inputs] = steps % 3 ? ["step", actions] : ["stepTorque", torques];
      const { done } = step(method, steps % 2 ? inputs : [...inputs]);
      if (mode.autoreset !== "Disabled" || steps % 10 !== 9) continue;
      const mask = Array.from(done, Boolean);
      const seed = steps > 60 ? 7n : undefined;
      const observations = batch.resetMasked(steps % 20 < 10 ? done : mask, seed);
      for (let i = 1; i < COUNT; i++) {
        if (mask[i]) others[i].reset(seed && child(seed, i));
        assert.deepEqual(row(observations, i), others[i].observation);
      }
    }
    const resumed = Batch.restore(batch.snapshot());
    for (const name of ["settings", "observations", "params"]) {
      assert.deepEqual(resumed[name], batch[name]);
    }
    for (let steps = 0; steps < 30; steps++) {
      // Rows of acrobots that did not end are not in a snapshot.
      const [one, other] = [resumed, batch].map((each) => each.step(new Uint8Array(COUNT)));
      assert.deepEqual({ ...one, finalObservations: 0 }, { ...other, finalObservations: 0 });
    }
  });
}

test("resets draw as NumPy does, after the initial state, alone and in a batch", () => {
  const draws = {
    mass2: [0.8, 1.2],
    inertia1: { logUniform: [0.5, 2] },
    gravity: { normal: [9.8, 0.1, 9.5, 10.1] },
  };
  const batch = new Batch({ seed: 42, count: 3, draws });
  const file = new URL("../../../tests/data/draws.csv", import.meta.url);
  const rows = readFileSync(file, "utf8").trimEnd().split("\n").slice(1);
  for (const row of rows) {
    const [seed, child, ...drawn] = row.split(",");
    const expected = drawn.map((number) => Math.fround(number));
    const acrobot = new Acrobot({ seed: Number(seed), draws });
    const params = child ? batch.paramsOf(Number(child)) : acrobot.params;
    const state = child ? batch.stateOf(Number(child)) : acrobot.state;
    const { mass2, inertia1, gravity } = params;
    assert.deepEqual([mass2, inertia1, gravity, ...Object.values(state)], expected);
  }
  batch.setDraws({});
  batch.setParamsOf(1, { mass2: 3 });
  batch.reset();
  assert.equal(batch.paramsOf(1).mass2, 3);
});

test("acrobots of a batch can have other states", () => {
  const [batch, others] = [new Batch({ ...OPTIONS, count: COUNT }), alone(OPTIONS)];
  const states = Array.from(batch.states);
  [0.5, -0.5, 1, -1].forEach((number, i) => (states[4 * 7 + i] = number));
  batch.setStates(states);
  batch.setStateOf(5, { theta1: 1, theta2: -2, dtheta1: 3, dtheta2: -4 });
  others[5].state = { theta1: 1, theta2: -2, dtheta1: 3, dtheta2: -4 };
  others[7].state = { theta1: 0.5, theta2: -0.5, dtheta1: 1, dtheta2: -1 };
  for (const i of [5, 7]) assert.deepEqual(row(batch.observations, i), others[i].observation);
  together(batch, others)("step", new Uint8Array(COUNT));
});

for (const [kind, start, tail, end] of [
  // What version 6 stored for `Acrobot::<Fast>::new(3)`; a `TimeLimit` adds limit and steps.
  [Acrobot, "076163726f626f74060967796d6e617369756d0466617374", "f40300", 24],
  // Two acrobots with own parameters, draws and other bounds.
  [Batch, "03056261746368", "", 23],
]) {
  test(`a snapshot of ${kind.name} has the bytes of Rust's postcard, others are rejected`, () => {
    const stored = new URL("../../../tests/data/snapshots_6.txt", import.meta.url);
    const [line] = new RegExp(`^${start}.*$`, "m").exec(readFileSync(stored, "utf8"));
    const content = Buffer.from(line + tail, "hex");
    const snapshot = sealed(content);
    assert.deepEqual(Buffer.from(kind.restore(snapshot).snapshot()), snapshot);

    const rule = "the snapshot must be an undamaged one of the same class and version";
    /** Why bytes are rejected, or "" if they are not. */
    const reason = (bytes) => {
      try {
        const restored = kind.restore(bytes);
        restored.step(kind === Batch ? [2, 2] : 2);
        restored.free();
        return "";
      } catch ({ name, message }) {
        const [before, reason] = message.split(` bytes with `);
        assert.equal(`${name}: ${before}`, `RangeError: ${rule}, got ${bytes.length}`);
        return reason;
      }
    };
    const damaged = (at, value) => Buffer.from(content).fill(value, at, at + 1);
    for (let at = 0; at < content.length; at++) {
      assert.notEqual(reason(sealed(content.subarray(0, at))), "");
      assert.equal(reason(snapshot.subarray(0, at)), "another checksum");
      for (const value of [0, 127, 128, 255]) {
        const found = reason(sealed(damaged(at, value)));
        // The number of acrobots and the header have only one value.
        if (at < end && value !== content[at]) assert.notEqual(found, "");
      }
    }
    const others = "another class or version, or invalid contents";
    assert.equal(reason(sealed(Buffer.concat([content, Buffer.of(0)]))), others);
    const other = kind === Batch ? new Acrobot() : new Batch({ count: 5 });
    assert.equal(reason(other.snapshot()), others);
    const message = "the snapshot must be a Uint8Array, got [object ArrayBuffer]";
    assert.throws(() => kind.restore(other.snapshot().buffer), { name: "TypeError", message });
  });
}
