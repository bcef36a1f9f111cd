// Many acrobots.

import { draw } from "./draw.js";
import {
  ACTION, NONE, isAction, readDraws, readOptions, sample, save,
} from "./environment.js";
import {
  Kept, accept, addressOf, call, elements, hold, indexOf, pack, padded, paramsOf, read, readAll,
  readChanges, resetOptions, scratch, unpack, wasm,
} from "./kept.js";
import { SIZES, STRUCTS, TASKS } from "./layout.js";
import { copied, invalid, isFinite32, positive, randomSeed } from "./wasm.js";

const {
  acrobot_batch_results_t: RESULTS, acrobot_batch_settings_t: SETTINGS, acrobot_params_t: PARAMS,
  acrobot_state_t: STATE,
} = STRUCTS;

const AUTORESETS = ["NextStep", "SameStep", "Disabled"];

/** The arrays in the module: type, and number of elements of an acrobot. */
const ARRAYS = {
  observations: [Float32Array, 6],
  rewards: [Float32Array, 1],
  terminated: [Uint8Array, 1],
  truncated: [Uint8Array, 1],
  done: [Uint8Array, 1],
  finalObservations: [Float32Array, 6],
  actions: [Uint8Array, 1],
  torques: [Float32Array, 1],
};

export function checkIndex({ count }, index) {
  if (!Number.isInteger(index) || index < 0 || index >= count) {
    throw invalid(`index must be an integer from 0 to ${count - 1}`, index);
  }
}

export class Batch extends Kept {
  static kind = "batch";

  #settings;
  /** Where arrays are after the batch, in bytes. */
  #places = {};
  /** They end when the module's memory grows. */
  #views = {};
  #results = {};
  /** Whether states have changed since the observations were written. */
  #stale = false;

  constructor(options) {
    const given = readOptions(options, ["count", "autoreset", "ownParams"]);
    const { seed, params, maxSteps, task, draws } = given;
    const { count, autoreset = AUTORESETS[0], ownParams = draws !== undefined } = given;
    positive("count", count);
    const mode = indexOf("autoreset", AUTORESETS, autoreset);
    if (typeof ownParams !== "boolean") {
      throw invalid("ownParams must be true or false", ownParams, []);
    }
    super();
    this.#make(count, ownParams, (size, batch) => {
      call({}, "acrobot_batch_init", this, size, count, task, ownParams, 0n, batch);
      call({}, "acrobot_batch_set_autoreset", this, mode);
      if (maxSteps !== undefined) call({}, "acrobot_batch_set_max_steps", this, maxSteps);
      call(params, "acrobot_batch_set_all_params", this, this.#changed(0, params));
      if (draws) call(draws.given, "acrobot_batch_set_draws", this, draws.words);
      call({}, "acrobot_batch_reset_with", this, resetOptions(seed));
    });
  }

  static restore(snapshot) {
    const bytes = copied("the snapshot", snapshot);
    const { length } = bytes;
    const [count, own] = [new Uint32Array(1), new Uint8Array(1)];
    call(bytes, "acrobot_batch_saved_count", bytes, length, count, own);
    const batch = new this({ count: 1 });
    batch.#make(count[0], own[0] !== 0, (size, to) =>
      call(bytes, "acrobot_batch_load", batch, size, bytes, length, to),
    );
    const { done } = batch.#view();
    done.forEach((_, i) => {
      done[i] = read("acrobot_batch_is_done", addressOf(batch), i).flags[0];
    });
    return batch;
  }

  /** Makes memory for the batch, random actions and arrays. `init` makes the batch. */
  #make(count, ownParams, init) {
    const size = wasm().acrobot_batch_size(count, ownParams) >>> 0;
    let end = padded(size);
    const place = (name, bytes) => {
      this.#places[name] = end;
      end += padded(bytes);
    };
    place("space", SIZES.actionSpace);
    place("pointers", 4 * Object.keys(RESULTS).length);
    for (const [name, [Type, width]] of Object.entries(ARRAYS)) {
      place(name, Type.BYTES_PER_ELEMENT * width * count);
    }
    const make = () => {
      init(size, new Uint32Array(1));
      this.#open();
    };
    hold(this, end, make, "acrobots", count);
  }

  /** Reads what does not change, and writes the addresses of the results. */
  #open() {
    const { integers } = read("acrobot_batch_settings", addressOf(this));
    const { count, task, ownParams, autoreset, maxSteps } = unpack(integers, SETTINGS);
    this.#settings = Object.freeze({
      count,
      maxSteps,
      autoreset: AUTORESETS[autoreset],
      ownParams: (ownParams & 1) !== 0, // one byte
      task: TASKS[task],
    });
    [this.#views, this.#results] = [{}, {}];
    const pointers = new Uint32Array(wasm().memory.buffer, addressOf(this) + this.#places.pointers);
    for (const [name, [word]] of Object.entries(RESULTS)) {
      const isNull = name === "finalObservations" && this.#settings.autoreset !== "SameStep";
      pointers[word] = isNull ? 0 : addressOf(this) + this.#places[name];
    }
    this.#view().actions.fill(NONE);
    this.sample(randomSeed());
    this.#observe();
    this.#copyResults();
  }

  /** The arrays in the module. Words have the flags of four acrobots each. */
  #view() {
    if (!this.#views.rewards?.length) {
      const { buffer } = wasm().memory;
      const view = (name, Type, length) =>
        new Type(buffer, addressOf(this) + this.#places[name], length);
      const { count } = this.#settings;
      for (const [name, [Type, width]] of Object.entries(ARRAYS)) {
        this.#views[name] = view(name, Type, width * count);
      }
      this.#views.words = ["done", "terminated", "truncated"].map((name) =>
        view(name, Uint32Array, Math.ceil(count / 4)),
      );
    }
    return this.#views;
  }

  #copy(name, view = this.#view()[name]) {
    // An array that the caller has transferred to another thread has no elements.
    if (this.#results[name]?.length) this.#results[name].set(view);
    else this.#results[name] = view.slice();
  }

  #copyResults(views = this.#view()) {
    for (const name of ["observations", "rewards", "terminated", "truncated", "done"]) {
      this.#copy(name, views[name]);
    }
    if (this.#settings.autoreset === "SameStep") this.#copy("finalObservations");
    this.#stale = false;
  }

  #observe() {
    const { observations } = this.#view();
    accept(wasm().acrobot_batch_observe(addressOf(this), observations.byteOffset, this.count));
    this.#copy("observations");
    this.#stale = false;
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
    const given = elements("mask", mask, this.count, isFlag, "must be true, false, 1 or 0");
    const flags = Uint8Array.from(given);
    call({}, "acrobot_batch_reset_masked", this, flags, this.count, resetOptions(seed));
    const { actions, torques, done } = this.#view();
    flags.forEach((flag, i) => {
      if (flag) [actions[i], torques[i], done[i]] = [NONE, 0, 0];
    });
    this.#observe();
    return this.#results.observations;
  }

  sample(seed) {
    const [space, actions] = [addressOf(this) + this.#places.space, new Uint8Array(this.count)];
    return sample(space, seed, "acrobot_action_space_sample_each", actions, this.count);
  }

  step(actions) {
    return this.#step("actions", actions, isAction, ACTION);
  }

  stepTorque(torques) {
    return this.#step("torques", torques, isFinite32, "must be a finite number of N m");
  }

  #step(what, given, isValid, rule) {
    const [Type] = ARRAYS[what];
    const { count, autoreset } = this.#settings;
    // The module checks elements of this type. `isView` is false for a proxy, which can run code.
    const isRead = ArrayBuffer.isView(given) && given instanceof Type && given.length === count;
    const inputs = isRead ? given : elements(what, given, count, isValid, rule);
    const address = addressOf(this);
    const views = this.#view();
    const written = views[what];
    written.set(inputs);
    const isTorque = what === "torques";
    const step = isTorque ? wasm().acrobot_batch_step_torque : wasm().acrobot_batch_step;
    if (step(address, written.byteOffset, address + this.#places.pointers, count) !== 0) {
      const index = written.findIndex((each) => !isValid(each));
      throw invalid(`${what}[${index}] ${rule}`, written[index]);
    }
    if (isTorque) views.actions.fill(NONE);
    const [done, terminated, truncated] = views.words;
    const lasting = autoreset === "Disabled" ? ~0 : 0;
    for (let i = 0; i < done.length; i++) {
      done[i] = (done[i] & lasting) | terminated[i] | truncated[i];
    }
    this.#copyResults(views);
    return { ...this.#results };
  }

  stateOf(index) {
    checkIndex(this, index);
    return unpack(read("acrobot_batch_state", addressOf(this), index).numbers, STATE);
  }

  setStateOf(index, state) {
    checkIndex(this, index);
    const [given, words] = readAll("state", state, STATE);
    call(given, "acrobot_batch_set_state", this, index, words);
    this.#stale = true;
  }

  get states() {
    const states = new Float32Array(4 * this.count);
    for (let i = 0; i < this.count; i++) {
      const { numbers } = read("acrobot_batch_state", addressOf(this), i);
      states.set(numbers.subarray(0, 4), 4 * i);
    }
    return states;
  }

  setStates(states) {
    const rule = "must be a finite number of rad or rad/s";
    const given = elements("states", states, 4 * this.count, isFinite32, rule);
    const [address, { numbers, result }] = [addressOf(this), scratch()];
    for (let i = 0; i < this.count; i++) {
      numbers.set(given.slice(4 * i, 4 * i + 4));
      accept(wasm().acrobot_batch_set_state(address, i, result, 0));
    }
    this.#stale = true;
  }

  elapsedStepsOf(index) {
    checkIndex(this, index);
    return read("acrobot_batch_elapsed_steps", addressOf(this), index).integers[0];
  }

  get params() {
    return this.paramsOf(0);
  }

  paramsOf(index) {
    checkIndex(this, index);
    return unpack(paramsOf("acrobot_batch_params", this, index), PARAMS);
  }

  /** The words of the parameters of an acrobot, of which some change. */
  #changed(index, changes) {
    return pack(paramsOf("acrobot_batch_params", this, index), changes, PARAMS);
  }

  setParamsOf(index, changes) {
    checkIndex(this, index);
    this.#setParams([index], readChanges(changes));
  }

  setParams(changes) {
    const given = readChanges(changes);
    if (this.#settings.ownParams) this.#setParams([...Array(this.count).keys()], given);
    else call(given, "acrobot_batch_set_all_params", this, this.#changed(0, given));
  }

  /** Changes acrobots with own parameters: all, or none if one rejects the changes. */
  #setParams(indices, changes) {
    const before = indices.map((index) => this.#changed(index, {}));
    const set = (given, index, words) =>
      call(given, "acrobot_batch_set_params", this, index, words);
    try {
      for (const index of indices) set(changes, index, this.#changed(index, changes));
    } catch (error) {
      before.forEach((words, i) => set({}, indices[i], words));
      throw error;
    }
  }

  setDraws(draws) {
    const { given, words } = readDraws(draws);
    call(given, "acrobot_batch_set_draws", this, words);
  }

  snapshot() {
    return save("acrobot_batch_save", this, wasm().acrobot_batch_snapshot_size(this.count) >>> 0);
  }

  draw(context, index, options) {
    const [params, state] = [this.paramsOf(index), this.stateOf(index)];
    const { actions, torques } = this.#view();
    draw(context, state, params, params.torques[actions[index]] ?? torques[index], options);
  }
}
