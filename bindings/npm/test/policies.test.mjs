// The policies reach the goal, and the learner learns the weights of the native program `swing_up`.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";

import { swingUp } from "../../../examples/web/test/native.mjs";
import { Acrobot, Batch } from "../dist/index.js";
import { Learner, Perceptron, bangBang, energyLaw, uprightEnergy } from "../dist/policies.js";
import { assertRejected } from "./module.mjs";

const folder = mkdtempSync(join(tmpdir(), "acrobot-npm-"));
after(() => rmSync(folder, { recursive: true }));

/** The steps to the goal. */
function play(policy, options) {
  const acrobot = new Acrobot(options);
  for (;;) {
    const { terminated, truncated } = acrobot.step(policy(acrobot));
    if (terminated || truncated) return terminated ? acrobot.elapsedSteps : Infinity;
  }
}

test("policies reach the goal", () => {
  assert.equal(play(bangBang, { seed: 42 }), 94);
  assert.ok(play(energyLaw, { seed: 42 }) < 200);
  const acrobot = new Acrobot({ params: { mass1: 2, length1: 1.5, gravity: 5 } });
  acrobot.state = { theta1: Math.PI, theta2: 0, dtheta1: 0, dtheta2: 0 };
  assert.ok(Math.abs(uprightEnergy(acrobot.params) - acrobot.energy) < 1e-4);
});

test("learnt weights are native ones, reach the goal, and each program loads the other's", () => {
  for (const seed of [42, 123456789012345678901n]) {
    const learner = new Learner({ episodes: 100, seed });
    const returns = Array.from({ length: 100 }, () => learner.train());
    assert.ok(returns.every((sum) => Number.isInteger(sum) && sum >= -500 && sum < 0));
    const path = join(folder, `${seed}.bin`);
    assert.equal(swingUp("--episodes", "100", "--seed", String(seed), "--save", path), null);
    const weights = readFileSync(path);
    assert.ok(weights.equals(learner.save()), `seed ${seed}: the weights differ from native ones`);

    const loaded = new Learner();
    loaded.load(weights);
    assert.ok(play((acrobot) => loaded.act(acrobot), { seed: 7 }) < 200);
    const own = join(folder, "own.bin");
    writeFileSync(own, learner.save());
    assert.equal(swingUp("--episodes", "0", "--load", own), null);
  }
});

test("invalid weights and other arguments are rejected, weights with the native message", () => {
  const learner = new Learner({ episodes: 5, seed: 1 });
  learner.train();
  const good = learner.save();
  const damaged = good.slice();
  damaged.fill(1, 500, 504);
  for (const [i, bytes] of [good.subarray(0, 1000), damaged].entries()) {
    const path = join(folder, `${i}.bin`);
    writeFileSync(path, bytes);
    const native = swingUp("--episodes", "0", "--load", path);
    const isNative = ({ name, message }) => name === "RangeError" && native.includes(message);
    assert.throws(() => learner.load(bytes), isNative);
  }
  const act = (state) => () => learner.act({ state });
  const wrong = [undefined, {}, new Batch({ count: 1 })];
  const withWrong = (call) => wrong.map((each) => ["undefined", () => call(each)]);
  const rows = [
    ["RangeError", "weights must have at most 524288 bytes",
      ["1000000", () => learner.load(new Uint8Array(1e6))]],
    ["TypeError", "weights must be a Uint8Array",
      ["[object Array]", () => learner.load([84, 73])]],
    ["RangeError", "acrobot.state.theta1 must be a finite number",
      ["NaN", act({ theta1: NaN })],
      ["1e+300, which is Infinity in single precision", act({ theta1: 1e300 })]],
    ["TypeError", "acrobot.state.theta1 must be a finite number",
      ...withWrong((each) => learner.act(each))],
    ["TypeError", "acrobot.state.dtheta1 must be a finite number", ...withWrong(bangBang)],
    ["TypeError", "acrobot.energy must be a finite number", ...withWrong(energyLaw)],
    ["TypeError", "params.gravity must be a finite number", ...withWrong(uprightEnergy)],
    ["RangeError", "episodes must be an integer from 1 to 2^32 - 1",
      ["0", () => new Learner({ episodes: 0 })]],
    ["TypeError", "options must be among episodes, seed", ["sed", () => new Learner({ sed: 1 })]],
  ];
  assertRejected(rows, () => assert.deepEqual(learner.save(), good));
  assert.throws(() => new Learner({ seed: -1 }), /^RangeError: seed must be .*, got -1$/);
});

test("a perceptron from Python plays as natively, and other files are rejected", () => {
  const file = readFileSync(new URL("../../../crates/policy/policy.bin", import.meta.url));
  const perceptron = new Perceptron(file);
  // As in crates/policy/tests/policy.rs.
  const steps = [1, 2, 3, 4, 5].map((seed) => play((acrobot) => perceptron.act(acrobot), { seed }));
  assert.deepEqual(steps, [101, 88, 96, 72, 72]);
  for (const [bytes, message] of [
    [file.subarray(1), /must begin with MLP1/],
    [Buffer.from(file).fill(1, 500, 504), /must have its checksum/],
    [new Uint8Array(1e6), /must have at most 524288 bytes, got 1000000/],
    ["MLP1", /must be a Uint8Array, got "MLP1"/],
  ]) {
    assert.throws(() => new Perceptron(bytes), message);
  }
  assert.throws(() => perceptron.act({}), /acrobot\.observation\.0 must be a finite number/);
});

test("a perceptron whose sums overflow plays no torque, as natively", () => {
  const url = new URL("../../../crates/policy/overflow.txt", import.meta.url);
  for (const line of readFileSync(url, "utf8").trimEnd().split("\n")) {
    const [name, ...words] = line.split(" ");
    const [observation, [action, , file]] = [words.slice(0, 6).map(Number), words.slice(6)];
    const perceptron = new Perceptron(Buffer.from(file, "hex"));
    assert.equal(perceptron.act({ observation }), Number(action), `${name} ${observation}`);
  }
});
