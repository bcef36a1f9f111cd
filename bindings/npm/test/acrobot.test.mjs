// A single acrobot has native bits, and rejects invalid arguments without a change.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { inspect } from "node:util";

import { ACTIONS, bits as bitsOf, trace } from "../../../examples/web/test/native.mjs";
import { Acrobot, Batch } from "../dist/index.js";
import { ACTION, SEED, assertRejected, changed, randoms, sealed } from "./module.mjs";

const bits = ({ state }) => bitsOf(Object.values(state));

const PARAMS = [
  "length1", "length2", "mass1", "mass2", "centerOfMass1", "centerOfMass2", "inertia1", "inertia2",
  "gravity", "dt", "maxVelocity1", "maxVelocity2", "torques", "torqueNoise", "friction1",
  "friction2", "dynamics",
];

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
  assert.equal(acrobot.elapsedSteps, actions.length);
});

test("seeds of any size, numbers or BigInts, give native states", () => {
  const long = 123456789012345678901234567890n;
  for (const seed of [0, 0n, 7, 7n, 2 ** 32, 2 ** 53 - 1, long]) {
    const acrobot = new Acrobot({ seed });
    const native = trace(String(seed), []);
    assert.deepEqual([bits(acrobot)], native);
    acrobot.reset();
    acrobot.reset(seed);
    assert.deepEqual([bits(acrobot)], native);
  }
  const others = [new Acrobot({ seed: 2n ** 2048n - 1n }), new Acrobot(), new Acrobot()];
  assert.equal(new Set(others.map((other) => bits(other).join())).size, 3);
});

test("parameters act as natively", () => {
  const options = { seed: 7, params: { dt: 0.05, dynamics: "nips", torqueNoise: 0.25 } };
  const acrobot = new Acrobot(options);
  const states = [bits(acrobot)];
  for (const action of ACTIONS) states.push((acrobot.step(action), bits(acrobot)));
  assert.deepEqual(states, trace("7", ACTIONS, "--dt", "0.05", "--nips", "--noise", "0.25"));

  const numbers = Object.fromEntries(PARAMS.map((name, i) => [name, i + 0.5]));
  const friction = { friction1: 0, friction2: 0 };
  const params = { ...numbers, torques: [-3, 0.25, 4], dynamics: "nips", ...friction };
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
  const truncated = [1, 1, 1].map((action) => acrobot.step(action).truncated);
  assert.deepEqual(truncated, [false, false, true]);
  const observation = acrobot.reset();
  assert.deepEqual(observation, acrobot.observation);
  assert.equal(acrobot.elapsedSteps, 0);
  acrobot.state = { theta1: Math.PI / 2, theta2: 0, dtheta1: 0, dtheta2: 3 };
  assert.ok(Math.abs(acrobot.tipHeight) < 1e-6);
  // Both links are level, so the energy is link 2's: ½ (I2 + m2 lc2²) θ̇2².
  assert.ok(Math.abs(acrobot.energy - 0.5 * 1.25 * 9) < 1e-5);
  // Arrays are copies, and objects are frozen ones.
  observation.fill(9);
  assert.notDeepEqual(observation, acrobot.observation);
  const { state, params } = acrobot;
  for (const copy of [state, params, params.torques]) assert.ok(Object.isFrozen(copy));
});

test("a swing-up's steps are those that dm_control recorded", () => {
  const recorded = new URL("../../../tests/data/swingup.txt", import.meta.url);
  const acrobot = new Acrobot({ task: "swingup" });
  assert.deepEqual([acrobot.task, acrobot.maxSteps], ["swingup", 1000]);
  assert.equal(acrobot.params.friction2, Math.fround(0.05));
  const lines = readFileSync(recorded, "utf8").match(/^[^#].+$/gm);
  for (const line of lines) {
    const numbers = line.split(" ").map(Number);
    const [theta1, theta2, dtheta1, dtheta2, action] = numbers;
    acrobot.state = { theta1: theta1 + Math.PI, theta2, dtheta1, dtheta2 };
    const { observation, reward, terminated } = acrobot.stepTorque(2 * action);
    [...observation, reward].forEach((number, i) => {
      assert.ok(Math.abs(number - numbers[9 + i]) < 5e-6, `${i} of ${line}`);
    });
    assert.equal(terminated, false);
  }
  assert.equal(lines.length, 1000);
  const resumed = Acrobot.restore(acrobot.snapshot());
  assert.deepEqual(resumed.stepTorque(0.3), acrobot.stepTorque(0.3));
  const rule = /task "gymnasium", .*friction false, got .*task "swingup", .*friction true$/;
  assert.throws(() => new Acrobot().restore(acrobot.snapshot()), rule);
});

test("random actions with a seed are Gymnasium's", () => {
  const acrobot = new Acrobot();
  // space.seed(42) and space.sample() of Gymnasium 1.4.0: Discrete(3), MultiDiscrete([3] * 6).
  const samples = Array.from({ length: 12 }, (_, i) => acrobot.sample(i ? undefined : 42));
  assert.deepEqual(samples, [0, 2, 1, 1, 1, 2, 0, 2, 0, 0, 1, 2]);
  const batch = new Batch({ count: 6 });
  assert.deepEqual([...batch.sample(42n), ...batch.sample()], [2, 1, 2, 2, 0, 2, 2, 2, 0, 1, 1, 2]);
  const first = () => Array.from({ length: 40 }, () => new Acrobot({ seed: 1 }).sample());
  assert.notDeepEqual(first(), first());
});

/** A context that records the names of the methods called, and the square that is filled. */
function canvas() {
  const calls = [];
  const target = { calls, canvas: { width: 300, height: 200 }, arc() {} };
  const record = (name) => (...numbers) => calls.push([name, ...numbers]);
  return new Proxy(target, { get: (target, name) => target[name] ?? record(name) });
}

test("a picture fills the canvas or a square, and undefined options are the default", () => {
  const acrobot = new Acrobot();
  for (const [options, side] of [
    [undefined, 200],
    [{ size: undefined, colors: undefined }, 200],
    [{ size: 50 }, 50],
    [{ size: 0 }, 0],
  ]) {
    const context = canvas();
    acrobot.draw(context, options);
    const square = context.calls.find(([name]) => name === "fillRect");
    assert.deepEqual(square, ["fillRect", 0, 0, side, side]);
  }
});

test("invalid arguments of draw are rejected, and nothing is drawn", () => {
  const [batch, acrobot, context] = [new Batch({ count: 1 }), new Acrobot(), canvas()];
  const draw = (...given) => () => acrobot.draw(...given);
  const sized = (size) => draw(context, { size });
  const colored = (colors) => draw(context, { colors });
  const ofBatch = (...given) => () => batch.draw(context, ...given);
  const [own, batched] = ["draw(context, options): ", "draw(context, index, options): "];
  const SIZE = "options.size must be finite and at least 0 pixels";
  const NAMES = "background, target, link, joint, torque";
  assertRejected([
    ["TypeError", `${own}context must be a canvas's 2D context`,
      ["undefined", draw()],
      ["null", draw(null)],
      ['{"width":300,"height":200}', draw(context.canvas)]],
    ["TypeError", `${own}options must be a plain object`,
      ["null", draw(context, null)], ["[object Map]", draw(context, new Map())]],
    ["TypeError", `${own}options must be among size, colors`, ["sise", draw(context, { sise: 1 })]],
    ["RangeError", own + SIZE, ["-1", sized(-1)], ["NaN", sized(NaN)], ["NaN", draw({ arc() {} })]],
    ["TypeError", own + SIZE, ['"100"', sized("100")]],
    ["TypeError", `${own}options.colors must be a plain object`,
      ['"red"', colored("red")], ["[object Set]", colored(new Set())]],
    ["TypeError", `${own}options.colors must be among ${NAMES}`, ["lnik", colored({ lnik: "" })]],
    ["TypeError", `${own}options.colors.link must be a string`, ["5", colored({ link: 5 })]],
    ["TypeError", `${own}options.colors.torque must be a string`,
      ["undefined", colored({ torque: undefined })]],
    ["RangeError", batched + SIZE, ["-1", ofBatch(0, { size: -1 })]],
    ["TypeError", `${batched}index must be an integer from 0 to 0`, ["{}", ofBatch({})]],
  ]);
  assert.deepEqual(context.calls, []);
});

test("the console shows what an acrobot and a batch are", () => {
  const [acrobot, batch] = [new Acrobot({ maxSteps: 7 }), new Batch({ count: 3 })];
  acrobot.state = { theta1: 0.5, theta2: 0, dtheta1: 0, dtheta2: 0 };
  const { state, elapsedSteps, maxSteps, params } = acrobot;
  const shown = { state, elapsedSteps, maxSteps, params };
  assert.equal(inspect(acrobot), `Acrobot ${inspect(shown)}`);
  assert.equal(inspect(batch), `Batch ${inspect(batch.settings)}`);
  acrobot.free();
  assert.equal(inspect([acrobot]), "[ Acrobot freed ]");
});

const MAX_STEPS = "maxSteps must be an integer from 1 to 2^32 - 1";
const DT = "dt must be finite and above 0 s";
const DRAW =
  "mass1 must be drawn by [low, high], { logUniform: [low, high] }, " +
  '{ normal: [mean, std, low, high] }, "asBefore" or "fixed"';
const SINGLE = "in single precision";

test("invalid arguments are rejected with the value and the rule, and nothing changes", () => {
  const acrobot = busy();
  const before = acrobot.snapshot();
  const step = (action) => () => acrobot.step(action);
  const reset = (seed) => () => acrobot.reset(seed);
  const set = (params) => () => acrobot.setParams(params);
  const make = (options) => () => new Acrobot(options);
  const push = (torque) => () => acrobot.stepTorque(torque);
  const draw = (draws) => () => acrobot.setDraws(draws);
  const move = (state) => () => (acrobot.state = state);
  const marked = [-0, NaN, undefined, [-Infinity], "NaN"]; // what JSON has not
  const rows = [
    ["RangeError", `action ${ACTION}`, ["1.5", step(1.5)]],
    ["TypeError", `action ${ACTION}`,
      ["1n", step(1n)], ['"1"', step("1")], ["undefined", step()],
      [`["${"x".repeat(78)}…`, step(["x".repeat(99)])],
      ["[object Object]", step({ action: 1n })],
      ["[object Uint8Array]", step(Uint8Array.of(1))],
      ["Symbol(1)", step(Symbol("1"))],
      ["a function", step(() => 1)]],
    ["RangeError", "torque must be a finite number of N m",
      ["1e+39, which is Infinity in single precision", push(1e39)]],
    ["TypeError", "torque must be a finite number of N m", ['"1"', push("1")]],
    ["RangeError", 'friction1 must be 0 unless the task is "swingup", in N m s/rad',
      ["0.1", set({ friction1: 0.1 })], ["0.2", draw({ friction1: [0, 0.2] })]],
    ["TypeError", "mass1[1] must be a number", ['"2"', draw({ mass1: [1, "2"] })]],
    ["TypeError", DRAW,
      ["1", draw({ mass1: 1 })], ["{}", draw({ mass1: {} })], ["null", draw({ mass1: null })],
      ['{"logUniform":1,"normal":0}', draw({ mass1: { logUniform: 1, normal: 0 } })]],
    ["RangeError", "mass1 must have 2 elements",
      ["3", draw({ mass1: [1, 2, 3] })], ["0", draw({ mass1: "uniform" })]],
    ["TypeError", "mass1 must be an array of 4 elements", ["1", draw({ mass1: { normal: 1 } })]],
    ["TypeError", `draws must be among ${PARAMS.slice(0, -1).join(", ")}`,
      ["dynamics", draw({ dynamics: "nips" })]],
    ["TypeError", 'task must be "acrobot" or "swingup"',
      ['"swing-up"', make({ task: "swing-up" })]],
    ["RangeError", SEED,
      ["-1", () => acrobot.sample(-1)],
      ["-1", reset(-1)], ["-1n", reset(-1n)], ["9007199254740992", reset(2 ** 53)],
      [`${1n << 2048n}n`, reset(1n << 2048n)]],
    ["TypeError", SEED, ['"42"', reset("42")], ["null", reset(null)]],
    ["RangeError", DT,
      ["-0", set({ dt: -0 })], ["-1", make({ params: { dt: -1 } })]],
    ["TypeError", "mass1 must be a number",
      ["undefined", set({ mass1: undefined })], ['{"kg":NaN}', set({ mass1: { kg: NaN } })]],
    ["RangeError", "gravity must be a finite number of m/s²",
      [`1e+39, which is Infinity ${SINGLE}`, set({ gravity: 1e39 })]],
    ["RangeError", "length1 must be finite and above 0 m",
      [`1e-60, which is 0 ${SINGLE}`, set({ length1: 1e-60 })]],
    ["RangeError", "torques must have 3 elements", ["2", set({ torques: [1, 2] })]],
    ["TypeError", "torques must be an array of 3 elements", ["1", set({ torques: 1 })]],
    ["TypeError", "torques[2] must be a number",
      ['[-0,NaN,undefined,[-Infinity],"NaN"]', set({ torques: [1, 2, marked] })]],
    ["TypeError", 'dynamics must be "book" or "nips"',
      ['"Nips"', set({ dynamics: "Nips" })],
      [`"${"💥".repeat(79)}…`, set({ dynamics: "💥".repeat(99) })],
      [`"x${"💥".repeat(78)}…`, set({ dynamics: `x${"💥".repeat(99)}` })]],
    ["TypeError", `params must be among ${PARAMS.join(", ")}`, ["mass", set({ mass: 1 })]],
    ["TypeError", "params must be a plain object",
      ["undefined", set()], ["[object Map]", set(new Map([["mass1", 2]]))]],
    ["TypeError", "draws must be a plain object",
      ["[object Date]", draw(new Date())], ["{}", draw(new (class {})())],
      ["[object Acrobot]", draw(acrobot)]],
    ["TypeError", "state must be a plain object", ["[object Date]", move(new Date())]],
    ["TypeError", "theta2 must be a number", ["undefined", move({ theta1: 0 })]],
    ["RangeError", MAX_STEPS,
      ["0", make({ maxSteps: 0 })], ["-0", make({ maxSteps: -0 })],
      ["4294967296", make({ maxSteps: 2 ** 32 })]],
    ["TypeError", "options must be among seed, params, maxSteps, task, draws",
      ["sed", make({ sed: 1 })]],
    ["TypeError", "options must be a plain object",
      ["42", make(42)], ["[]", make([])], ["[object Date]", make(new Date())]],
  ];
  assertRejected(rows, (call) => assert.deepEqual(acrobot.snapshot(), before, String(call)));
});

test("a snapshot continues with the same bits, in another acrobot too", () => {
  const acrobot = busy();
  const others = [Acrobot.restore(acrobot.snapshot()), new Acrobot({ maxSteps: 7 })];
  others[1].restore(acrobot.snapshot());
  const same = (see) => {
    const seen = see(acrobot);
    for (const other of others) assert.deepEqual(see(other), seen);
  };
  same(({ params, elapsedSteps, maxSteps }) => [params, elapsedSteps, maxSteps]);
  for (const action of ACTIONS) same((each) => each.step(action));
  same((each) => each.reset());
});

test("a snapshot has the bytes of Rust's postcard, then its checksum", () => {
  // What version 4 stored for `Acrobot::<Fast>::new(3)`; a `TimeLimit` adds limit and steps.
  const stored = new URL("../../../tests/data/snapshots_4.txt", import.meta.url);
  const start = /^076163726f626f74040967796d6e617369756d046661737400.*$/m;
  const [rust] = start.exec(readFileSync(stored, "utf8"));
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
  before.forEach((_, length) => assert.ok(!restores(before.slice(0, length))));
  const others = [Uint8Array.of(...before, 0), new Uint8Array(1000), new Uint8Array()];
  for (const other of [...others, [...before], before.buffer, "x", null, undefined]) {
    assert.ok(!restores(other));
  }
  assert.ok(restores(before));

  assert.ok(restores(changed(before, 8, 4)));
  const fields = 'task "gymnasium", arithmetic "fast", friction false';
  const [version3, own] = [3, 4].map((each) => `"acrobot", version ${each}, ${fields}`);
  const rule = `the snapshot must be a valid one of ${own}`;
  for (const [bytes, message] of [
    [changed(before, 8, 3), `${rule}, got ${version3}`],
    [changed(before, 20, ...Buffer.from("host")), /got "acrobot", .*, arithmetic "host", friction/],
    // A length1 of NaN.
    [changed(before, 25, 0, 0, 0xc0, 0x7f), `${rule}, got one with invalid contents`],
    [new Batch({ count: 5 }).snapshot(), /got "batch", version 4, task "gymnasium", .* false$/],
    [sealed(Buffer.from("text")), `${rule}, got 8 other bytes`],
    [Buffer.concat([changed(before, 0, 7).subarray(0, -4), Buffer.of(0)]), /checksum/],
  ]) {
    assert.throws(() => Acrobot.restore(bytes), { name: "RangeError", message });
    assert.ok(!restores(bytes));
  }
  // Any bytes with the right checksum.
  const random = randoms();
  for (let i = 0; i < 2000; i++) {
    if (restores(changed(before, random(before.length - 4), random(256)))) acrobot.step(2);
    acrobot.restore(before);
  }
});

test("after free, every use throws, and other acrobots continue", () => {
  const [acrobot, other] = [new Acrobot({ seed: 1 }), new Acrobot({ seed: 2 })];
  const before = other.snapshot();
  acrobot.free();
  acrobot.free();
  const methods = ["reset", "step", "stepTorque", "sample", "snapshot", "draw"];
  const reads = ["observation", "state", "params", "energy", "tipHeight", "elapsedSteps"];
  for (const use of [
    ...methods.map((name) => () => acrobot[name](1)),
    ...reads.map((name) => () => acrobot[name]),
    () => acrobot.setParams({}),
    () => acrobot.setDraws({}),
    () => (acrobot.state = other.state),
    () => acrobot.restore(before),
  ]) {
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
  const made = Reflect.construct(base, ["acrobot", 4096], Acrobot);
  const proxy = new Proxy(new Acrobot(), {});
  for (const wrong of [{}, new Batch({ count: 1 }), proxy, new base(), made]) {
    assert.throws(() => Acrobot.prototype.step.call(wrong, 1), TypeError);
  }
});
