// Many acrobots.

import { draw } from "./draw.js";
import {
  ACTION, Kept, TASKS, addressOf as addressOfKept, elements, indexOf, isAction, isFinite32, keep,
  orFree, readChanges, readGivenState, readParams, readState, seedSample, setState, writeParams,
} from "./kept.js";
import { load, save } from "./snapshot.js";
import {
  checked, copied, integers, invalid, numbers, positive, typeOf, wasm, writeSeed,
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

/** As a private getter it would throw an error that does not name the class. */
const addressOf = (batch) => addressOfKept(batch, "batch");

export class Batch extends Kept {
  static get name() {
    return "Batch";
  }

  #settings;
  /** The addresses of the arrays. */
  #addresses;
  /** The names of the results. */
  #names;
  /** Views of the arrays. */
  #views;
  /** Copies of the results: views of the module's memory end when that memory grows. */
  #results = {};
  /** Whether states have changed since the observations were written. */
  #stale = false;

  constructor(options) {
    super();
    const names = ["count", "seed", "params", "maxSteps", "autoreset", "ownParams", "task"];
    const given = checked("options", options, [...names, "draws"]);
    const { count, seed, params = {}, autoreset = AUTORESETS[0], task = TASKS[0] } = given;
    const { maxSteps, draws, ownParams = draws !== undefined } = given;
    const index = indexOf("task", TASKS, task);
    positive("count", count);
    const limit = maxSteps === undefined ? 0 : positive("maxSteps", maxSteps);
    const mode = indexOf("autoreset", AUTORESETS, autoreset);
    if (![true, false].includes(ownParams)) {
      throw invalid("ownParams must be true or false", ownParams, []);
    }
    keep(this, "batch", wasm().batch_new(count, limit, mode, ownParams, index), count);
    orFree(this, () => {
      this.setParams(params);
      if (draws !== undefined) this.setDraws(draws);
      wasm().batch_reset(addressOf(this), writeSeed(seed), false);
      this.#open();
    });
  }

  /** Reads what does not change except by `restore`. */
  #open() {
    wasm().batch_open(addressOf(this));
    const [count, maxSteps, mode, own, task, ...addresses] = integers().slice(0, 14);
    const [autoreset, ownParams] = [AUTORESETS[mode], own === 1];
    const settings = { count, maxSteps, autoreset, ownParams, task: TASKS[task] };
    this.#settings = Object.freeze(settings);
    this.#addresses = addresses;
    this.#names = Object.keys(ARRAYS).slice(0, autoreset === "SameStep" ? 6 : 5);
    this.#results = {};
    this.#views = undefined;
    this.#copy(...this.#names);
    this.#observe();
  }

  /** Copies results out of the module's memory. */
  #copy(...names) {
    if (!this.#views?.rewards.length) {
      const { buffer } = wasm().memory;
      const views = Object.entries(ARRAYS).map(([name, [Type, width]], i) => {
        return [name, new Type(buffer, this.#addresses[i], width * this.#settings.count)];
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
    if (!Number.isInteger(index) || index < 0 || index >= batch.count) {
      throw invalid(`${what}index must be an integer from 0 to ${batch.count - 1}`, index);
    }
    return address;
  }

  get count() {
    addressOf(this);
    return this.#settings.count;
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
    return this.#reset(undefined, seed);
  }

  resetMasked(mask, seed) {
    addressOf(this);
    const isFlag = (element) => [true, false, 1, 0].includes(element);
    const rule = "must be true, false, 1 or 0";
    return this.#reset(elements("mask", mask, this.count, isFlag, rule), seed);
  }

  #reset(mask, seed) {
    const address = addressOf(this);
    const words = seed === undefined ? 0 : writeSeed(seed);
    this.#copy();
    if (mask) this.#views.mask.set(mask);
    wasm().batch_reset(address, words, mask !== undefined);
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
    const size = this.#settings.count * BYTES_PER_ELEMENT;
    // The module can check elements of this type.
    const isRead = typeOf(given) === name && given.byteLength === size;
    // Reading others can run code that frees the batch or makes memory grow, so it comes first.
    const inputs = isRead ? given : elements(what, given, this.#settings.count, isValid, rule);
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
    return { ...this.#results };
  }

  stateOf(index) {
    wasm().batch_state(Batch.#addressFor(this, index), index);
    return readState();
  }

  setStateOf(index, state) {
    Batch.#addressFor(this, index);
    const given = readGivenState(state);
    setState("batch", addressOf(this), given, index);
    this.#stale = true;
  }

  get states() {
    const [address, states] = [addressOf(this), new Float32Array(4 * this.#settings.count)];
    for (let i = 0; i < this.#settings.count; i++) {
      wasm().batch_state(address, i);
      states.set(numbers().subarray(0, 4), 4 * i);
    }
    return states;
  }

  setStates(states) {
    addressOf(this);
    const rule = (i) => `must be a finite number of ${i % 4 < 2 ? "rad" : "rad/s"}`;
    const given = elements("states", states, 4 * this.#settings.count, isFinite32, rule);
    const address = addressOf(this);
    for (let i = 0; i < this.#settings.count; i++) {
      numbers().set(given.slice(4 * i, 4 * i + 4));
      wasm().batch_set_state(address, i);
    }
    this.#stale = true;
  }

  elapsedStepsOf(index) {
    return wasm().batch_elapsed_steps(Batch.#addressFor(this, index), index) >>> 0;
  }

  paramsOf(index) {
    return readParams("batch", Batch.#addressFor(this, index), index);
  }

  setParamsOf(index, changes) {
    Batch.#addressFor(this, index);
    const given = readChanges(changes);
    writeParams("batch", addressOf(this), given, index);
  }

  snapshot() {
    return save("batch", addressOf(this));
  }

  static restore(snapshot) {
    const copy = copied("the snapshot", snapshot);
    const batch = new this({ count: 1 });
    orFree(batch, () => {
      load("batch", addressOf(batch), copy);
      batch.#open();
    });
    return batch;
  }

  draw(context, index, options) {
    const signature = "draw(context, index, options)";
    Batch.#addressFor(this, index, `${signature}: `);
    draw(signature, context, this.stateOf(index), this.paramsOf(index), 0, options);
  }
}
