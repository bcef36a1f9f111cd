// Gymnasium's Acrobot-v1 in WebAssembly. index.d.ts describes the interface.

import { draw } from "./draw.js";
import { accept, bytes, checked, invalid, numbers, positive, wasm, writeSeed } from "./wasm.js";

const STATE = ["theta1", "theta2", "dtheta1", "dtheta2"];
/** The parameters in the order of the module, where three torques follow instead of `torques`. */
const NUMBERS = [
  "length1", "length2", "mass1", "mass2", "centerOfMass1", "centerOfMass2", "inertia1", "inertia2", "gravity", "dt",
  "maxVelocity1", "maxVelocity2", "torques", "torqueNoise",
];
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
    const params = { ...this.params, ...checked("params", changes, [...NUMBERS, "dynamics"]) };
    const { torques, dynamics } = params;
    if (!Array.isArray(torques) || torques.length !== 3) throw invalid("torques must be an array of 3 numbers", torques);
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
    const values = STATE.map((name) => checked("state", state, STATE)[name]);
    const wrong = values.findIndex((value) => typeof value !== "number");
    if (wrong >= 0) throw invalid(`${STATE[wrong]} must be a number`, values[wrong]);
    numbers().set(values);
    accept(wasm().acrobot_set_state(this[NUMBER]), (name) => state[name]);
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
    const length = snapshot.length - 4;
    const found = new DataView(snapshot.buffer, snapshot.byteOffset, snapshot.length);
    if (length < 0 || length > 256 || found.getUint32(length, true) !== checksum(snapshot.subarray(0, length))) {
      throw new RangeError(`the snapshot must have the bytes of snapshot(), got ${length + 4} bytes with another checksum`);
    }
    wasm().acrobot_save(this[NUMBER]);
    const rule = `the snapshot must be a valid one of ${header(bytes())}`;
    bytes().set(snapshot.subarray(0, length));
    if (!wasm().acrobot_load(this[NUMBER], length)) throw new RangeError(`${rule}, got ${header(snapshot)}`);
    this.#action = 1;
  }

  draw(context, options = {}) {
    const { params } = this;
    draw(context, this.state, params, params.torques[this.#action], options);
  }
}

export class Batch extends Kept {
  #count;
  /** The addresses of the actions and of the results. */
  #addresses;
  /** Views of these results. */
  #views;
  #results;

  constructor(options) {
    const names = ["count", "seed", "params", "maxSteps", "autoreset"];
    const { count, seed, params = {}, maxSteps = 500, autoreset = "NextStep" } = checked("options", options, names);
    positive("count", count);
    positive("maxSteps", maxSteps);
    if (!AUTORESETS.includes(autoreset)) throw invalid(`autoreset must be ${AUTORESETS.join(", ")}`, autoreset);
    super("batch", wasm().batch_new(count, writeSeed(seed), maxSteps, AUTORESETS.indexOf(autoreset)), count);
    this.#count = count;
    this.#addresses = new Uint32Array(bytes().slice(0, 24).buffer);
    try {
      this.setParams(params);
      // In JavaScript's memory, because views of the module's memory end when that memory grows.
      this.#results = {
        observations: new Float32Array(6 * count),
        rewards: new Float32Array(count),
        terminated: new Uint8Array(count),
        truncated: new Uint8Array(count),
        ...(autoreset === "SameStep" && { finalObservations: new Float32Array(6 * count) }),
      };
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
    for (const name of names) this.#results[name].set(this.#views[name]);
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
    return this.#results.observations;
  }

  reset(seed) {
    wasm().batch_reset(this[NUMBER], seed === undefined ? 0 : writeSeed(seed));
    this.#observe();
    return this.#results.observations;
  }

  step(actions) {
    const number = this[NUMBER];
    if (actions?.length !== this.#count) {
      throw invalid(`actions must have ${this.#count} elements`, actions?.length ?? actions);
    }
    // Without a conversion, which would turn 258 and "2" into 2.
    const wrong = actions instanceof Uint8Array ? -1 : Array.prototype.findIndex.call(actions, (action) => !isAction(action));
    this.#copy();
    if (wrong < 0) this.#views.actions.set(actions);
    if (wrong >= 0 || !wasm().batch_step(number)) {
      const index = wrong >= 0 ? wrong : actions.findIndex((action) => action > 2);
      throw invalid(`actions[${index}] ${ACTION}`, actions[index]);
    }
    this.#copy(...Object.keys(this.#results));
    return this.#results;
  }

  state(index) {
    const number = this[NUMBER];
    if (!Number.isInteger(index) || index < 0 || index >= this.#count) {
      throw invalid(`index must be an integer from 0 to ${this.#count - 1}`, index);
    }
    wasm().batch_state(number, index);
    return readState();
  }

  draw(context, index, options = {}) {
    draw(context, this.state(index), this.params, 0, options);
  }
}
