// One acrobot.

import { draw } from "./draw.js";
import {
  ACTION, Environment, TASKS, addressOf, allocated, call, indexOf, isAction, isFinite32, orFree,
  readState, setState, writeSeed,
} from "./kept.js";
import { load, save } from "./snapshot.js";
import {
  checked, integers, invalid, invalidSingle, numbers, positive, randomSeed, wasm,
} from "./wasm.js";

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

export class Acrobot extends Environment {
  /** The action or the torque of the last step, for its picture. */
  #action = 1;
  #torque;

  constructor(options = {}) {
    const given = checked("options", options, ["seed", "params", "maxSteps", "task", "draws"]);
    const { seed = randomSeed(), params = {}, maxSteps, task = TASKS[0], draws = {} } = given;
    const index = indexOf("task", TASKS, task);
    const limit = maxSteps === undefined ? 0 : positive("maxSteps", maxSteps);
    super("acrobot", allocated("acrobots", 1, wasm().acrobot_new(limit, index)));
    orFree(this, () => {
      this.setParams(params);
      this.setDraws(draws);
      this.reset(seed);
      this.sample(randomSeed());
    });
  }

  static restore(snapshot) {
    const acrobot = new this();
    orFree(acrobot, () => load(acrobot, snapshot, true));
    return acrobot;
  }

  reset(seed) {
    call(this, "reset", writeSeed(seed));
    [this.#action, this.#torque] = [1];
    return observation();
  }

  step(action) {
    if (!isAction(action)) throw invalid(`action ${ACTION}`, action);
    const flags = wasm().acrobot_step(addressOf(this), action);
    this.#action = action;
    this.#torque = undefined;
    return results(flags);
  }

  stepTorque(torque) {
    if (!isFinite32(torque)) throw invalidSingle("torque must be a finite number of N m", torque);
    const flags = wasm().acrobot_step_torque(addressOf(this), torque);
    this.#torque = torque;
    return results(flags);
  }

  sample(seed) {
    return call(this, "sample", writeSeed(seed));
  }

  get observation() {
    wasm().acrobot_observe(addressOf(this));
    return observation();
  }

  get state() {
    call(this, "read");
    return readState();
  }

  set state(state) {
    setState(this, state);
  }

  get energy() {
    call(this, "read");
    return numbers()[4];
  }

  get tipHeight() {
    call(this, "read");
    return numbers()[5];
  }

  get elapsedSteps() {
    call(this, "read");
    return integers()[6];
  }

  get maxSteps() {
    call(this, "read");
    return integers()[7];
  }

  get task() {
    call(this, "read");
    return TASKS[integers()[8]];
  }

  snapshot() {
    return save(this);
  }

  restore(snapshot) {
    load(this, snapshot, false);
    [this.#action, this.#torque] = [1];
  }

  draw(context, options) {
    const { params, state } = this;
    const torque = this.#torque ?? params.torques[this.#action];
    draw(context, state, params, torque, options);
  }
}
