// A single acrobot has native bits, and rejects invalid arguments without a change.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { inspect } from "node:util";

import { ACTIONS, bits as bitsOf, trace } from "../../../examples/web/test/native.mjs";
import { Acrobot, Batch } from "../dist/index.js";
import { Learner } from "../dist/policies.js";
import { sealed } from "./module.mjs";

const bits = ({ state }) => bitsOf(Object.values(state));

/** An episode that is not in its initial state. */
function busy() {
  const acrobot = new Acrobot({ seed: 42, params: { torqueNoise: 0.1 } });
  for (const action of ACTIONS) acrobot.step(action);
  return acrobot;
}

test("an episode is bit-identical to a native one", () => {
  const acrobot = new Acrobot({ seed: 42 });
  const [states, actions] = [[bits(acrobot)], []];
  let step;
  do {
    actions.push(acrobot.observation[4] > 0 ? 0 : 2);
    step = acrobot.step(actions.at(-1));
    states.push(bits(acrobot));
    assert.deepEqual(step.observation, acrobot.observation);
    assert.equal(step.reward, step.terminated ? 0 : -1);
    assert.equal(step.truncated, false);
  } while (!step.terminated);
  assert.deepEqual(states, trace("42", actions));
  assert.equal(acrobot.elapsed, actions.length);
});

test("seeds of any size, numbers or BigInts, give native states", () => {
  const long = 123456789012345678901234567890n;
  for (const seed of [0, 0n, 7, 7n, 2 ** 32, 2 ** 53 - 1, long]) {
    const acrobot = new Acrobot({ seed });
    assert.deepEqual([bits(acrobot)], trace(String(seed), []));
    acrobot.reset();
    acrobot.reset(seed);
    assert.deepEqual([bits(acrobot)], trace(String(seed), []));
  }
  const [largest, random, other] = [new Acrobot({ seed: 2n ** 2048n - 1n }), new Acrobot(), new Acrobot()];
  assert.notDeepEqual(bits(random), bits(other));
  assert.notDeepEqual(bits(largest), bits(random));
});

test("parameters act as natively", () => {
  const acrobot = new Acrobot({ seed: 7, params: { dt: 0.05, dynamics: "nips", torqueNoise: 0.25 } });
  const states = [bits(acrobot), ...ACTIONS.map((action) => (acrobot.step(action), bits(acrobot)))];
  assert.deepEqual(states, trace("7", ACTIONS, "--dt", "0.05", "--nips", "--noise", "0.25"));

  const names = ["length1", "length2", "mass1", "mass2", "centerOfMass1", "centerOfMass2", "inertia1", "inertia2", "gravity", "dt", "maxVelocity1", "maxVelocity2", "torqueNoise"];
  const numbers = Object.fromEntries(names.map((name, i) => [name, i + 0.5]));
  const params = { ...numbers, torques: [-3, 0.25, 4], dynamics: "nips" };
  acrobot.setParams(params);
  assert.deepEqual(acrobot.params, params);
  for (const gravity of [0, -0]) {
    acrobot.setParams({ gravity });
    assert.deepEqual(acrobot.params, { ...params, gravity });
    assert.deepEqual(Acrobot.restore(acrobot.snapshot()).params, { ...params, gravity });
  }
});

test("reset, limit, state, energy and height are the crate's", () => {
  const acrobot = new Acrobot({ seed: 42, maxSteps: 3 });
  assert.equal(acrobot.maxSteps, 3);
  assert.deepEqual([1, 1, 1].map((action) => acrobot.step(action).truncated), [false, false, true]);
  const observation = acrobot.reset();
  assert.deepEqual(observation, acrobot.observation);
  assert.equal(acrobot.elapsed, 0);
  acrobot.state = { theta1: Math.PI / 2, theta2: 0, dtheta1: 0, dtheta2: 3 };
  assert.ok(Math.abs(acrobot.tipHeight) < 1e-6);
  // Both links are level, so the energy is link 2's: ½ (I2 + m2 lc2²) θ̇2².
  assert.ok(Math.abs(acrobot.energy - 0.5 * 1.25 * 9) < 1e-5);
  // Arrays are copies.
  observation.fill(9);
  assert.notDeepEqual(observation, acrobot.observation);
});

/** A context that records calls. */
function canvas() {
  const calls = [];
  const names = ["save", "restore", "translate", "scale", "clearRect", "fillRect", "beginPath", "lineTo", "arc", "stroke", "fill"];
  const methods = names.map((name) => [name, (...args) => calls.push([name, ...args])]);
  return { calls, canvas: { width: 300, height: 200 }, ...Object.fromEntries(methods) };
}

test("a picture fills the canvas or a square of the given size, and undefined options are the default", () => {
  const acrobot = new Acrobot();
  const square = (options) => {
    const context = canvas();
    acrobot.draw(context, options);
    return context.calls.find(([name]) => name === "fillRect");
  };
  assert.deepEqual(square(), ["fillRect", 0, 0, 200, 200]);
  assert.deepEqual(square({ size: undefined, colors: undefined }), ["fillRect", 0, 0, 200, 200]);
  assert.deepEqual(square({ size: 50 }), ["fillRect", 0, 0, 50, 50]);
  assert.deepEqual(square({ size: 0 }), ["fillRect", 0, 0, 0, 0]);
});

const CONTEXT = "context must be a canvas's 2D context, got ";
const SIZE = "options.size must be finite and at least 0 pixels, got ";
const COLORS = "options.colors must be";

test("invalid arguments of draw are rejected with the value and the rule, and nothing is drawn", () => {
  const [batch, acrobot, context] = [new Batch({ count: 1 }), new Acrobot(), canvas()];
  for (const [args, name, message] of [
    [[], "TypeError", `${CONTEXT}undefined`],
    [[null], "TypeError", `${CONTEXT}null`],
    [[context.canvas], "TypeError", `${CONTEXT}{"width":300,"height":200}`],
    [[context, null], "TypeError", "options must be an object, got null"],
    [[context, { sise: 1 }], "TypeError", "options must be among size, colors, got sise"],
    [[context, { size: -1 }], "RangeError", `${SIZE}-1`],
    [[context, { size: NaN }], "RangeError", `${SIZE}NaN`],
    [[context, { size: "100" }], "TypeError", `${SIZE}"100"`],
    [[{ ...context, canvas: undefined }], "RangeError", `${SIZE}NaN`],
    [[context, { colors: "red" }], "TypeError", `${COLORS} an object, got "red"`],
    [[context, { colors: { lnik: "red" } }], "TypeError", `${COLORS} among background, target, link, joint, torque, got lnik`],
    [[context, { colors: { link: 5 } }], "TypeError", "options.colors.link must be a string, got 5"],
    [[context, { colors: { torque: undefined } }], "TypeError", "options.colors.torque must be a string, got undefined"],
  ]) {
    assert.throws(() => acrobot.draw(...args), { name, message: `draw(context, options): ${message}` });
    assert.throws(() => batch.draw(args[0], 0, ...args.slice(1)), { name, message: `draw(context, index, options): ${message}` });
  }
  const message = "draw(context, index, options): index must be an integer from 0 to 0, got {}";
  assert.throws(() => batch.draw(context, {}), { name: "TypeError", message });
  assert.deepEqual(context.calls, []);
});

test("states and parameters are frozen copies, and a random action is any", () => {
  const acrobot = new Acrobot();
  for (const copy of [acrobot.state, acrobot.params, acrobot.params.torques]) assert.ok(Object.isFrozen(copy));
  const actions = Array.from({ length: 100 }, () => acrobot.sample());
  assert.deepEqual([...new Set(actions)].sort(), [0, 1, 2]);
});

test("the console shows what an acrobot and a batch are", () => {
  const [acrobot, batch] = [new Acrobot({ maxSteps: 7 }), new Batch({ count: 3 })];
  acrobot.state = { theta1: 0.5, theta2: 0, dtheta1: 0, dtheta2: 0 };
  assert.match(inspect(acrobot), /^Acrobot \{\n  state: \{ theta1: 0\.5, theta2: 0, .*elapsed: 0,\n  maxSteps: 7,\n  params: \{\n    length1: 1,/s);
  assert.match(inspect(batch), /^Batch \{\s+count: 3,\s+maxSteps: 500,\s+autoreset: 'NextStep',\s+ownParams: false\s+\}$/);
  acrobot.free();
  assert.equal(inspect([acrobot]), "[ Acrobot freed ]");
});

const SEED = "seed must be an integer from 0 to 2^53 - 1, or a BigInt from 0 to 2^2048 - 1, got ";
const ACTION = "action must be 0 (negative torque), 1 (none) or 2 (positive), got ";
const MAX_STEPS = "maxSteps must be an integer from 1 to 2^32 - 1, got ";

test("invalid arguments are rejected with the value and the rule, and nothing changes", () => {
  const acrobot = busy();
  const before = acrobot.snapshot();
  for (const [call, name, message] of [
    [() => acrobot.step(3), "RangeError", `${ACTION}3`],
    [() => acrobot.step(1.5), "RangeError", `${ACTION}1.5`],
    [() => acrobot.step(NaN), "RangeError", `${ACTION}NaN`],
    [() => acrobot.step(1n), "TypeError", `${ACTION}1n`],
    [() => acrobot.step("1"), "TypeError", `${ACTION}"1"`],
    [() => acrobot.step(), "TypeError", `${ACTION}undefined`],
    [() => acrobot.step([1]), "TypeError", `${ACTION}[1]`],
    [() => acrobot.step(["x".repeat(99)]), "TypeError", `${ACTION}["${"x".repeat(78)}…`],
    [() => acrobot.step({ action: 1n }), "TypeError", `${ACTION}[object Object]`],
    [() => acrobot.step(Uint8Array.of(1)), "TypeError", `${ACTION}[object Uint8Array]`],
    [() => acrobot.step(Symbol("1")), "TypeError", `${ACTION}Symbol(1)`],
    [() => acrobot.step(() => 1), "TypeError", `${ACTION}a function`],
    [() => acrobot.reset(-1), "RangeError", `${SEED}-1`],
    [() => acrobot.reset(-1n), "RangeError", `${SEED}-1n`],
    [() => acrobot.reset(2 ** 53), "RangeError", `${SEED}9007199254740992`],
    [() => acrobot.reset(1n << 2048n), "RangeError", `${SEED}${1n << 2048n}n`],
    [() => acrobot.reset("42"), "TypeError", `${SEED}"42"`],
    [() => acrobot.reset(null), "TypeError", `${SEED}null`],
    [() => acrobot.setParams({ dt: 0 }), "RangeError", "dt must be finite and above 0 s, got 0"],
    [() => acrobot.setParams({ mass1: NaN }), "RangeError", "mass1 must be finite and above 0 kg, got NaN"],
    [() => acrobot.setParams({ mass1: "1" }), "TypeError", 'mass1 must be a number, got "1"'],
    [() => acrobot.setParams({ mass1: undefined }), "TypeError", "mass1 must be a number, got undefined"],
    [() => acrobot.setParams({ centerOfMass2: -1 }), "RangeError", "centerOfMass2 must be finite and at least 0 m, got -1"],
    [() => acrobot.setParams({ gravity: 1e39 }), "RangeError", "gravity must be a finite number of m/s², got 1e+39, which is Infinity in single precision"],
    [() => acrobot.setParams({ length1: 1e-60 }), "RangeError", "length1 must be finite and above 0 m, got 1e-60, which is 0 in single precision"],
    [() => acrobot.setParams({ torques: [0, NaN, 1] }), "RangeError", "torques[1] must be a finite number of N m, got NaN"],
    [() => acrobot.setParams({ torques: [0, 1] }), "TypeError", "torques must be an array of 3 numbers, got [0,1]"],
    [() => acrobot.setParams({ torques: [-0, NaN, undefined, [-Infinity], "NaN"] }), "TypeError", 'torques must be an array of 3 numbers, got [-0,NaN,undefined,[-Infinity],"NaN"]'],
    [() => acrobot.setParams({ dt: -0 }), "RangeError", "dt must be finite and above 0 s, got -0"],
    [() => acrobot.setParams({ mass1: { kg: NaN } }), "TypeError", 'mass1 must be a number, got {"kg":NaN}'],
    [() => new Acrobot({ maxSteps: -0 }), "RangeError", `${MAX_STEPS}-0`],
    [() => acrobot.setParams({ torques: 1 }), "TypeError", "torques must be an array of 3 numbers, got 1"],
    [() => acrobot.setParams({ dynamics: "Nips" }), "TypeError", 'dynamics must be "book" or "nips", got "Nips"'],
    [() => acrobot.setParams({ mass: 1 }), "TypeError", /^params must be among length1, .*dynamics, got mass$/],
    [() => acrobot.setParams(), "TypeError", "params must be an object, got undefined"],
    [() => acrobot.setParams({ inertia1: 0, centerOfMass1: 0 }), "RangeError", "inertia1 must be above 0 kg m² if the centre of mass is on the joint, got 0"],
    [() => (acrobot.state = { theta1: 0, theta2: NaN, dtheta1: 0, dtheta2: 0 }), "RangeError", "theta2 must be a finite number of rad, got NaN"],
    [() => (acrobot.state = { theta1: 0 }), "TypeError", "theta2 must be a number, got undefined"],
    [() => new Acrobot({ sed: 1 }), "TypeError", "options must be among seed, params, maxSteps, got sed"],
    [() => new Acrobot({ maxSteps: 0 }), "RangeError", `${MAX_STEPS}0`],
    [() => new Acrobot({ maxSteps: 2 ** 32 }), "RangeError", `${MAX_STEPS}4294967296`],
    [() => new Acrobot({ params: { dt: -1 } }), "RangeError", "dt must be finite and above 0 s, got -1"],
    [() => new Acrobot(42), "TypeError", "options must be an object, got 42"],
    [() => new Acrobot([]), "TypeError", "options must be an object, got []"],
  ]) {
    assert.throws(call, { name, message });
    assert.deepEqual(acrobot.snapshot(), before, String(call));
  }
});

test("a snapshot continues with the same bits, in another acrobot too", () => {
  const acrobot = busy();
  const resumed = Acrobot.restore(acrobot.snapshot());
  const other = new Acrobot({ maxSteps: 7 });
  other.restore(acrobot.snapshot());
  for (const each of [resumed, other]) {
    assert.deepEqual([each.params, each.elapsed, each.maxSteps], [acrobot.params, acrobot.elapsed, acrobot.maxSteps]);
  }
  for (const action of ACTIONS) {
    const step = acrobot.step(action);
    assert.deepEqual(resumed.step(action), step);
    assert.deepEqual(other.step(action), step);
  }
  const observation = acrobot.reset();
  assert.deepEqual(resumed.reset(), observation);
});

test("a snapshot has the bytes of Rust's postcard, then its checksum", () => {
  // What version 1 stored for `Acrobot::<Fast>::new(3)`; a `TimeLimit` adds its limit and the elapsed steps.
  const stored = readFileSync(new URL("../../../tests/data/snapshots_1.txt", import.meta.url), "utf8");
  const [rust] = /^076163726f626f740104666173740.*$/m.exec(stored);
  const snapshot = Buffer.from(new Acrobot({ seed: 3 }).snapshot());
  assert.deepEqual(snapshot, sealed(Buffer.from(`${rust}f40300`, "hex")));
});

test("damaged snapshots, and those of others, are rejected, and nothing changes", () => {
  const acrobot = busy();
  const before = acrobot.snapshot();
  const restores = (bytes) => {
    try {
      acrobot.restore(bytes);
      return true;
    } catch (error) {
      assert.match(error.message, /^the snapshot must /);
      assert.deepEqual(acrobot.snapshot(), before);
      return false;
    }
  };
  for (let bit = 0; bit < 8 * before.length; bit++) {
    const damaged = before.slice();
    damaged[bit >> 3] ^= 1 << (bit & 7);
    assert.ok(!restores(damaged), `bit ${bit}`);
  }
  for (let length = 0; length < before.length; length++) assert.ok(!restores(before.slice(0, length)));
  for (const other of [Uint8Array.of(...before, 0), new Uint8Array(1000), new Uint8Array(), [...before], before.buffer, "x", null, undefined]) {
    assert.ok(!restores(other));
  }
  assert.ok(restores(before));

  /** The snapshot with other bytes from `start` on, and with the right checksum. */
  const changed = (start, ...bytes) => {
    const body = Buffer.from(before.subarray(0, -4));
    body.set(bytes, start);
    return sealed(body);
  };
  assert.ok(restores(changed(8, 1)));
  for (const [bytes, message] of [
    [changed(8, 2), 'the snapshot must be a valid one of "acrobot", version 1, arithmetic "fast", got "acrobot", version 2, arithmetic "fast"'],
    [changed(10, ...Buffer.from("host")), /got "acrobot", version 1, arithmetic "host"$/],
    // A length1 of NaN.
    [changed(14, 0, 0, 0xc0, 0x7f), /got "acrobot", version 1, arithmetic "fast"$/],
    [Buffer.concat([changed(0, 7).subarray(0, -4), Buffer.of(0)]), /checksum/],
  ]) {
    assert.throws(() => Acrobot.restore(bytes), { name: "RangeError", message });
    assert.ok(!restores(bytes));
  }
  // Any bytes with the right checksum.
  let state = 1;
  const random = () => ((state = (Math.imul(state, 1664525) + 1013904223) >>> 0), state >>> 24);
  for (let i = 0; i < 2000; i++) {
    const bytes = changed(random() % (before.length - 4), random());
    if (restores(bytes)) acrobot.step(2);
    acrobot.restore(before);
  }
});

test("after free, every use throws, and other acrobots continue", () => {
  const [acrobot, other] = [new Acrobot({ seed: 1 }), new Acrobot({ seed: 2 })];
  const before = other.snapshot();
  acrobot.free();
  acrobot.free();
  const uses = ["reset", "step", "snapshot", "setParams", "draw"].map((name) => () => acrobot[name](name === "setParams" ? {} : 1));
  const reads = ["observation", "state", "params", "energy", "tipHeight", "elapsed", "maxSteps"].map((name) => () => acrobot[name]);
  const write = () => (acrobot.state = other.state);
  for (const use of [...uses, ...reads, write, () => acrobot.restore(before)]) {
    assert.throws(use, { name: "Error", message: "the acrobot has been freed" });
  }
  // Its memory is used again.
  const third = new Acrobot({ seed: 3 });
  assert.throws(() => acrobot.step(1), /freed/);
  assert.deepEqual(third.snapshot(), new Acrobot({ seed: 3 }).snapshot());
  assert.deepEqual(other.snapshot(), before);
  third[Symbol.dispose]();
  assert.throws(() => third.step(1), /freed/);
});

test("a method rejects what is no acrobot, whose address it would not have", () => {
  const base = Object.getPrototypeOf(Acrobot);
  for (const wrong of [{}, new Batch({ count: 1 }), new Proxy(new Acrobot(), {}), new base(), Reflect.construct(base, ["acrobot", 4096], Acrobot)]) {
    assert.throws(() => Acrobot.prototype.step.call(wrong, 1), TypeError);
  }
  // Vue's proxies leave objects with this property alone.
  const kinds = [new Acrobot(), new Batch({ count: 1 }), new Learner()];
  assert.ok(kinds.every((each) => each.__v_skip));
});
