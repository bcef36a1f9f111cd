// Many acrobots.

import { draw } from "./draw.js";
import {
  ACTION, Kept, PARAMS_LENGTH, addressOf as addressOfKept, drawParams, elements, isAction,
  isFinite32, keep, orFree, readChanges, readParams, readState, seedSample, writeParams, writeState,
} from "./kept.js";
import { VERSION, begins, head, seal, taskIndex, taskOf, unseal } from "./snapshot.js";
import {
  accept, bytes, checked, invalid, numbers, positive, typeOf, wasm, writeSeed,
} from "./wasm.js";

/**
 * The results, and what JavaScript writes, in the order of the module's addresses: type, and number
 * of elements of an acrobot.
 */
const ARRAYS = {
  observations: [Float32Array, 6],
  rewards: [Float32Array, 1],
  terminated: [Uint8Array, 1],
  truncated: [Uint8Array, 1],
  ended: [Uint8Array, 1],
  finalObservations: [Float32Array, 6],
  actions: [Uint8Array, 1],
  mask: [Uint8Array, 1],
  torques: [Float32Array, 1],
};
const AUTORESETS = ["NextStep", "SameStep", "Disabled"];

/** The error of a batch whose acrobots share their parameters. */
const shared = () =>
  invalid("ownParams must be true for parameters of each acrobot", false, ["boolean"]);

/** As a private getter it would throw an error that does not name the class. */
const addressOf = (batch) => addressOfKept(batch, "batch");

/** An integer in seven bits a byte, the lowest first. The highest bit says whether more follow. */
const varint = (value) =>
  value < 128 ? [value] : [(value % 128) | 128, ...varint(Math.floor(value / 128))];

export class Batch extends Kept {
  static get name() {
    return "Batch";
  }

  #count;
  #settings;
  /** The addresses of the arrays. */
  #addresses;
  /** The names of the results. */
  #names;
  /** Views of the arrays. */
  #views;
  /** Copies of the results: views of the module's memory end when that memory grows. */
  #results = {};
  /** Whether resets draw parameters. */
  #draws = false;
  /** Whether states have changed since the observations were written. */
  #stale = false;

  constructor(options) {
    super();
    const names = ["count", "seed", "params", "maxSteps", "autoreset", "ownParams", "task"];
    const given = checked("options", options, [...names, "paramsRange"]);
    const { count, seed, params = {}, autoreset = "NextStep", task = "acrobot" } = given;
    const { paramsRange, ownParams = paramsRange !== undefined } = given;
    const index = taskIndex(task);
    positive("count", count);
    const limit = given.maxSteps === undefined ? 0 : positive("maxSteps", given.maxSteps);
    const mode = AUTORESETS.indexOf(autoreset);
    if (mode < 0) throw invalid(`autoreset must be ${AUTORESETS.join(", ")}`, autoreset, []);
    if (![true, false].includes(ownParams)) {
      throw invalid("ownParams must be true or false", ownParams, []);
    }
    const words = writeSeed(seed);
    keep(this, "batch", wasm().batch_new(count, words, limit, mode, ownParams, index), count);
    this.#addresses = new Uint32Array(bytes().slice(0, 40).buffer);
    const maxSteps = this.#addresses[9]; // follows the addresses
    this.#count = count;
    this.#settings = Object.freeze({ count, maxSteps, autoreset, ownParams, task });
    this.#names = Object.keys(ARRAYS).slice(0, autoreset === "SameStep" ? 6 : 5);
    orFree(this, () => {
      this.setParams(params);
      if (paramsRange !== undefined) {
        this.setParamsRange(paramsRange);
        for (let i = 0; i < count; i++) drawParams(this, i);
      }
      this.#copy(...this.#names);
    });
    this.#observe();
  }

  /** Copies results out of the module's memory. */
  #copy(...names) {
    if (!this.#views?.rewards.length) {
      const { buffer } = wasm().memory;
      const views = Object.entries(ARRAYS).map(([name, [Type, width]], i) => {
        return [name, new Type(buffer, this.#addresses[i], width * this.#count)];
      });
      this.#views = Object.fromEntries(views);
    }
    for (const name of names) {
      // An array that the caller has transferred to another thread has no elements.
      if (this.#results[name]?.length) this.#results[name].set(this.#views[name]);
      else this.#results[name] = this.#views[name].slice();
    }
  }

  #observe() {
    wasm().batch_observe(addressOf(this));
    this.#copy("observations");
    this.#stale = false;
  }

  /** The batch's address, for a use of acrobot `index`. */
  static #addressFor(batch, index, what = "") {
    const address = addressOf(batch);
    if (!Number.isInteger(index) || index < 0 || index >= batch.#count) {
      throw invalid(`${what}index must be an integer from 0 to ${batch.#count - 1}`, index);
    }
    return address;
  }

  get count() {
    addressOf(this);
    return this.#count;
  }

  get settings() {
    addressOf(this);
    return this.#settings;
  }

  get observations() {
    addressOf(this);
    if (this.#stale || !this.#results.observations.length) this.#observe();
    return this.#results.observations;
  }

  reset(seed) {
    addressOf(this);
    return this.#reset(new Uint8Array(this.#count).fill(1), seed);
  }

  resetMasked(mask, seed) {
    addressOf(this);
    const isFlag = (element) => [true, false, 1, 0].includes(element);
    const rule = "must be true, false, 1 or 0";
    return this.#reset(elements("mask", mask, this.#count, isFlag, rule), seed);
  }

  #reset(mask, seed) {
    const address = addressOf(this);
    const words = seed === undefined ? 0 : writeSeed(seed);
    this.#copy();
    this.#views.mask.set(mask);
    wasm().batch_reset(address, words);
    mask.forEach((resets, i) => resets && drawParams(this, i));
    this.#observe();
    return this.#results.observations;
  }

  sample(seed) {
    wasm().batch_sample(addressOf(this), seedSample(this, seed));
    this.#copy();
    return this.#views.actions.slice();
  }

  step(actions) {
    addressOf(this);
    return this.#step("actions", actions, isAction, ACTION);
  }

  stepTorque(torques) {
    addressOf(this);
    return this.#step("torques", torques, isFinite32, "must be a finite number of N m");
  }

  #step(what, given, isValid, rule) {
    const [{ name, BYTES_PER_ELEMENT }] = ARRAYS[what];
    const size = this.#count * BYTES_PER_ELEMENT;
    // The module can check elements of this type.
    const isRead = typeOf(given) === name && given.byteLength === size;
    // Reading others can run code that frees the batch or makes memory grow, so it comes first.
    const inputs = isRead ? given : elements(what, given, this.#count, isValid, rule);
    const address = addressOf(this);
    this.#copy();
    const written = this.#views[what];
    written.set(inputs);
    if (!wasm().batch_step(address, what === "torques")) {
      const index = written.findIndex((each) => !isValid(each));
      throw invalid(`${what}[${index}] ${rule}`, written[index]);
    }
    this.#copy(...this.#names);
    this.#stale = false;
    if (this.#draws) {
      for (let i = 0; i < this.#count; i++) {
        if (wasm().batch_elapsed(address, i) === 0) drawParams(this, i);
      }
    }
    return { ...this.#results };
  }

  state(index) {
    wasm().batch_state(Batch.#addressFor(this, index), index);
    return readState();
  }

  setState(index, state) {
    Batch.#addressFor(this, index);
    const valueOf = writeState(state);
    accept(wasm().batch_set_state(addressOf(this), index), valueOf);
    this.#stale = true;
  }

  get states() {
    const [address, states] = [addressOf(this), new Float32Array(4 * this.#count)];
    for (let i = 0; i < this.#count; i++) {
      wasm().batch_state(address, i);
      states.set(numbers().subarray(0, 4), 4 * i);
    }
    return states;
  }

  setStates(states) {
    addressOf(this);
    const rule = (i) => `must be a finite number of ${i % 4 < 2 ? "rad" : "rad/s"}`;
    const given = elements("states", states, 4 * this.#count, isFinite32, rule);
    const address = addressOf(this);
    for (let i = 0; i < this.#count; i++) {
      numbers().set(given.slice(4 * i, 4 * i + 4));
      wasm().batch_set_state(address, i);
    }
    this.#stale = true;
  }

  elapsed(index) {
    return wasm().batch_elapsed(Batch.#addressFor(this, index), index) >>> 0;
  }

  setParams(changes) {
    addressOf(this);
    if (!this.#settings.ownParams) return super.setParams(changes);
    const given = readChanges(changes);
    const address = addressOf(this);
    const before = [];
    try {
      for (let i = 0; i < this.#count; i++) {
        wasm().batch_params(address, i);
        before.push(bytes().slice(0, PARAMS_LENGTH));
        writeParams("batch", address, i, given);
      }
    } catch (error) {
      before.forEach((params, i) => {
        bytes().set(params);
        wasm().batch_set_params(address, i);
      });
      throw error;
    }
  }

  setParamsRange(range) {
    addressOf(this);
    if (!this.#settings.ownParams) throw shared();
    super.setParamsRange(range);
    this.#draws = true;
  }

  paramsOf(index) {
    return readParams("batch", Batch.#addressFor(this, index), index);
  }

  setParamsOf(index, changes) {
    Batch.#addressFor(this, index);
    if (!this.#settings.ownParams) throw shared();
    const given = readChanges(changes);
    writeParams("batch", addressOf(this), index, given);
  }

  #header() {
    const { count, maxSteps, autoreset, ownParams, task } = this.#settings;
    const bound = wasm().task_bound(taskIndex(task));
    const bounds = new Uint8Array(Float64Array.of(-bound, bound).buffer);
    // No range of parameters.
    const flags = [AUTORESETS.indexOf(autoreset), Number(ownParams), 0];
    const begin = [...varint(count + 1), ...head("batch", task), ...bounds];
    return [...begin, ...varint(maxSteps), ...flags];
  }

  snapshot() {
    const address = addressOf(this);
    const member = (_, i) => bytes().slice(0, wasm().batch_save(address, i));
    const rust = seal([this.#header(), ...Array.from({ length: this.#count }, member)]);
    if (this.#settings.autoreset !== "Disabled") return rust;
    this.#copy();
    return seal([rust, this.#views.ended]);
  }

  static restore(snapshot) {
    const content = unseal(snapshot);
    const what = `batch, version ${VERSION}, arithmetic "fast"`;
    const rule = `the snapshot must be a valid one of a ${what}`;
    const wrong = new RangeError(`${rule}, got ${content.length} other bytes`);
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
    const task = taskOf("batch", content.subarray(at));
    if (task === undefined) throw wrong;
    at += head("batch", task).length + 16;
    const [maxSteps, mode, own] = [read(), read(), read()];
    // An acrobot has at least 94 bytes.
    const isCount = count >= 1 && count < content.length / 94;
    if (!(isCount && maxSteps >= 1 && maxSteps < 2 ** 32 && mode in AUTORESETS)) throw wrong;
    const autoreset = AUTORESETS[mode];
    const batch = new this({ count, maxSteps, autoreset, ownParams: own === 1, task });
    if (batch.#load(content)) return batch;
    batch.free();
    throw wrong;
  }

  #load(content) {
    const [address, header] = [addressOf(this), this.#header()];
    if (!begins(content, header)) return false;
    let at = header.length;
    for (let index = 0; index < this.#count; index++) {
      const member = content.subarray(at, at + 256);
      bytes().set(member);
      const length = wasm().batch_load(address, index, member.length);
      if (length === 0) return false;
      at += length;
    }
    if (this.#settings.autoreset === "Disabled") {
      const ended = content.subarray(at + 4);
      if (ended.length !== this.#count || ended.some((flag) => flag > 1)) return false;
      this.#copy();
      this.#views.ended.set(ended);
    } else if (at !== content.length) return false;
    this.#observe();
    return true;
  }

  draw(context, index, options) {
    const signature = "draw(context, index, options)";
    Batch.#addressFor(this, index, `${signature}: `);
    draw(signature, context, this.state(index), this.paramsOf(index), 0, options);
  }
}
