// The policies reach the goal, and the learner learns the weights of the native program `swing_up`.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
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

test("learnt weights are native ones, and reach the goal once loaded", () => {
  const seed = 123456789012345678901n;
  const learner = new Learner({ episodes: 100, seed });
  const returns = Array.from({ length: 100 }, () => learner.train());
  assert.ok(returns.every((sum) => Number.isInteger(sum) && sum >= -500 && sum < 0));
  const path = join(folder, "native.bin");
  assert.equal(swingUp("--episodes", "100", "--seed", String(seed), "--save", path), null);
  const weights = readFileSync(path);
  assert.ok(weights.equals(learner.save()), "the weights differ from native ones");

  const loaded = new Learner();
  loaded.load(weights);
  assert.ok(play((acrobot) => loaded.act(acrobot), { seed: 7 }) < 200);
});

test("a learner learns with the parameters of an acrobot", () => {
  const learnt = (params) => {
    const acrobot = params && new Acrobot({ params });
    const learner = new Learner({ episodes: 9, seed: 3, acrobot });
    const returns = Array.from({ length: 9 }, () => learner.train());
    return { returns: returns.join(), weights: learner.save() };
  };
  assert.deepEqual(learnt({}), learnt());
  assert.equal(learnt({ torques: [0, 0, 0] }).returns, Array(9).fill(-500).join());
  assert.notDeepEqual(learnt({ dynamics: "nips" }), learnt());
});

test("invalid weights and other arguments are rejected", () => {
  const learner = new Learner({ episodes: 5, seed: 1 });
  const good = learner.save();
  const act = (state) => () => learner.act({ state });
  const rows = [
    ["RangeError", "weights must have 49172 bytes",
      ["1000", () => learner.load(good.slice(0, 1000))]],
    ["RangeError", "weights must have at most 524288 bytes",
      ["1000000", () => learner.load(new Uint8Array(1e6))]],
    ["TypeError", "weights must be a Uint8Array",
      ["[object Array]", () => learner.load([84, 73])]],
    ["RangeError", "acrobot.state.theta1 must be a finite number",
      ["NaN", act({ theta1: NaN })],
      ["1e+300, which is Infinity in single precision", act({ theta1: 1e300 })]],
    ["TypeError", "acrobot.state.dtheta1 must be a finite number",
      ["undefined", () => bangBang()], ["undefined", () => bangBang(new Batch({ count: 1 }))]],
    ["TypeError", "acrobot.energy must be a finite number", ["undefined", () => energyLaw({})]],
    ["TypeError", "params.gravity must be a finite number", ["undefined", () => uprightEnergy({})]],
    ["TypeError", "options.acrobot must be an Acrobot without friction and rotor",
      ["[object Object]", () => new Learner({ acrobot: { params: new Acrobot().params } })],
      ["[object Acrobot]", () => new Learner({ acrobot: new Acrobot({ task: "swingup" }) })]],
    ["RangeError", "episodes must be an integer from 1 to 2^32 - 1",
      ["0", () => new Learner({ episodes: 0 })]],
    ["TypeError", "options must be among episodes, seed, acrobot",
      ["sed", () => new Learner({ sed: 1 })]],
  ];
  assertRejected(rows, () => assert.deepEqual(learner.save(), good));
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
