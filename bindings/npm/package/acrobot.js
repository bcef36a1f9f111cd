// One acrobot: in the module, a batch of one.

import { draw } from "./draw.js";
import { ACTION, Environment, TASKS, isAction, load, readState, setState } from "./environment.js";
import { addressOf, call, isFinite32, writeSeed } from "./kept.js";
import { integers, invalid, invalidSingle, numbers, wasm } from "./wasm.js";

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
    super("acrobot", options, { count: 1, autoreset: "Disabled", ownParams: true });
  }

  static restore(snapshot) {
    const acrobot = new this();
    load(acrobot, snapshot);
    return acrobot;
  }

  reset(seed) {
    call(this, "reset", writeSeed(seed));
    [this.#action, this.#torque] = [1];
    return observation();
  }

  step(action) {
    if (!isAction(action)) throw invalid(`action ${ACTION}`, action);
    const flags = wasm().step_action(addressOf(this), action);
    this.#action = action;
    this.#torque = undefined;
    return results(flags);
  }

  stepTorque(torque) {
    if (!isFinite32(torque)) throw invalidSingle("torque must be a finite number of N m", torque);
    const flags = wasm().step_torque(addressOf(this), torque);
    this.#torque = torque;
    return results(flags);
  }

  sample(seed) {
    return call(this, "sample", writeSeed(seed));
  }

  get observation() {
    call(this, "observe");
    return observation();
  }

  get state() {
    return readState(this, 0);
  }

  set state(state) {
    setState(this, state, 0);
  }

  get energy() {
    call(this, "read_one", 0);
    return numbers()[4];
  }

  get tipHeight() {
    call(this, "read_one", 0);
    return numbers()[5];
  }

  get elapsedSteps() {
    call(this, "read_one", 0);
    return integers()[6];
  }

  get maxSteps() {
    call(this, "settings");
    return integers()[1];
  }

  get task() {
    call(this, "settings");
    return TASKS[integers()[4]];
  }

  draw(context, options) {
    const { params, state } = this;
    const torque = this.#torque ?? params.torques[this.#action];
    draw(context, state, params, torque, options);
  }
}
