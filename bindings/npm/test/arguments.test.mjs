// Reading an argument can run code of the caller, or be of memory that other threads write.

import assert from "node:assert/strict";
import { test } from "node:test";

import { instance } from "./module.mjs";

const { Acrobot, Batch, size } = await instance();

/** Makes batches until the memory has grown, which ends all views of it. */
function grow() {
  const before = size();
  while (size() === before) new Batch({ count: 1000 });
}

/** The object, whose getters call `act` first. */
function acting(object, act) {
  const made = Array.isArray(object) ? [] : {};
  for (const [name, value] of Object.entries(object)) {
    Object.defineProperty(made, name, { get: () => (act(name), value), enumerable: true });
  }
  return made;
}

/**
 * A proxy that calls `act` before each property is read. Methods get the object and not the proxy.
 */
function proxy(object, act) {
  const get = (target, name) => {
    act(name);
    const value = target[name];
    return typeof value === "function" ? value.bind(target) : value;
  };
  return new Proxy(object, { get });
}

const PARAMS = { dt: 0.05, torques: [-2, 0, 2], torqueNoise: 0.1 };
const STATE = { theta1: 1, theta2: 2, dtheta1: 3, dtheta2: 4 };
const STATES = Float32Array.from({ length: 12 }, (_, i) => i / 8);
const SNAPSHOT = new Acrobot({ seed: 3, params: PARAMS }).snapshot();

/** Uses of an object as an argument: what it changes, what the object is, and the use. */
const USES = [
  ["batch", [2, 2, 2], (batch, actions) => batch.step(actions)],
  ["batch", Uint8Array.of(2, 2, 2), (batch, actions) => batch.step(actions)],
  ["batch", [2, -2, 0.5], (batch, torques) => batch.stepTorque(torques)],
  ["batch", Float32Array.of(2, -2, 0.5), (batch, torques) => batch.stepTorque(torques)],
  ["batch", STATES, (batch, states) => batch.setStates(states)],
  ["acrobot", { mass1: [1, 2] }, (acrobot, draws) => acrobot.setDraws(draws)],
  ["acrobot", [1, 2], (acrobot, mass1) => acrobot.setDraws({ mass1 })],
  ["acrobot", { logUniform: [1, 2] }, (acrobot, mass1) => acrobot.setDraws({ mass1 })],
  ["batch", PARAMS, (batch, params) => batch.setParams(params)],
  ["acrobot", PARAMS, (acrobot, params) => acrobot.setParams(params)],
  ["batch", [true, 0, 1], (batch, mask) => batch.resetMasked(mask)],
  ["batch", STATE, (batch, state) => batch.setStateOf(1, state)],
  ["acrobot", PARAMS.torques, (acrobot, torques) => acrobot.setParams({ torques })],
  ["acrobot", STATE, (acrobot, state) => (acrobot.state = state)],
  ["acrobot", SNAPSHOT, (acrobot, snapshot) => acrobot.restore(snapshot)],
];

/**
 * The uses, each with the ways to `wrap` the object so that reading it acts. The elements of a
 * typed array have no getters.
 */
const CASES = USES.flatMap(([kind, given, use]) => {
  const wraps = ArrayBuffer.isView(given) ? [proxy] : [acting, proxy];
  return wraps.map((wrap) => [kind, given, use, wrap]);
});

const make = (kind) =>
  kind === "batch" ? new Batch({ seed: 1, count: 3 }) : new Acrobot({ seed: 1 });
/** All that can be seen of an acrobot or a batch, which this steps. */
function seen(of) {
  if (!of.count) return of.snapshot();
  const numbers = [...Array(of.count).keys()];
  return [of.params, numbers.map((i) => of.stateOf(i)), of.step(numbers.map((i) => i % 3))];
}

test("an argument that frees what gets it is rejected, and changes no other acrobot", () => {
  const batches = () => Array.from({ length: 40 }, (_, i) => new Batch({ seed: 1, count: 40 - i }));
  const others = () => [make("acrobot"), ...batches()];
  for (const [kind, given, use, wrap] of CASES) {
    const one = make(kind);
    let found;
    // Others get the memory.
    const argument = wrap(given, () => (one.free(), (found ??= others())));
    const message = `the ${kind} has been freed`;
    assert.throws(() => use(one, argument), { name: "Error", message });
    assert.deepEqual(found.map(seen), others().map(seen));
  }
});

test("an argument that uses what gets it, and makes the memory grow, acts before the call", () => {
  const act = (of) => {
    of.setParams({ gravity: of.params.gravity / 2 });
    of.step(of.count ? [0, 0, 0] : 0);
  };
  for (const [kind, given, use, wrap] of CASES) {
    const [one, other] = [make(kind), make(kind)];
    let acts = 0;
    use(one, wrap(given, () => (acts++, act(one), grow())));
    for (let i = 0; i < acts; i++) act(other);
    use(other, given);
    assert.deepEqual(seen(one), seen(other), use);
  }
});

test("each property is read once, so that what is checked is what is used", () => {
  for (const [kind, given, use] of USES) {
    const reads = new Map();
    use(make(kind), proxy(given, (name) => reads.set(name, (reads.get(name) ?? 0) + 1)));
    assert.deepEqual([...reads].filter(([name, count]) => count > 1), [], use);
  }
  // The message has the value that was rejected.
  const values = [NaN, 1];
  const state = { ...STATE, get theta1() { return values.shift(); } };
  const message = "theta1 must be a finite number of rad, got NaN";
  assert.throws(() => (new Acrobot().state = state), { message });
});

test("options whose getters use the package make the same acrobots", () => {
  const options = { seed: 7, params: PARAMS, maxSteps: 9 };
  const act = () => (grow(), new Acrobot({ seed: 1 }).step(2));
  const nested = (make) => make(acting({ ...options, params: acting(PARAMS, act) }, act));
  assert.deepEqual(seen(nested((given) => new Acrobot(given))), seen(new Acrobot(options)));
  const batches = { ...options, count: 3, autoreset: "SameStep" };
  assert.deepEqual(seen(new Batch(acting(batches, act))), seen(new Batch(batches)));
  // The class that `new` names, too.
  const target = new Proxy(Batch, { get: (...given) => (act(), Reflect.get(...given)) });
  assert.deepEqual(seen(Reflect.construct(Batch, [batches], target)), seen(new Batch(batches)));
});

test("errors of the caller's own code pass through, and nothing changes", () => {
  const act = () => {
    throw new SyntaxError("own");
  };
  for (const [kind, given, use, wrap] of CASES) {
    const one = make(kind);
    assert.throws(() => use(one, wrap(given, act)), { name: "SyntaxError", message: "own" });
    assert.deepEqual(seen(one), seen(make(kind)));
  }
});

test("arrays in shared, resized and detached memory have the elements that they have", () => {
  const shared = (bytes) => {
    const array = new Uint8Array(new SharedArrayBuffer(bytes.length));
    array.set(bytes);
    return array;
  };
  const [one, other] = [make("batch"), make("batch")];
  one.step(shared([0, 1, 2]));
  other.step([0, 1, 2]);
  assert.deepEqual(seen(one), seen(other));
  assert.deepEqual(Acrobot.restore(shared(SNAPSHOT)).snapshot(), SNAPSHOT);
  assert.throws(() => one.step(shared([0, 1, 9])), /RangeError: actions\[2\] must be 0 .*, got 9$/);
  const damaged = shared(SNAPSHOT.map((byte) => byte ^ 1));
  const message = /^the snapshot .* bytes with another checksum$/;
  assert.throws(() => Acrobot.restore(damaged), { name: "RangeError", message });

  const detached = (bytes) => {
    const array = Uint8Array.from(bytes);
    structuredClone(array, { transfer: [array.buffer] });
    return array;
  };
  assert.throws(() => one.step(detached([0, 1, 2])), /^RangeError: actions must have 3 .*, got 0$/);
  assert.throws(() => Acrobot.restore(detached(SNAPSHOT)), /^RangeError: the .* got 0 bytes/);

  const buffer = new ArrayBuffer(3, { maxByteLength: 8 });
  const resizable = new Uint8Array(buffer);
  one.step(resizable);
  if (buffer.resizable) {
    buffer.resize(5);
    assert.throws(() => one.step(resizable), /^RangeError: actions must have 3 elements, got 5$/);
  }
});

test("a Uint8Array that pretends another length takes no action of the last step", () => {
  const [one, other] = [make("batch"), make("batch")];
  one.step([2, 2, 2]);
  other.step([2, 2, 2]);
  const pretend = (bytes) => Object.defineProperty(bytes, "length", { value: 3 });
  const [short, long] = [2, 4].map((length) => pretend(new Uint8Array(length)));
  assert.throws(() => one.step(short), /^TypeError: actions\[2\] must be 0 .*, got undefined$/);
  assert.deepEqual(seen(one), seen(other));
  one.step(long);
  other.step([0, 0, 0]);
  assert.deepEqual(seen(one), seen(other));
});

test("results that the caller changes or transfers do not change later ones", () => {
  const options = { seed: 1, count: 3, autoreset: "SameStep" };
  const [one, other] = [new Batch(options), new Batch(options)];
  const results = one.step([0, 1, 2]);
  other.step([0, 1, 2]);
  const { observations } = results;
  results.rewards = results.more = delete results.truncated;
  assert.deepEqual(one.step([0, 1, 2]), other.step([0, 1, 2]));
  assert.equal(one.observations, observations);

  const taken = one.step([0, 1, 2]);
  other.step([0, 1, 2]);
  structuredClone(taken, { transfer: Object.values(taken).map(({ buffer }) => buffer) });
  assert.deepEqual(one.observations, other.observations);
  assert.deepEqual(one.step([0, 1, 2]), other.step([0, 1, 2]));
  assert.deepEqual(one.reset(), other.reset());
});
