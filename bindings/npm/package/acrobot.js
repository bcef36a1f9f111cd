// One acrobot.

import { draw } from "./draw.js";
import {
  ACTION, Kept, TASKS, addressOf as addressOfKept, indexOf, isAction, isFinite32, keep, orFree,
  readGivenState, readState, seedSample, setState,
} from "./kept.js";
import { load, save } from "./snapshot.js";
import {
  checked, copied, invalid, invalidSingle, numbers, positive, wasm, writeSeed,
} from "./wasm.js";

/** As a private getter it would throw an error that does not name the class. */
const addressOf = (acrobot) => addressOfKept(acrobot, "acrobot");

/** A loop, because `slice` takes half as long again. */
function observation() {
  const [from, to] = [numbers(), new Float32Array(6)];
  for (let i = 0; i < 6; i++) to[i] = from[i];
  return to;
}

/** What a step returns. */
function results(flags) {
  const [terminated, truncated] = [(flags & 1) !== 0, (flags & 2) !== 0];
  return { observation: observation(), reward: numbers()[6], terminated, truncated };
}

export class Acrobot extends Kept {
  /** Bundlers rename classes. */
  static get name() {
    return "Acrobot";
  }

  /** The action or the torque of the last step, for its picture. */
  #action = 1;
  #torque;

  constructor(options = {}) {
    super();
    const given = checked("options", options, ["seed", "params", "maxSteps", "task", "draws"]);
    const { seed, params = {}, maxSteps, task = TASKS[0], draws = {} } = given;
    const index = indexOf("task", TASKS, task);
    const limit = maxSteps === undefined ? 0 : positive("maxSteps", maxSteps);
    keep(this, "acrobot", wasm().acrobot_new(limit, index), 1);
    orFree(this, () => {
      this.setParams(params);
      this.setDraws(draws);
      wasm().acrobot_reset(addressOf(this), writeSeed(seed));
    });
  }

  static restore(snapshot) {
    const copy = copied("the snapshot", snapshot);
    const acrobot = new this();
    orFree(acrobot, () => load("acrobot", addressOf(acrobot), copy, true));
    return acrobot;
  }

  reset(seed) {
    wasm().acrobot_reset(addressOf(this), seed === undefined ? 0 : writeSeed(seed));
    [this.#action, this.#torque] = [1];
    return observation();
  }

  step(action) {
    const address = addressOf(this);
    if (!isAction(action)) throw invalid(`action ${ACTION}`, action);
    const flags = wasm().acrobot_step(address, action);
    this.#action = action;
    this.#torque = undefined;
    return results(flags);
  }

  stepTorque(torque) {
    const address = addressOf(this);
    if (!isFinite32(torque)) throw invalidSingle("torque must be a finite number of N m", torque);
    const flags = wasm().acrobot_step_torque(address, torque);
    this.#torque = torque;
    return results(flags);
  }

  sample(seed) {
    return wasm().acrobot_sample(addressOf(this), seedSample(this, seed));
  }

  get task() {
    return TASKS[wasm().acrobot_task(addressOf(this))];
  }

  get observation() {
    wasm().acrobot_observe(addressOf(this));
    return observation();
  }

  get state() {
    wasm().acrobot_read(addressOf(this));
    return readState();
  }

  set state(state) {
    addressOf(this);
    const given = readGivenState(state);
    setState("acrobot", addressOf(this), given);
  }

  get energy() {
    wasm().acrobot_read(addressOf(this));
    return numbers()[4];
  }

  get tipHeight() {
    wasm().acrobot_read(addressOf(this));
    return numbers()[5];
  }

  get elapsedSteps() {
    return wasm().acrobot_elapsed_steps(addressOf(this)) >>> 0;
  }

  get maxSteps() {
    return wasm().acrobot_max_steps(addressOf(this)) >>> 0;
  }

  snapshot() {
    return save("acrobot", addressOf(this));
  }

  restore(snapshot) {
    addressOf(this);
    const copy = copied("the snapshot", snapshot);
    load("acrobot", addressOf(this), copy, false);
    [this.#action, this.#torque] = [1];
  }

  draw(context, options) {
    addressOf(this);
    const { params, state } = this;
    const torque = this.#torque ?? params.torques[this.#action];
    draw("draw(context, options)", context, state, params, torque, options);
  }
}
