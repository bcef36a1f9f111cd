// Gymnasium's Acrobot-v1 in WebAssembly. index.d.ts describes the interface.

import { draw } from "./draw.js";
import { accept, bytes, checked, invalid, numbers, positive, wasm, writeSeed } from "./wasm.js";

const STATE = ["theta1", "theta2", "dtheta1", "dtheta2"];
/** The parameters in the order of the module, where three torques follow instead of `torques`. */
const NUMBERS = [
  "length1", "length2", "mass1", "mass2", "centerOfMass1", "centerOfMass2", "inertia1", "inertia2", "gravity", "dt",
  "maxVelocity1", "maxVelocity2", "torques", "torqueNoise",
];
const RESULTS = ["observations", "rewards", "terminated", "truncated", "finalObservations"];
const AUTORESETS = ["NextStep", "SameStep", "Disabled"];
const ACTION = "must be 0 (negative torque), 1 (none) or 2 (positive)";

const isAction = (action) => action === 0 || action === 1 || action === 2;

const readState = () => Object.fromEntries(STATE.map((name, i) => [name, numbers()[i]]));

/** Frees what the program has forgotten to free. */
const registry = new FinalizationRegistry(({ kind, number }) => wasm()[`${kind}_free`](number));

/** A property that only this file can read. */
const NUMBER = Symbol("number");

/** What the module keeps under a number: an acrobot or a batch. */
class Kept {
  #kind;
  #number;

  /** Without memory, the module returns a negative number. */
  constructor(kind, number, count) {
    if (number < 0) throw new RangeError(`acrobots must fit into WebAssembly's memory of at most 4 GiB, got ${count} more`);
    this.#kind = kind;
    this.#number = number;
    registry.register(this, { kind, number }, this);
  }

  get [NUMBER]() {
    if (this.#number === undefined) throw new Error(`the ${this.#kind} has been freed`);
    return this.#number;
  }

  get params() {
    wasm()[`${this.#kind}_params`](this[NUMBER]);
    const values = [...numbers()];
    const torques = values.splice(12, 3);
    const params = Object.fromEntries(NUMBERS.filter((name) => name !== "torques").map((name, i) => [name, values[i]]));
    return { ...params, torques, dynamics: values.at(-1) === 1 ? "nips" : "book" };
  }

  setParams(changes) {
    const given = checked("params", changes, [...NUMBERS, "dynamics"]);
    if ("torques" in given) {
      const { torques } = given;
      if (!Array.isArray(torques) || torques.length !== 3) throw invalid("torques must be an array of 3 numbers", torques);
      given.torques = [0, 1, 2].map((i) => torques[i]);
    }
    const params = { ...this.params, ...given };
    const { torques, dynamics } = params;
    if (dynamics !== "book" && dynamics !== "nips") throw invalid('dynamics must be "book" or "nips"', dynamics);
    const values = NUMBERS.flatMap((name) => {
      const of = name === "torques" ? torques : [params[name]];
      for (const value of of) if (typeof value !== "number") throw invalid(`${name} must be a number`, value);
      return of;
    });
    numbers().set([...values, Number(dynamics === "nips")]);
    const length = wasm()[`${this.#kind}_set_params`](this[NUMBER]);
    accept(length, (name) => (name.startsWith("torques") ? torques[name.at(-2)] : params[name]));
  }

  free() {
    if (this.#number === undefined) return;
    registry.unregister(this);
    wasm()[`${this.#kind}_free`](this.#number);
    this.#number = undefined;
  }

  // Older engines have no `using`, and no such symbol.
  [Symbol.dispose ?? Symbol("dispose")]() {
    this.free();
  }
}

/** CRC-32 as in zlib. postcard's `crc32` functions append it to a snapshot, too. */
function checksum(bytes) {
  let crc = -1;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; bit++) crc = (crc >>> 1) ^ (crc & 1 && 0xedb88320);
  }
  return ~crc >>> 0;
}

/** The header of a snapshot: two texts after their lengths, with the version between them. */
function header(bytes) {
  const text = (start) => new TextDecoder().decode(bytes.subarray(start + 1, start + 1 + bytes[start]));
  const version = 1 + bytes[0];
  return `"${text(0)}", version ${bytes[version]}, arithmetic "${text(version + 1)}"`;
}

/** A loop, because `slice` takes half as long again. */
function observation() {
  const [from, to] = [numbers(), new Float32Array(6)];
  for (let i = 0; i < 6; i++) to[i] = from[i];
  return to;
}

export class Acrobot extends Kept {
  /** The action of the last step, for its picture. */
  #action = 1;

  constructor(options = {}) {
    const { seed, params = {}, maxSteps = 500 } = checked("options", options, ["seed", "params", "maxSteps"]);
    super("acrobot", wasm().acrobot_new(positive("maxSteps", maxSteps)), 1);
    try {
      this.setParams(params);
      wasm().acrobot_reset(this[NUMBER], writeSeed(seed));
    } catch (error) {
      this.free();
      throw error;
    }
  }

  static restore(snapshot) {
    const acrobot = new Acrobot();
    try {
      acrobot.restore(snapshot);
    } catch (error) {
      acrobot.free();
      throw error;
    }
    return acrobot;
  }

  reset(seed) {
    wasm().acrobot_reset(this[NUMBER], seed === undefined ? 0 : writeSeed(seed));
    this.#action = 1;
    return observation();
  }

  step(action) {
    if (!isAction(action)) throw invalid(`action ${ACTION}`, action);
    const flags = wasm().acrobot_step(this[NUMBER], action);
    this.#action = action;
    const terminated = (flags & 1) !== 0;
    return { observation: observation(), reward: terminated ? 0 : -1, terminated, truncated: (flags & 2) !== 0 };
  }

  get observation() {
    wasm().acrobot_observe(this[NUMBER]);
    return observation();
  }

  get state() {
    wasm().acrobot_read(this[NUMBER]);
    return readState();
  }

  set state(state) {
    const given = checked("state", state, STATE);
    for (const name of STATE) if (typeof given[name] !== "number") throw invalid(`${name} must be a number`, given[name]);
    numbers().set(STATE.map((name) => given[name]));
    accept(wasm().acrobot_set_state(this[NUMBER]), (name) => given[name]);
  }

  get energy() {
    wasm().acrobot_read(this[NUMBER]);
    return numbers()[4];
  }

  get tipHeight() {
    wasm().acrobot_read(this[NUMBER]);
    return numbers()[5];
  }

  get elapsed() {
    return wasm().acrobot_elapsed(this[NUMBER]) >>> 0;
  }

  get maxSteps() {
    return wasm().acrobot_max_steps(this[NUMBER]) >>> 0;
  }

  snapshot() {
    const length = wasm().acrobot_save(this[NUMBER]);
    const snapshot = new Uint8Array(length + 4);
    snapshot.set(bytes().subarray(0, length));
    new DataView(snapshot.buffer).setUint32(length, checksum(snapshot.subarray(0, length)), true);
    return snapshot;
  }

  restore(snapshot) {
    if (!(snapshot instanceof Uint8Array)) throw invalid("the snapshot must be a Uint8Array", snapshot);
    const { length } = snapshot;
    // A copy, because other threads may write shared memory, and a proxy can run code.
    const copy = Uint8Array.from({ length: Math.min(length, 261) }, (_, i) => snapshot[i]);
    const content = copy.subarray(0, -4);
    if (length < 4 || length > 260 || new DataView(copy.buffer).getUint32(content.length, true) !== checksum(content)) {
      throw new RangeError(`the snapshot must have the bytes of snapshot(), got ${length} bytes with another checksum`);
    }
    wasm().acrobot_save(this[NUMBER]);
    const rule = `the snapshot must be a valid one of ${header(bytes())}`;
    bytes().set(content);
    if (!wasm().acrobot_load(this[NUMBER], content.length)) throw new RangeError(`${rule}, got ${header(content)}`);
    this.#action = 1;
  }

  draw(context, options) {
    const { params } = this;
    draw(context, this.state, params, params.torques[this.#action], options);
  }
}

export class Batch extends Kept {
  #count;
  /** The addresses of the actions and of the results. */
  #addresses;
  /** The names of the results. */
  #names;
  /** Views of these results. */
  #views;
  /** Their copies in JavaScript's memory, because views of the module's memory end when that memory grows. */
  #results = {};

  constructor(options) {
    const names = ["count", "seed", "params", "maxSteps", "autoreset"];
    const { count, seed, params = {}, maxSteps = 500, autoreset = "NextStep" } = checked("options", options, names);
    positive("count", count);
    positive("maxSteps", maxSteps);
    if (!AUTORESETS.includes(autoreset)) throw invalid(`autoreset must be ${AUTORESETS.join(", ")}`, autoreset);
    const number = wasm().batch_new(count, writeSeed(seed), maxSteps, AUTORESETS.indexOf(autoreset));
    const addresses = new Uint32Array(bytes().slice(0, 24).buffer);
    super("batch", number, count);
    this.#count = count;
    this.#addresses = addresses;
    this.#names = autoreset === "SameStep" ? RESULTS : RESULTS.slice(0, -1);
    try {
      this.setParams(params);
      this.#copy(...this.#names);
    } catch (error) {
      this.free();
      throw error;
    }
    this.#observe();
  }

  #view(index, Type, length) {
    return new Type(wasm().memory.buffer, this.#addresses[index], length);
  }

  /** Copies results out of the module's memory. */
  #copy(...names) {
    const count = this.#count;
    if (!this.#views?.rewards.length) {
      this.#views = {
        actions: this.#view(0, Uint8Array, count),
        observations: this.#view(1, Float32Array, 6 * count),
        rewards: this.#view(2, Float32Array, count),
        terminated: this.#view(3, Uint8Array, count),
        truncated: this.#view(4, Uint8Array, count),
        finalObservations: this.#view(5, Float32Array, 6 * count),
      };
    }
    for (const name of names) {
      // An array that the caller has transferred to another thread has no elements.
      if (this.#results[name]?.length) this.#results[name].set(this.#views[name]);
      else this.#results[name] = this.#views[name].slice();
    }
  }

  #observe() {
    wasm().batch_observe(this[NUMBER]);
    this.#copy("observations");
  }

  get count() {
    return this.#count;
  }

  get observations() {
    this[NUMBER];
    if (!this.#results.observations.length) this.#observe();
    return this.#results.observations;
  }

  reset(seed) {
    wasm().batch_reset(this[NUMBER], seed === undefined ? 0 : writeSeed(seed));
    this.#observe();
    return this.#results.observations;
  }

  step(actions) {
    const length = actions?.length;
    if (length !== this.#count) throw invalid(`actions must have ${this.#count} elements`, length ?? actions);
    let given = actions;
    // The elements of a plain Uint8Array are bytes, so the module can check them. Reading others can run code that frees the batch or
    // makes the module's memory grow, so they are read first, and once. They are not converted: 258 and "2" are not 2.
    if (!ArrayBuffer.isView(actions) || !(actions instanceof Uint8Array) || actions.byteLength !== length) {
      given = [];
      for (let i = 0; i < length; i++) {
        const action = actions[i];
        if (!isAction(action)) throw invalid(`actions[${i}] ${ACTION}`, action);
        given.push(action);
      }
    }
    const number = this[NUMBER];
    this.#copy();
    this.#views.actions.set(given);
    if (!wasm().batch_step(number)) {
      const index = this.#views.actions.findIndex((action) => action > 2);
      throw invalid(`actions[${index}] ${ACTION}`, this.#views.actions[index]);
    }
    this.#copy(...this.#names);
    return { ...this.#results };
  }

  state(index) {
    const number = this[NUMBER];
    if (!Number.isInteger(index) || index < 0 || index >= this.#count) {
      throw invalid(`index must be an integer from 0 to ${this.#count - 1}`, index);
    }
    wasm().batch_state(number, index);
    return readState();
  }

  draw(context, index, options) {
    draw(context, this.state(index), this.params, 0, options);
  }
}
