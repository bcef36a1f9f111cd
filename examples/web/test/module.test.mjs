// The modules without a page: their size, their bits, and how numbers and actions are written.

import assert from "node:assert/strict";
import { readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { shortest } from "../page/game.js";
import { decodeActions, encodeActions } from "../page/link.js";
import { Acrobot, DEFAULTS } from "../page/module.js";
import { ACTIONS, trace } from "./host.mjs";

const dist = join(import.meta.dirname, "../dist");

test("the modules are within their limits", () => {
  for (const [name, kib] of [["acrobot-simd128", 48], ["acrobot", 48], ["simulation", 12]]) {
    const { size } = statSync(join(dist, `${name}.wasm`));
    assert.ok(size <= kib * 1024, `${name}.wasm has ${size} bytes; allowed are ${kib * 1024}`);
  }
});

test("the plain simulation has the host's bits", async () => {
  const acrobot = await Acrobot.load(await WebAssembly.compile(readFileSync(join(dist, "simulation.wasm"))));
  const now = () => Array.from(new Uint32Array(acrobot.numbers().buffer, 0, 4), (word) => word.toString(16).padStart(8, "0"));
  acrobot.setParams({ ...DEFAULTS, dynamics: "nips" });
  acrobot.reset(7n);
  const states = [now(), ...ACTIONS.map((action) => (acrobot.step(action), now()))];
  assert.deepEqual(states, trace("7", ACTIONS, "--dynamics", "nips"));
});

test("numbers are written in the fewest digits of single precision", () => {
  for (const text of ["0", "0.1", "-0.054791212", "3.1415927", "1e-7", "16777216"]) {
    assert.equal(shortest(Math.fround(Number(text))), text);
  }
});

test("actions survive the way through a link", () => {
  for (let length = 0; length <= 9; length++) {
    const actions = Array.from({ length }, (_, i) => (i * 2 + 1) % 3);
    assert.deepEqual(decodeActions(encodeActions(actions)), actions);
  }
});
