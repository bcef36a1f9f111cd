// Calls that Rust rejects: tests/data/rejections.jsonl, which Rust's own tests write.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { Acrobot, Batch } from "../dist/index.js";

const path = new URL("../../../tests/data/rejections.jsonl", import.meta.url);
const camel = (name) =>
  name.replace(".joint", "").replace(/_(\w)/g, (_, letter) => letter.toUpperCase());
/** JSON has no numbers that are not finite. */
const number = (value) => (value === "inf" ? Infinity : value === "-inf" ? -Infinity : +value);

/** The parameters or the state of a row. */
function changes(set) {
  const given = {};
  for (const [name, value] of Object.entries(set)) {
    const [, index] = /^torques\[(.)\]/.exec(name) ?? [];
    if (index) given.torques = [-1, 0, 1].with(index, number(value));
    else given[camel(name)] = number(value);
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
      const error = { name: "RangeError", message: camel(name) + rest };
      assert.throws(() => call(acrobot, batch), error);
      assert.deepEqual(snapshots(), before, row.message);
    }
  }
  assert.ok(rows.length > 100);
});
