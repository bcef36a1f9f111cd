// A single acrobot has native bits, and rejects invalid arguments without a change.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { ACTIONS, bits as bitsOf, trace } from "../../../examples/web/test/native.mjs";
import { Acrobot, Batch } from "../dist/index.js";
import { ACTION, SEED, assertRejected, changed, randoms, sealed } from "./module.mjs";

const bits = ({ state }) => bitsOf(Object.values(state));

const PARAMS = Object.keys(new Acrobot().params);

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
  const rule = /^RangeError: the snapshot must be .* task, got .* another class, version or task$/;
  assert.throws(() => new Acrobot().restore(acrobot.snapshot()), rule);
});

test("random actions with a seed are Gymnasium's", () => {
  const acrobot = new Acrobot();
  // space.seed(42) and space.sample() of Gymnasium 1.4.0: Discrete(3), MultiDiscrete([3] * 6).
  const samples = Array.from({ length: 12 }, (_, i) => acrobot.sample(i ? undefined : 42));
  assert.deepEqual(samples, [0, 2, 1, 1, 1, 2, 0, 2, 0, 0, 1, 2]);
  const batch = new Batch({ count: 6 });
  assert.deepEqual([...batch.sample(42n), ...batch.sample()], [2, 1, 2, 2, 0, 2, 2, 2, 0, 1, 1, 2]);
  // Without a seed they are random, also after a snapshot.
  const alone = () => Array.from({ length: 40 }, () => new Acrobot({ seed: 1 }).sample());
  assert.notDeepEqual(alone(), alone());
  const snapshot = new Batch({ count: 40 }).snapshot();
  assert.notDeepEqual(Batch.restore(snapshot).sample(), Batch.restore(snapshot).sample());
});

/** A context that records calls, with the colour of each. */
function canvas() {
  const target = { calls: [], canvas: { width: 300, height: 200 } };
  const record = (name) => (...given) => {
    const style = name.startsWith("fill") ? "fillStyle" : "strokeStyle";
    target.calls.push([name, target[style], ...given].join(" "));
  };
  return new Proxy(target, { get: (target, name) => target[name] ?? record(name) });
}

test("a picture has an arrow with the torque of the last step, and options", () => {
  const [acrobot, batch] = [new Acrobot(), new Batch({ count: 2 })];
  const drawn = (draw) => {
    const context = canvas();
    draw(context);
    return context.calls;
  };
  /** The arrow's width, which is negative for a torque to the right. */
  const arrow = () => {
    const scales = drawn((context) => acrobot.draw(context)).filter((call) => /^scale/.test(call));
    return scales.slice(1).map((call) => Number(call.split(" ")[2]));
  };
  for (const [action, widths] of [[2, [0.3]], [1, []], [0, [-0.3]]]) {
    acrobot.step(action);
    assert.deepEqual(arrow(), widths);
  }
  acrobot.stepTorque(0.5);
  assert.deepEqual(arrow(), [0.3]);
  acrobot.reset();
  assert.deepEqual(arrow(), []);
  assert.ok(drawn((context) => acrobot.draw(context)).includes("fillRect white 0 0 200 200"));
  const options = { size: 50, colors: { background: "red", link: "blue" } };
  const calls = drawn((context) => batch.draw(context, 1, options));
  assert.ok(calls.includes("fillRect red 0 0 50 50") && calls.includes("stroke blue"));
});

test("invalid arguments of draw are rejected, and nothing is drawn", () => {
  const [batch, acrobot, context] = [new Batch({ count: 1 }), new Acrobot(), canvas()];
  const draw = (options) => () => acrobot.draw(context, options);
  const SIZE = "options.size must be finite and at least 0 pixels";
  const NAMES = "background, target, link, joint, torque";
  assertRejected([
    ["TypeError", "context must be a canvas's 2D context", ["undefined", () => acrobot.draw()]],
    ["TypeError", "options must be among size, colors", ["sise", draw({ sise: 1 })]],
    ["RangeError", SIZE, ["-1", draw({ size: -1 })], ["NaN", () => acrobot.draw({ arc() {} })]],
    ["TypeError", `options.colors must be among ${NAMES}`,
      ["lnik", draw({ colors: { lnik: "" } })]],
    ["TypeError", "options.colors.link must be a string", ["5", draw({ colors: { link: 5 } })]],
    ["TypeError", "index must be an integer from 0 to 0",
      ["[object Object]", () => batch.draw(context, {})]],
  ]);
  assert.deepEqual(context.calls, []);
});

const DRAW =
  "mass1 must be drawn by [low, high], { logUniform: [low, high] }, " +
  '{ normal: [mean, std, low, high] }, "asBefore" or "fixed"';
const SINGLE = "in single precision";

// rejections.test.mjs has numbers outside the range of a parameter.
test("invalid arguments are rejected with the value and the rule, and nothing changes", () => {
  const acrobot = busy();
  const before = acrobot.snapshot();
  const step = (action) => () => acrobot.step(action);
  const reset = (seed) => () => acrobot.reset(seed);
  const set = (params) => () => acrobot.setParams(params);
  const make = (options) => () => new Acrobot(options);
  const draw = (draws) => () => acrobot.setDraws(draws);
  const move = (state) => () => (acrobot.state = state);
  const rows = [
    ["RangeError", `action ${ACTION}`, ["1.5", step(1.5)]],
    ["TypeError", `action ${ACTION}`,
      ["1n", step(1n)], ['"1"', step("1")], ["undefined", step()], ["[object Array]", step([1])],
      ["Symbol(1)", step(Symbol("1"))], ["a function", step(() => 1)]],
    ["TypeError", "torque must be a finite number of N m", ['"1"', () => acrobot.stepTorque("1")]],
    ["RangeError", 'friction1 must be 0 in the task "acrobot", in N m s/rad',
      ["0.1", set({ friction1: 0.1 })], ["0.2", draw({ friction1: [0, 0.2] })]],
    ["TypeError", "mass1[1] must be a number", ['"2"', draw({ mass1: [1, "2"] })]],
    ["TypeError", DRAW,
      ["1", draw({ mass1: 1 })], ["null", draw({ mass1: null })],
      ["[object Object]", draw({ mass1: { logUniform: 1, normal: 0 } })]],
    ["RangeError", "mass1 must have 2 elements",
      ["3", draw({ mass1: [1, 2, 3] })], ["0", draw({ mass1: "uniform" })]],
    ["TypeError", "mass1 must be an array of 4 elements", ["1", draw({ mass1: { normal: 1 } })]],
    ["TypeError", `draws must be among ${PARAMS.slice(0, -1).join(", ")}`,
      ["dynamics", draw({ dynamics: "nips" })]],
    ["TypeError", 'task must be "acrobot" or "swingup" or "balance"',
      ['"swing-up"', make({ task: "swing-up" })]],
    ["RangeError", SEED,
      ["-1", () => acrobot.sample(-1)],
      ["-1n", reset(-1n)], ["9007199254740992", reset(2 ** 53)],
      [`${1n << 2048n}n`, reset(1n << 2048n)]],
    ["TypeError", SEED, ['"42"', reset("42")], ["null", reset(null)]],
    ["TypeError", "mass1 must be a number", ["undefined", set({ mass1: undefined })]],
    ["RangeError", "gravity must be a finite number of m/s²",
      [`1e+39, which is Infinity ${SINGLE}`, set({ gravity: 1e39 })]],
    ["RangeError", "length1 must be finite and above 0 m",
      ["-0", set({ length1: -0 })], [`1e-60, which is 0 ${SINGLE}`, set({ length1: 1e-60 })]],
    ["RangeError", "torques must have 3 elements", ["2", set({ torques: [1, 2] })]],
    ["TypeError", "torques[2] must be a number", ["null", set({ torques: [1, 2, null] })]],
    ["TypeError", 'dynamics must be "book" or "nips"', ['"Nips"', set({ dynamics: "Nips" })]],
    ["TypeError", `params must be among ${PARAMS.join(", ")}`, ["mass", set({ mass: 1 })]],
    ["TypeError", "params must be a plain object",
      ["undefined", set()], ["[object Map]", set(new Map([["mass1", 2]]))]],
    ["TypeError", "theta2 must be a number", ["undefined", move({ theta1: 0 })]],
    ["RangeError", "maxSteps must be an integer from 1 to 2^32 - 1",
      ["0", make({ maxSteps: 0 })], ["4294967296", make({ maxSteps: 2 ** 32 })]],
    ["TypeError", "options must be among seed, params, maxSteps, task, draws",
      ["sed", make({ sed: 1 })]],
  ];
  assertRejected(rows, (call) => assert.deepEqual(acrobot.snapshot(), before, String(call)));
});

test("a snapshot continues with the same bits, in another acrobot too", () => {
  const acrobot = busy();
  const others = [Acrobot.restore(acrobot.snapshot()), new Acrobot({ maxSteps: 7 })];
  others[1].restore(acrobot.snapshot());
  for (const other of others) {
    assert.deepEqual(other.maxSteps, acrobot.maxSteps);
    for (const action of ACTIONS) other.step(action);
    other.reset();
  }
  for (const action of ACTIONS) acrobot.step(action);
  acrobot.reset();
  for (const other of others) assert.deepEqual(other.snapshot(), acrobot.snapshot());
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
  const rejects = (bytes, error) => {
    assert.throws(() => acrobot.restore(bytes), error);
    assert.deepEqual(acrobot.snapshot(), before);
  };
  const rejectsFor = (reason, bytes) => {
    const rule = "the snapshot must be an undamaged one of the same class, version and task";
    const message = `${rule}, got ${bytes.length} bytes with ${reason}`;
    rejects(bytes, { name: "RangeError", message });
  };
  before.forEach((byte, i) => {
    for (const damaged of [before.with(i, byte ^ 1), before.slice(0, i)]) {
      rejectsFor("another checksum", damaged);
    }
  });
  const other = "another class, version or task";
  rejectsFor(other, changed(before, 8, 3)); // version 3
  rejectsFor(other, new Batch({ count: 5 }).snapshot());
  rejectsFor(other, sealed(Buffer.from("text")));
  rejectsFor("invalid contents", changed(before, 25, 0, 0, 0xc0, 0x7f)); // a length1 of NaN
  rejectsFor("invalid contents", sealed(Buffer.concat([before.subarray(0, -4), Buffer.of(0)])));
  const message = "the snapshot must be a Uint8Array, got [object ArrayBuffer]";
  rejects(before.buffer, { name: "TypeError", message });
  // Any bytes with the right checksum.
  const random = randoms();
  for (let i = 0; i < 2000; i++) {
    try {
      acrobot.restore(changed(before, random(before.length - 4), random(256)));
      acrobot.step(2);
    } catch ({ message }) {
      assert.match(message, /^the snapshot must be an undamaged one /);
    }
    acrobot.restore(before);
  }
});

test("after free, methods throw, and other acrobots continue", () => {
  const [acrobot, other] = [new Acrobot({ seed: 1 }), new Acrobot({ seed: 2 })];
  const before = other.snapshot();
  acrobot.free();
  acrobot.free();
  // Its memory is used again.
  const third = new Acrobot({ seed: 3 });
  for (const use of [
    ...["reset", "step", "stepTorque", "sample", "draw"].map((name) => () => acrobot[name](1)),
    ...["observation", "state", "params", "energy"].map((name) => () => acrobot[name]),
    () => acrobot.snapshot(),
    () => acrobot.setParams({}),
    () => acrobot.setDraws({}),
    () => (acrobot.state = other.state),
    () => acrobot.restore(before),
  ]) {
    assert.throws(use, { name: "Error", message: "the acrobot has been freed" });
  }
  assert.deepEqual(third.snapshot(), new Acrobot({ seed: 3 }).snapshot());
  assert.deepEqual(other.snapshot(), before);
  third[Symbol.dispose]();
  assert.throws(() => third.step(1), /freed/);
});
