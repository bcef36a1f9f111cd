// Gymnasium's Acrobot-v1 in WebAssembly. index.d.ts describes the interface.

import { draw } from "./draw.js";
import { accept, bytes, checked, invalid, numbers, positive, wasm, writeSeed } from "./wasm.js";

const STATE = ["theta1", "theta2", "dtheta1", "dtheta2"];
/** The parameters in the order of the module, where three torques follow instead of `torques`. */
const NUMBERS = [
  "length1", "length2", "mass1", "mass2", "centerOfMass1", "centerOfMass2", "inertia1", "inertia2", "gravity", "dt",
  "maxVelocity1", "maxVelocity2", "torques", "torqueNoise",
];
const RESULTS = ["observations", "rewards", "terminated", "truncated", "ended", "finalObservations"];
const AUTORESETS = ["NextStep", "SameStep", "Disabled"];
const ACTION = "must be 0 (negative torque), 1 (none) or 2 (positive)";

const isAction = (action) => action === 0 || action === 1 || action === 2;

const sample = () => Math.floor(3 * Math.random());

const readState = () => Object.freeze(Object.fromEntries(STATE.map((name, i) => [name, numbers()[i]])));

/** Writes a state into the module's memory. Returns the function that `accept` needs. */
function writeState(state) {
  const given = checked("state", state, STATE);
  for (const name of STATE) if (typeof given[name] !== "number") throw invalid(`${name} must be a number`, given[name]);
  numbers().set(STATE.map((name) => given[name]));
  return (name) => given[name];
}

/** The elements of an array, each read once, because that can run code of the caller. They are not converted: 258 and "2" are not 2. */
function elements(what, array, count, isValid, rule) {
  const length = array?.length;
  if (length !== count) throw invalid(`${what} must have ${count} elements`, length ?? array);
  const copy = [];
  for (let i = 0; i < count; i++) {
    const element = array[i];
    if (!isValid(element)) throw invalid(`${what}[${i}] ${rule}`, element);
    copy.push(element);
  }
  return copy;
}

/** Frees what the program has forgotten to free. */
const registry = new FinalizationRegistry(({ kind, number }) => wasm()[`${kind}_free`](number));

/** Properties that only this file can read. */
const [NUMBER, SHOWN] = [Symbol("number"), Symbol("shown")];

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
    const torques = Object.freeze(values.splice(12, 3));
    const params = Object.fromEntries(NUMBERS.filter((name) => name !== "torques").map((name, i) => [name, values[i]]));
    return Object.freeze({ ...params, torques, dynamics: values.at(-1) === 1 ? "nips" : "book" });
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

  /** What Node.js's console shows. */
  [Symbol.for("nodejs.util.inspect.custom")](depth, options, inspect) {
    const shown = this.#number === undefined ? "freed" : inspect(this[SHOWN], options);
    return `${this.constructor.name} ${shown}`;
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

/** Joins the parts of a snapshot, and adds the checksum. */
function seal(parts) {
  const length = parts.reduce((sum, part) => sum + part.length, 0);
  const snapshot = new Uint8Array(length + 4);
  let at = 0;
  for (const part of parts) {
    snapshot.set(part, at);
    at += part.length;
  }
  new DataView(snapshot.buffer).setUint32(length, checksum(snapshot.subarray(0, length)), true);
  return snapshot;
}

/** A snapshot without its checksum. */
function unseal(snapshot) {
  if (!(snapshot instanceof Uint8Array)) throw invalid("the snapshot must be a Uint8Array", snapshot);
  // A copy, because other threads may write shared memory, and a proxy can run code.
  const copy = new Uint8Array(snapshot.length);
  for (let i = 0; i < copy.length; i++) copy[i] = snapshot[i];
  const content = copy.subarray(0, -4);
  if (copy.length < 4 || new DataView(copy.buffer).getUint32(content.length, true) !== checksum(content)) {
    throw new RangeError(`the snapshot must have the bytes of snapshot(), got ${copy.length} bytes with another checksum`);
  }
  return content;
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
    const acrobot = new this();
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

  sample() {
    return sample();
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
    const valueOf = writeState(state);
    accept(wasm().acrobot_set_state(this[NUMBER]), valueOf);
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
    return seal([bytes().subarray(0, length)]);
  }

  restore(snapshot) {
    const content = unseal(snapshot);
    wasm().acrobot_save(this[NUMBER]);
    const rule = `the snapshot must be a valid one of ${header(bytes())}`;
    if (content.length > 256) throw new RangeError(`${rule}, got ${content.length} bytes`);
    bytes().set(content);
    if (!wasm().acrobot_load(this[NUMBER], content.length)) throw new RangeError(`${rule}, got ${header(content)}`);
    this.#action = 1;
  }

  draw(context, options) {
    const { params } = this;
    draw("draw(context, options)", context, this.state, params, params.torques[this.#action], options);
  }

  get [SHOWN]() {
    const { state, elapsed, maxSteps, params } = this;
    return { state, elapsed, maxSteps, params };
  }
}

/** What a batch's snapshot begins with after its length, in the format of postcard: the header, and the bounds −0.1 and 0.1 as doubles. */
const BATCH = [...new TextEncoder().encode("\x05batch\x01\x04fast"), ...new Uint8Array(Float64Array.of(-0.1, 0.1).buffer)];

/** An integer in seven bits a byte, the lowest first. The highest bit of each byte says whether more follow. */
const varint = (value) => (value < 128 ? [value] : [(value % 128) | 128, ...varint(Math.floor(value / 128))]);

export class Batch extends Kept {
  #count;
  #settings;
  /** The addresses of the actions and of the results. */
  #addresses;
  /** The names of the results. */
  #names;
  /** Views of these results. */
  #views;
  /** Their copies in JavaScript's memory, because views of the module's memory end when that memory grows. */
  #results = {};
  /** Whether states have changed since the observations were written. */
  #stale = false;

  constructor(options) {
    const names = ["count", "seed", "params", "maxSteps", "autoreset"];
    const { count, seed, params = {}, maxSteps = 500, autoreset = "NextStep" } = checked("options", options, names);
    positive("count", count);
    positive("maxSteps", maxSteps);
    if (!AUTORESETS.includes(autoreset)) throw invalid(`autoreset must be ${AUTORESETS.join(", ")}`, autoreset);
    const number = wasm().batch_new(count, writeSeed(seed), maxSteps, AUTORESETS.indexOf(autoreset));
    const addresses = new Uint32Array(bytes().slice(0, 32).buffer);
    super("batch", number, count);
    this.#count = count;
    this.#settings = Object.freeze({ count, maxSteps, autoreset });
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
        ended: this.#view(6, Uint8Array, count),
        mask: this.#view(7, Uint8Array, count),
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
    this.#stale = false;
  }

  /** The batch's number, for a use of acrobot `index`. */
  #numberFor(index, what = "") {
    const number = this[NUMBER];
    if (!Number.isInteger(index) || index < 0 || index >= this.#count) {
      throw invalid(`${what}index must be an integer from 0 to ${this.#count - 1}`, index);
    }
    return number;
  }

  get count() {
    return this.#count;
  }

  get settings() {
    return this.#settings;
  }

  get observations() {
    this[NUMBER];
    if (this.#stale || !this.#results.observations.length) this.#observe();
    return this.#results.observations;
  }

  reset(seed) {
    return this.#reset(new Uint8Array(this.#count).fill(1), seed);
  }

  resetMasked(mask, seed) {
    const isFlag = (element) => [true, false, 1, 0].includes(element);
    return this.#reset(elements("mask", mask, this.#count, isFlag, "must be true, false, 1 or 0"), seed);
  }

  #reset(mask, seed) {
    const number = this[NUMBER];
    const words = seed === undefined ? 0 : writeSeed(seed);
    this.#copy();
    this.#views.mask.set(mask);
    wasm().batch_reset(number, words);
    this.#observe();
    return this.#results.observations;
  }

  sample() {
    return Uint8Array.from({ length: this.#count }, sample);
  }

  step(actions) {
    let given = actions;
    // The elements of a plain Uint8Array are bytes, so the module can check them.
    if (!ArrayBuffer.isView(actions) || !(actions instanceof Uint8Array) || actions.byteLength !== this.#count) {
      // Reading others can run code that frees the batch or makes the module's memory grow, so they are read first.
      given = elements("actions", actions, this.#count, isAction, ACTION);
    }
    const number = this[NUMBER];
    this.#copy();
    this.#views.actions.set(given);
    if (!wasm().batch_step(number)) {
      const index = this.#views.actions.findIndex((action) => action > 2);
      throw invalid(`actions[${index}] ${ACTION}`, this.#views.actions[index]);
    }
    this.#copy(...this.#names);
    this.#stale = false;
    return { ...this.#results };
  }

  state(index) {
    wasm().batch_state(this.#numberFor(index), index);
    return readState();
  }

  setState(index, state) {
    this.#numberFor(index);
    const valueOf = writeState(state);
    accept(wasm().batch_set_state(this[NUMBER], index), valueOf);
    this.#stale = true;
  }

  elapsed(index) {
    return wasm().batch_elapsed(this.#numberFor(index), index) >>> 0;
  }

  #header() {
    const { count, maxSteps, autoreset } = this.#settings;
    // No own parameters, and no range of them.
    return [...varint(count + 1), ...BATCH, ...varint(maxSteps), AUTORESETS.indexOf(autoreset), 0, 0];
  }

  snapshot() {
    const number = this[NUMBER];
    const members = Array.from({ length: this.#count }, (_, i) => bytes().slice(0, wasm().batch_save(number, i)));
    this.#copy();
    return seal([this.#header(), ...members, this.#settings.autoreset === "Disabled" ? this.#views.ended : []]);
  }

  static restore(snapshot) {
    const content = unseal(snapshot);
    const wrong = new RangeError(`the snapshot must be a valid one of a batch, version 1, arithmetic "fast", got ${content.length} other bytes`);
    let at = 0;
    const read = () => {
      let value = 0;
      for (let unit = 1, more = true; more && unit < 2 ** 36; unit *= 128) {
        const byte = content[at++];
        value += (byte % 128) * unit;
        more = byte >= 128;
      }
      return value;
    };
    const count = read() - 1;
    at += BATCH.length;
    const [maxSteps, mode] = [read(), read()];
    // An acrobot has at least 94 bytes.
    if (!(count >= 1 && count < content.length / 94 && maxSteps >= 1 && maxSteps < 2 ** 32 && mode in AUTORESETS)) throw wrong;
    const batch = new this({ count, maxSteps, autoreset: AUTORESETS[mode] });
    if (batch.#load(content)) return batch;
    batch.free();
    throw wrong;
  }

  #load(content) {
    const [number, header] = [this[NUMBER], this.#header()];
    if (header.some((byte, i) => byte !== content[i])) return false;
    let at = header.length;
    for (let index = 0; index < this.#count; index++) {
      const member = content.subarray(at, at + 256);
      bytes().set(member);
      const length = wasm().batch_load(number, index, member.length);
      if (length === 0) return false;
      at += length;
    }
    const ended = content.subarray(at);
    if (ended.length !== (this.#settings.autoreset === "Disabled" ? this.#count : 0) || ended.some((flag) => flag > 1)) return false;
    this.#copy();
    this.#views.ended.set(ended);
    this.#observe();
    return true;
  }

  draw(context, index, options) {
    const signature = "draw(context, index, options)";
    this.#numberFor(index, `${signature}: `);
    draw(signature, context, this.state(index), this.params, 0, options);
  }

  get [SHOWN]() {
    return this.#settings;
  }
}
