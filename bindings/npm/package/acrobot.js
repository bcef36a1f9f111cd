// One acrobot.

import { draw } from "./draw.js";
import {
  ACTION, NONE, isAction, readDraws, readOptions, sample, save,
} from "./environment.js";
import {
  Kept, accept, addressOf, bytesAt, call, hold, orFree, pack, paramsOf, read, readAll, readChanges,
  resetOptions, scratch, unpack, wasm,
} from "./kept.js";
import { SIZES, STRUCTS, TASKS } from "./layout.js";
import { copied, invalid, invalidSingle, isFinite32, randomSeed } from "./wasm.js";

const { acrobot_params_t: PARAMS, acrobot_state_t: STATE, acrobot_step_t: STEP } = STRUCTS;
const [[REWARD], [FLAGS]] = [STEP.reward, STEP.flags];

/** A copy of an observation, by a loop, because `slice` takes half as long again. */
function observationOf(numbers) {
  const observation = new Float32Array(6);
  for (let i = 0; i < 6; i++) observation[i] = numbers[i];
  return observation;
}

/** Reads an acrobot_step_t. */
function resultsOf({ numbers, flags }) {
  const [terminated, truncated] = [flags[4 * FLAGS] !== 0, flags[4 * FLAGS + 1] !== 0];
  return { observation: observationOf(numbers), reward: numbers[REWARD], terminated, truncated };
}

export class Acrobot extends Kept {
  static kind = "acrobot";

  /** The last action, or `NONE` and the last torque, for a picture. */
  #action = NONE;
  #torque = 0;
  #draws;

  constructor(options = {}) {
    const { seed, params, maxSteps, task, draws } = readOptions(options);
    super();
    hold(this, SIZES.acrobot + SIZES.actionSpace, () => {
      call({}, "acrobot_init_task", this, task, 0n);
      if (maxSteps !== undefined) call({}, "acrobot_set_max_steps", this, maxSteps);
      this.#change(params, draws);
      this.reset(seed);
      this.sample(randomSeed());
    });
  }

  static restore(snapshot) {
    const bytes = copied("the snapshot", snapshot);
    const acrobot = new this();
    orFree(acrobot, () => call(bytes, "acrobot_load", acrobot, bytes, bytes.length));
    return acrobot;
  }

  reset(seed) {
    call({}, "acrobot_reset_with", this, resetOptions(seed), 0);
    if (this.#draws) call({}, "acrobot_draw_params", this, this.#draws.words);
    [this.#action, this.#torque] = [NONE, 0];
    return this.observation;
  }

  step(action) {
    if (!isAction(action)) throw invalid(`action ${ACTION}`, action);
    const [address, views] = [addressOf(this), scratch()];
    accept(wasm().acrobot_step(address, action, views.result));
    this.#action = action;
    return resultsOf(views);
  }

  stepTorque(torque) {
    if (!isFinite32(torque)) throw invalidSingle("torque must be a finite number of N m", torque);
    const [address, views] = [addressOf(this), scratch()];
    accept(wasm().acrobot_step_torque(address, torque, views.result, 0));
    [this.#action, this.#torque] = [NONE, torque];
    return resultsOf(views);
  }

  sample(seed) {
    const space = addressOf(this) + SIZES.acrobot;
    return sample(space, seed, "acrobot_action_space_sample", new Uint8Array(1))[0];
  }

  /** A copy tries parameters and draws, because a reset must not reject what it draws. */
  #change(params, draws) {
    const words = pack(paramsOf("acrobot_params", this), params, PARAMS);
    const copy = bytesAt(addressOf(this), SIZES.acrobot).slice();
    call(params, "acrobot_set_params", copy, words);
    if (draws) call(draws.given, "acrobot_draw_params", copy, draws.words);
    call(params, "acrobot_set_params", this, words);
    this.#draws = draws;
  }

  get params() {
    return unpack(paramsOf("acrobot_params", this), PARAMS);
  }

  setParams(changes) {
    this.#change(readChanges(changes), this.#draws);
  }

  setDraws(draws) {
    this.#change({}, readDraws(draws));
  }

  get observation() {
    const [address, views] = [addressOf(this), scratch()];
    accept(wasm().acrobot_observe(address, views.result));
    return observationOf(views.numbers);
  }

  get state() {
    return unpack(read("acrobot_state", addressOf(this)).numbers, STATE);
  }

  set state(state) {
    const [given, words] = readAll("state", state, STATE);
    call(given, "acrobot_set_state", this, words);
  }

  get energy() {
    return read("acrobot_energy", addressOf(this)).numbers[0];
  }

  get tipHeight() {
    return read("acrobot_tip_height", addressOf(this)).numbers[0];
  }

  get elapsedSteps() {
    return read("acrobot_elapsed_steps", addressOf(this)).integers[0];
  }

  get maxSteps() {
    return read("acrobot_max_steps", addressOf(this)).integers[0];
  }

  get task() {
    return TASKS[read("acrobot_task", addressOf(this)).integers[0]];
  }

  snapshot() {
    return save("acrobot_save", this, SIZES.snapshot);
  }

  draw(context, options) {
    const { params, state } = this;
    draw(context, state, params, params.torques[this.#action] ?? this.#torque, options);
  }
}
