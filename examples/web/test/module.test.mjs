// The WebAssembly modules and the page's functions, tested in Node: sizes, bits, links, numbers as text.

import assert from "node:assert/strict";
import { readFileSync, statSync } from "node:fs";
import { test } from "node:test";

import { shortest } from "../page/game.js";
import { decodeActions, decodeRun, encodeActions, encodeRun } from "../page/link.js";
import { Acrobot, DEFAULTS } from "../page/module.js";
import { rangeOf } from "../page/plot.js";
import { ACTIONS, trace } from "./native.mjs";

const dist = new URL("../dist/", import.meta.url);

test("the modules do not exceed their limits of size", () => {
  for (const [name, kib] of [["acrobot-simd128", 48], ["acrobot", 48], ["simulation", 12]]) {
    const { size } = statSync(new URL(`${name}.wasm`, dist));
    assert.ok(size <= kib * 1024, `${name}.wasm must have at most ${kib * 1024} bytes, got ${size}`);
  }
});

test("the module with one acrobot, without drawing and learning, is bit-identical to native", async () => {
  const acrobot = await Acrobot.load(await WebAssembly.compile(readFileSync(new URL("simulation.wasm", dist))));
  const now = () => Array.from(new Uint32Array(acrobot.numbers().buffer, 0, 4), (word) => word.toString(16).padStart(8, "0"));
  acrobot.setParams({ ...DEFAULTS, dynamics: "nips" });
  acrobot.reset(7n);
  const states = [now(), ...ACTIONS.map((action) => (acrobot.step(action), now()))];
  assert.deepEqual(states, trace("7", ACTIONS, "--dynamics", "nips"));
});

test("numbers are written with the fewest digits that keep single precision", () => {
  for (const text of ["0", "0.1", "-0.054791212", "3.1415927", "1e-7", "16777216"]) {
    assert.equal(shortest(Math.fround(Number(text))), text);
  }
});

test("a plot can show the longest training", () => {
  const [low, high] = rangeOf(Array.from({ length: 1_000_000 }, (_, i) => -(i % 501)));
  assert.deepEqual([low, high], [-530, 30]);
});

test("a link contains all actions", () => {
  for (let length = 0; length <= 9; length++) {
    const actions = Array.from({ length }, (_, i) => (i * 2 + 1) % 3);
    assert.deepEqual(decodeActions(encodeActions(actions)), actions);
  }
});

test("any link is replayed or is rejected with the reason", async () => {
  const acrobot = await Acrobot.load(await WebAssembly.compile(readFileSync(new URL("simulation.wasm", dist))));
  const link = encodeRun({ seed: 42n, params: { ...DEFAULTS, mass1: 1.5, dt: 0.05, dynamics: "nips" }, actions: ACTIONS });
  const others = "#&=%+-_.,09eEnaAzZ \u00e9\u{1f600}";
  // A linear congruential generator, so that each test run tries the same links.
  let state = 1;
  const below = (n) => ((state = (Math.imul(state, 1664525) + 1013904223) >>> 0), Math.floor((state / 2 ** 32) * n));
  let played = 0;
  for (let i = 0; i < 20_000; i++) {
    let changed = link;
    for (let changes = below(3); changes >= 0; changes--) {
      const at = 1 + below(changed.length);
      const kept = [at, at + 1, at + 1 + below(10)][below(3)];
      changed = changed.slice(0, at) + [...others][below([...others].length)].repeat(below(3)) + changed.slice(kept);
    }
    try {
      const run = decodeRun(changed);
      assert.deepEqual(decodeRun(encodeRun(run)), run, changed);
      acrobot.setParams(run.params);
      acrobot.reset(run.seed);
      run.actions.slice(0, 10).forEach((action) => acrobot.step(action));
      assert.ok(acrobot.numbers().every(Number.isFinite), changed);
      played++;
    } catch (error) {
      assert.equal(error.constructor, Error, `${changed}: ${error.stack}`);
      assert.match(error.message, / must /, changed);
    }
  }
  assert.ok(played > 1000 && played < 19_000, `${played} of 20,000 links were replayed`);
});
