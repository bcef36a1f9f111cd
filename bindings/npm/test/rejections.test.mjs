// Invalid arguments are rejected, and nothing changes: what Rust rejects, from
// tests/data/rejections.jsonl, which Rust's own tests write, and what JavaScript does.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { Acrobot, Batch } from "../dist/index.js";
import { Batch as Measured } from "../dist/instruments.js";
import { camelCase } from "../package/wasm.js";
import { assertRejected } from "./module.mjs";

const path = new URL("../../../tests/data/rejections.jsonl", import.meta.url);
/** JSON has no numbers that are not finite. */
const number = (value) => (value === "inf" ? Infinity : value === "-inf" ? -Infinity : +value);

/** The parameters or the state of a row. */
function changes(set) {
  const given = {};
  for (const [name, value] of Object.entries(set)) {
    const [, index] = /^torques\[(.)\]/.exec(name) ?? [];
    if (index) given.torques = [-1, 0, 1].with(index, number(value));
    else given[camelCase(name)] = number(value);
  }
  return given;
}

function draws({ mass2 }) {
  const [[kind, numbers]] = Object.entries(mass2);
  const given = numbers.map(number);
  const name = kind[0].toLowerCase() + kind.slice(1);
  return { mass2: name === "uniform" ? given : { [name]: given } };
}

/** The calls of JavaScript for a row: of an acrobot, and of acrobot 1 of a batch. */
const CALLS = {
  params: ({ set }) => [
    (acrobot) => acrobot.setParams(changes(set)),
    (_, batch) => batch.setParams(changes(set)),
    (_, batch) => batch.setParamsOf(1, changes(set)),
  ],
  state: ({ set }) => {
    const state = { theta1: 0, theta2: 0, dtheta1: 0, dtheta2: 0, ...changes(set) };
    return [(acrobot) => (acrobot.state = state), (_, batch) => batch.setStateOf(1, state)];
  },
  torque: ({ value }) => [(acrobot) => acrobot.stepTorque(number(value))],
  action: ({ value }) => [(acrobot) => acrobot.step(value)],
  draw: ({ set }) => [
    (acrobot) => acrobot.setDraws(draws(set)),
    (_, batch) => batch.setDraws(draws(set)),
  ],
  // JavaScript has no bounds of initial states.
  bounds: () => [],
};

test("what Rust rejects is rejected with the same message, and nothing changes", () => {
  // The task with friction.
  const options = { seed: 42, task: "swingup" };
  const acrobot = new Acrobot(options);
  const batch = new Batch({ ...options, count: 2, ownParams: true });
  const snapshots = () => [acrobot.snapshot(), batch.snapshot()];
  const before = snapshots();
  const rows = readFileSync(path, "utf8").trimEnd().split("\n").map((line) => JSON.parse(line));
  for (const row of rows) {
    // "mass2 must be finite and above 0 kg, got inf"
    const [name] = row.message.split(" must be ");
    const rest = row.message.slice(name.length).replace(/inf$/, "Infinity");
    for (const call of CALLS[row.call](row)) {
      const error = { name: "RangeError", message: camelCase(name) + rest };
      assert.throws(() => call(acrobot, batch), error);
      assert.deepEqual(snapshots(), before, row.message);
    }
  }
  assert.ok(rows.length > 100);
});

const ACTION = "must be 0 (negative torque), 1 (none) or 2 (positive)";
const SEED = "seed must be an integer from 0 to 2^53 - 1, or a BigInt from 0 to 2^2048 - 1";
const DRAW =
  "mass1 must be drawn by [low, high], { logUniform: [low, high] }, " +
  '{ normal: [mean, std, low, high] } or "fixed"';

test("instruments outside their ranges are rejected, and nothing changes", () => {
  const batch = new Measured({ seed: 1, count: 2, instruments: { encoderZero1: 0.5 } });
  const before = batch.snapshot();
  const set = (instruments) => () => batch.setInstruments(instruments);
  const one = (instruments) => () => batch.setInstrumentsOf(1, instruments);
  const draw = (draws) => () => batch.setInstrumentDraws(draws);
  const DELAY = "actionDelay must be drawn uniformly from whole numbers up to DELAY, in steps";
  const names = Object.keys(batch.instrumentsOf(0));
  const rows = [
    ["RangeError", DELAY, ["9", set({ actionDelay: 9 })], ["1.5", one({ actionDelay: 1.5 })],
      ["1", draw({ actionDelay: { logUniform: [1, 2] } })]],
    ["RangeError", "motorLag must be from 0 to 1000 s", ["-1", set({ motorLag: -1 })],
      ["NaN", one({ motorLag: NaN })], ["2000", draw({ motorLag: [0, 2000] })]],
    ["TypeError", `instruments must be among ${names.join(", ")}`, ["mass1", set({ mass1: 1 })]],
    ["TypeError", `instrumentDraws must be among ${names.join(", ")}`, ["lag", draw({ lag: 1 })]],
    ["RangeError", "index must be an integer from 0 to 1", ["2", () => batch.instrumentsOf(2)],
      ["-1", () => batch.setInstrumentsOf(-1, {})]],
    ["TypeError", "count must be an integer from 1 to 2^32 - 1",
      ["undefined", () => new Measured({})]],
    ["TypeError", "options must be a plain object", ["3", () => new Measured(3)]],
  ];
  assertRejected(rows, () => assert.deepEqual(batch.snapshot(), before));
});

test("other arguments are rejected with the value and the rule, and nothing changes", () => {
  const acrobot = new Acrobot({ seed: 1 });
  const batch = new Batch({ seed: 1, count: 3 });
  const names = Object.keys(acrobot.params);
  const snapshots = () => [acrobot.snapshot(), batch.snapshot()];
  const before = snapshots();
  const step = (actions) => () => batch.step(actions);
  const set = (params) => () => acrobot.setParams(params);
  const draw = (draws) => () => acrobot.setDraws(draws);
  const make = (options) => () => new Acrobot(options);
  const many = (options) => () => new Batch(options);
  const picture = (options) => () => acrobot.draw({ arc() {} }, options);
  const rows = [
    ["TypeError", `action ${ACTION}`, ["1n", () => acrobot.step(1n)]],
    ["TypeError", "torque must be a finite number of N m", ['"1"', () => acrobot.stepTorque("1")]],
    ["TypeError", DRAW, ["null", draw({ mass1: null })]],
    ["RangeError", "mass1 must have 2 elements", ["3", draw({ mass1: [1, 2, 3] })]],
    ["TypeError", `draws must be among ${names.slice(0, -1).join(", ")}`,
      ["dynamics", draw({ dynamics: "nips" })]],
    ["RangeError", SEED,
      ["-1n", () => acrobot.reset(-1n)], ["9007199254740992", () => acrobot.reset(2 ** 53)],
      [`${1n << 2048n}n`, () => acrobot.sample(1n << 2048n)]],
    ["TypeError", SEED, ['"42"', make({ seed: "42" })]],
    ["TypeError", "mass1 must be a number", ["undefined", set({ mass1: undefined })]],
    ["RangeError", "gravity must be a finite number of m/s²",
      ["1e+39, which is Infinity in single precision", set({ gravity: 1e39 })]],
    ["TypeError", `params must be among ${names.join(", ")}`, ["mass", set({ mass: 1 })]],
    ["RangeError", "maxSteps must be an integer from 1 to 2^32 - 1",
      ["4294967296", make({ maxSteps: 2 ** 32 })]],
    ["TypeError", "options must be among seed, params, maxSteps, task, draws",
      ["count", make({ count: 1 })]],
    ["TypeError", 'task must be "gymnasium" or "swingup" or "balance"', ["1", make({ task: 1 })]],
    ["TypeError", "context must be a canvas's 2D context", ["undefined", () => acrobot.draw()]],
    ["RangeError", "options.size must be finite and at least 0 pixels", ["NaN", picture()]],
    ["RangeError", "actions must have 3 elements", ["2", step(new Uint8Array(2))]],
    ["TypeError", "actions must be an array of 3 elements",
      ["3", step(3)], ["[object Object]", step(new Proxy(new Uint8Array(3), {}))]],
    ["RangeError", `actions[1] ${ACTION}`,
      ["3", step(Uint8Array.of(0, 3, 1))], ["258", step([0, 258, 1])]],
    ["RangeError", "torques[1] must be a finite number of N m",
      ["NaN", () => batch.stepTorque(Float32Array.of(0, NaN, 1))],
      ["1e+39, which is Infinity in single precision", () => batch.stepTorque([0, 1e39, 1])]],
    ["RangeError", "mask[1] must be true, false, 1 or 0",
      ["2", () => batch.resetMasked([1, 2, 1])]],
    ["RangeError", "index must be an integer from 0 to 2",
      ["3", () => batch.setStateOf(3, {})], ["-1", () => batch.setParamsOf(-1, {})]],
    ["TypeError", "index must be an integer from 0 to 2",
      ["undefined", () => batch.draw({ arc() {} })]],
    ["RangeError", "ownParams must be true for parameters of each acrobot",
      ["false", () => batch.setParamsOf(0, { mass1: 2 })]],
    ["TypeError", "ownParams must be true or false", ["1", many({ count: 1, ownParams: 1 })]],
    ["TypeError", "count must be an integer from 1 to 2^32 - 1", ["undefined", many({})]],
    ["RangeError", "acrobots must fit into WebAssembly's memory of at most 4 GiB",
      ["4294967295 more", many({ count: 2 ** 32 - 1 })]],
  ];
  assertRejected(rows, () => assert.deepEqual(snapshots(), before));
  // A change of all acrobots that one of them rejects changes none.
  const own = new Batch({ count: 2, ownParams: true });
  own.setParamsOf(1, { centerOfMass1: 0 });
  assert.throws(() => own.setParams({ inertia1: 0 }), /^RangeError: inertia1 must be above 0 if/);
  assert.equal(own.paramsOf(0).inertia1, 1);
});
