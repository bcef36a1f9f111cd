// What results.test.mjs does not show of a batch: arrays and objects have what acrobots alone have.

import assert from "node:assert/strict";
import { test } from "node:test";

import { Acrobot, Batch } from "../dist/index.js";
import { randoms, sealed } from "./module.mjs";

const COUNT = 21; // the last block is partly filled
const PARAMS = { torqueNoise: 0.5, mass1: 1.5, torques: [-1, 0, 1.5] };
const draws = { mass2: [0.8, 1.2], gravity: [9.8, 9.8], torques: ["fixed", "fixed", [1, 2]] };

/** The seed's `i`-th child, which NumPy's `SeedSequence` spawns. Acrobot 0 has no such seed. */
const child = (seed, i) => seed + (BigInt(i) << 128n);

/** A batch, and acrobots alone that do the same. */
function made(options, mode) {
  const batch = new Batch({ ...options, ...mode, seed: 42n, count: COUNT });
  const seeds = Array.from({ length: COUNT }, (_, i) => child(42n, i));
  return [batch, seeds.map((seed) => new Acrobot({ ...options, seed }))];
}

/** The row of an array with six numbers for each acrobot. */
const row = (array, i) => array.slice(6 * i, 6 * i + 6);

function assertSame(batch, others, observations = batch.observations) {
  for (let i = 1; i < COUNT; i++) {
    const seen = [batch.stateOf(i), batch.elapsedStepsOf(i), batch.paramsOf(i)];
    assert.deepEqual(seen, [others[i].state, others[i].elapsedSteps, others[i].params]);
    assert.deepEqual(row(observations, i), others[i].observation);
  }
}

test("acrobots of a batch have the bits of acrobots alone", () => {
  const settings = { task: "balance", maxSteps: 25 };
  const [batch, others] = made({ ...settings, params: PARAMS, draws }, { autoreset: "SameStep" });
  const added = { count: COUNT, ownParams: true, autoreset: "SameStep" };
  assert.deepEqual(batch.settings, { ...settings, ...added });
  const random = randoms();
  for (let count = 1; count <= 60; count++) {
    const actions = Uint8Array.from({ length: COUNT }, () => random(3));
    const torques = Float32Array.from({ length: COUNT }, () => random(401) / 100 - 2);
    const [method, inputs] = count % 3 ? ["step", actions] : ["stepTorque", torques];
    const results = batch[method](count % 2 ? inputs : [...inputs]);
    others.forEach((other, i) => {
      if (i === 0) return;
      const { reward, terminated, truncated } = other[method](inputs[i]);
      const found = ["rewards", "terminated", "truncated", "done"].map((name) => results[name][i]);
      const done = terminated || truncated;
      assert.deepEqual(found, [reward, ...[terminated, truncated, done].map(Number)]);
      if (!done) return;
      assert.deepEqual(row(results.finalObservations, i), other.observation);
      other.reset();
    });
    assertSame(batch, others, results.observations);
  }
  const resumed = Batch.restore(batch.snapshot());
  for (const name of ["settings", "observations", "params"]) {
    assert.deepEqual(resumed[name], batch[name]);
  }
  // Rows of acrobots that did not end are not in a snapshot.
  const [one, other] = [resumed, batch].map((each) => each.step(new Uint8Array(COUNT)));
  assert.deepEqual({ ...one, finalObservations: 0 }, { ...other, finalObservations: 0 });
});

test("acrobots with own parameters step on until a mask resets them", () => {
  const [batch, others] = made({ params: PARAMS }, { autoreset: "Disabled", ownParams: true });
  others.forEach((other, i) => {
    const changes = { mass2: 1 + i / 8, dynamics: i % 2 ? "nips" : "book" };
    batch.setParamsOf(i, changes);
    other.setParams(changes);
  });
  // Parameters that a change does not name stay those of each acrobot.
  for (const each of [batch, ...others]) each.setParams({ dt: 0.15 });
  const mask = Array.from({ length: COUNT }, (_, i) => i % 3 > 0);
  for (const [given, seed] of [[mask], [mask.map(Number), 7n]]) {
    for (const theta1 of [Math.PI, 0]) {
      batch.setStates(new Array(COUNT).fill([theta1, 0, 0, 0]).flat());
      const { done, ...results } = batch.step(new Uint8Array(COUNT));
      assert.ok(done.every((each) => each === 1) && !("finalObservations" in results));
      for (const other of others) {
        other.state = { theta1, theta2: 0, dtheta1: 0, dtheta2: 0 };
        other.step(0);
      }
    }
    const waiting = Batch.restore(batch.snapshot()).step(new Uint8Array(COUNT));
    assert.ok(waiting.done.every((each) => each === 1));
    const observations = batch.resetMasked(given, seed);
    others.forEach((other, i) => {
      if (mask[i]) other.reset(seed && child(seed, i));
    });
    assertSame(batch, others, observations);
  }
});

test("resets draw parameters until the draws are empty", () => {
  const batch = new Batch({ count: 2, draws });
  batch.reset();
  const drawn = batch.paramsOf(1);
  assert.ok(drawn.mass2 > 0.8 && drawn.mass2 < 1.2 && drawn.mass2 !== 1);
  batch.reset();
  assert.notEqual(batch.paramsOf(1).mass2, drawn.mass2);
  batch.setDraws({});
  batch.setParamsOf(1, { mass2: 3 });
  batch.reset();
  assert.equal(batch.paramsOf(1).mass2, 3);
});

test("acrobots of a batch can have other states", () => {
  const batch = new Batch({ params: PARAMS, count: COUNT });
  const acrobot = new Acrobot({ params: PARAMS });
  const states = Array.from(batch.states);
  [0.5, -0.5, 1, -1].forEach((number, i) => (states[4 * 7 + i] = number));
  batch.setStates(states);
  batch.setStateOf(5, { theta1: 1, theta2: -2, dtheta1: 3, dtheta2: -4 });
  for (const [i, theta1, theta2, dtheta1, dtheta2] of [[5, 1, -2, 3, -4], [7, 0.5, -0.5, 1, -1]]) {
    acrobot.state = { theta1, theta2, dtheta1, dtheta2 };
    assert.deepEqual(batch.stateOf(i), acrobot.state);
    assert.deepEqual(row(batch.observations, i), acrobot.observation);
  }
});

test("snapshots that are damaged or of another class are rejected", () => {
  const kinds = [() => new Acrobot(), () => new Batch({ count: 2 })];
  const rule = "the snapshot must be an undamaged one of the same class and version";
  for (const [i, make] of kinds.entries()) {
    const [kept, other] = [make(), kinds[1 - i]()];
    const snapshot = kept.snapshot();
    const content = snapshot.slice(0, -4);
    const rejects = (bytes, reason) => {
      const message = `${rule}, got ${bytes.length} bytes with ${reason}`;
      assert.throws(() => kept.constructor.restore(bytes), { name: "RangeError", message });
    };
    assert.deepEqual(Buffer.from(snapshot), sealed(content));
    for (let at = 0; at < content.length; at++) {
      rejects(snapshot.slice(0, at), "another checksum");
      rejects(sealed(content.slice(0, at)), "another class or version, or invalid contents");
    }
    const others = [sealed(Buffer.concat([content, Buffer.of(0)])), other.snapshot()];
    for (const bytes of others) rejects(bytes, "another class or version, or invalid contents");
    const message = "the snapshot must be a Uint8Array, got [object ArrayBuffer]";
    const call = () => kept.constructor.restore(snapshot.buffer);
    assert.throws(call, { name: "TypeError", message });
  }
});
