// Memory is used again, and no argument reaches memory that is not the acrobot's: reading it can
// run code of the caller, or it can be memory that other threads write.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { setFlagsFromString } from "node:v8";
import { runInNewContext } from "node:vm";
import { inflateRawSync } from "node:zlib";

import { Acrobot, Batch } from "../dist/index.js";
import { sealed } from "./module.mjs";

const STATE = { theta1: 1, theta2: 2, dtheta1: 3, dtheta2: 4 };
const PARAMS = { dt: 0.05, torques: [-2, 0, 2], torqueNoise: 0.1 };

const make = {
  acrobot: () => new Acrobot({ seed: 1 }),
  batch: () => new Batch({ seed: 1, count: 3 }),
};
/** Arguments that have elements or properties, and their uses. */
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
  ],
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
  test(`a freed ${kind} is rejected, also if an argument frees it`, () => {
    const error = { name: "Error", message: `the ${kind} has been freed` };
    const freed = make[kind]();
    freed[Symbol.dispose]();
    freed.free();
    for (const use of ["reset", "snapshot"]) assert.throws(() => freed[use](), error);
    for (const [given, use] of USES[kind]) {
      assert.throws(() => use(freed, given), error);
      const [one, others] = [make[kind](), []];
      // Others get its memory.
      const argument = acting(given, () => (one.free(), others.push(...both())));
      assert.throws(() => use(one, argument), error);
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

test("arrays can be in shared memory, or be transferred to another thread", () => {
  const options = { seed: 1, count: 3, autoreset: "SameStep" };
  const [one, other] = [new Batch(options), new Batch(options)];
  const shared = new Uint8Array(new SharedArrayBuffer(3));
  shared.set([0, 1, 2]);
  const results = one.step(shared);
  assert.deepEqual(results, other.step([0, 1, 2]));
  results.rewards = results.more = delete results.truncated;
  structuredClone(results, { transfer: [results.observations.buffer] });
  assert.deepEqual(one.observations, other.observations);
  assert.deepEqual(one.step([0, 1, 2]), other.step([0, 1, 2]));

  const detached = Uint8Array.of(0, 1, 2);
  structuredClone(detached, { transfer: [detached.buffer] });
  assert.throws(() => one.step(detached), /^RangeError: actions must have 3 elements, got 0$/);
});

/** The package's source with its own instance of the module, whose memory a test can see. */
async function instance() {
  const bundle = readFileSync(new URL("../dist/index.js", import.meta.url), "utf8");
  globalThis.MODULE = /"([\w+/=]{10000,})"/.exec(bundle)[1];
  globalThis.LENGTH = inflateRawSync(Buffer.from(globalThis.MODULE, "base64")).length;
  const { wasm } = await import("../package/kept.js");
  const size = () => wasm().memory.buffer.byteLength;
  return { ...(await import("../package/index.js")), size };
}

test("memory grows while batches are in use, and is used again once they are freed", async () => {
  const { Acrobot, Batch, size } = await instance();
  const [batch, same] = [new Batch({ seed: 5, count: 100 }), new Batch({ seed: 5, count: 100 })];
  const actions = new Uint8Array(100).fill(2);
  const results = batch.step(actions);
  const before = size();
  const large = new Batch({ seed: 1, count: 50_000 });
  assert.ok(size() > before, "the memory must have grown");
  assert.deepEqual(same.step(actions), results);
  large.free();

  const grown = size();
  // Two acrobots that claim to be ten million.
  const content = new Batch({ count: 2 }).snapshot().subarray(1, -4);
  const claim = sealed(Buffer.concat([Buffer.from("81ade204", "hex"), content]));
  assert.throws(() => Batch.restore(claim), / or invalid contents$/);
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
