// Many acrobots.

import {
  ACTION, AUTORESETS, Environment, TASKS, changeParams, drawOne, isAction, load, readParams,
  readState, setState,
} from "./environment.js";
import { addressOf, call, elements, writeSeed } from "./kept.js";
import { integers, invalid, isFinite32, numbers, wasm } from "./wasm.js";

/**
 * The results, and what JavaScript writes, in the order of the module's addresses: type, and number
 * of elements of an acrobot.
 */
const ARRAYS = {
  observations: [Float32Array, 6],
  rewards: [Float32Array, 1],
  terminated: [Uint8Array, 1],
  truncated: [Uint8Array, 1],
  done: [Uint8Array, 1],
  finalObservations: [Float32Array, 6],
  actions: [Uint8Array, 1],
  mask: [Uint8Array, 1],
  torques: [Float32Array, 1],
};

export class Batch extends Environment {
  #settings;
  #addresses;
  /** They end when the module's memory grows. */
  #views = {};
  #results = {};
  /** Whether states have changed since the observations were written. */
  #stale = false;

  constructor(options) {
    super("batch", options, {}, ["count", "autoreset", "ownParams"]);
    this.#open();
  }

  static restore(snapshot) {
    const batch = new this({ count: 1 });
    load(batch, snapshot);
    batch.#open();
    return batch;
  }

  /** Reads what does not change except by `restore`. */
  #open() {
    call(this, "settings");
    const [count, maxSteps, mode, own, task] = integers();
    const [autoreset, ownParams] = [AUTORESETS[mode], own === 1];
    this.#settings = Object.freeze({ count, maxSteps, autoreset, ownParams, task: TASKS[task] });
    this.#addresses = integers().slice(5, 14);
    this.#views = {};
    this.#results = {};
    this.#observe();
    this.#copyResults();
  }

  #view(name) {
    if (!this.#views[name]?.length) {
      const [Type, width] = ARRAYS[name];
      const address = this.#addresses[Object.keys(ARRAYS).indexOf(name)];
      const { buffer } = wasm().memory;
      this.#views[name] = new Type(buffer, address, width * this.#settings.count);
    }
    return this.#views[name];
  }

  #copy(name) {
    // An array that the caller has transferred to another thread has no elements.
    if (this.#results[name]?.length) this.#results[name].set(this.#view(name));
    else this.#results[name] = this.#view(name).slice();
  }

  #copyResults() {
    for (const name of ["observations", "rewards", "terminated", "truncated", "done"]) {
      this.#copy(name);
    }
    if (this.#settings.autoreset === "SameStep") this.#copy("finalObservations");
    this.#stale = false;
  }

  #observe() {
    call(this, "observe");
    this.#copy("observations");
    this.#stale = false;
  }

  #checkIndex(index) {
    if (!Number.isInteger(index) || index < 0 || index >= this.count) {
      throw invalid(`index must be an integer from 0 to ${this.count - 1}`, index);
    }
  }

  get count() {
    return this.#settings.count;
  }

  get settings() {
    return this.#settings;
  }

  get observations() {
    if (this.#stale || !this.#results.observations.length) this.#observe();
    return this.#results.observations;
  }

  reset(seed) {
    return this.resetMasked(new Uint8Array(this.count).fill(1), seed);
  }

  resetMasked(mask, seed) {
    const isFlag = (element) => [true, false, 1, 0].includes(element);
    const flags = elements("mask", mask, this.count, isFlag, "must be true, false, 1 or 0");
    const words = writeSeed(seed);
    const address = addressOf(this);
    this.#view("mask").set(flags);
    wasm().reset(address, words);
    this.#copy("observations");
    this.#stale = false;
    return this.#results.observations;
  }

  sample(seed) {
    call(this, "sample", writeSeed(seed));
    return this.#view("actions").slice();
  }

  step(actions) {
    return this.#step("actions", actions, isAction, ACTION);
  }

  stepTorque(torques) {
    return this.#step("torques", torques, isFinite32, "must be a finite number of N m");
  }

  #step(what, given, isValid, rule) {
    const [Type] = ARRAYS[what];
    const { count } = this.#settings;
    // The module checks elements of this type. `isView` is false for a proxy, which can run code.
    const isRead = ArrayBuffer.isView(given) && given instanceof Type && given.length === count;
    const inputs = isRead ? given : elements(what, given, count, isValid, rule);
    const address = addressOf(this);
    const written = this.#view(what);
    written.set(inputs);
    if (!wasm().step(address, what === "torques")) {
      const index = written.findIndex((each) => !isValid(each));
      throw invalid(`${what}[${index}] ${rule}`, written[index]);
    }
    this.#copyResults();
    return { ...this.#results };
  }

  stateOf(index) {
    this.#checkIndex(index);
    return readState(this, index);
  }

  setStateOf(index, state) {
    this.#checkIndex(index);
    setState(this, state, index);
    this.#stale = true;
  }

  get states() {
    const states = new Float32Array(4 * this.count);
    for (let i = 0; i < this.count; i++) {
      call(this, "read_one", i);
      states.set(numbers().subarray(0, 4), 4 * i);
    }
    return states;
  }

  setStates(states) {
    const rule = "must be a finite number of rad or rad/s";
    const given = elements("states", states, 4 * this.count, isFinite32, rule);
    for (let i = 0; i < this.count; i++) {
      numbers().set(given.slice(4 * i, 4 * i + 4));
      call(this, "set_state", i);
    }
    this.#stale = true;
  }

  elapsedStepsOf(index) {
    this.#checkIndex(index);
    call(this, "read_one", index);
    return integers()[7];
  }

  paramsOf(index) {
    this.#checkIndex(index);
    return readParams(this, index);
  }

  setParamsOf(index, changes) {
    this.#checkIndex(index);
    changeParams(this, changes, index);
  }

  draw(context, index, options) {
    this.#checkIndex(index);
    drawOne(this, index, context, options);
  }
}
