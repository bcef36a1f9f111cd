// One acrobot: in the module, a batch of one.

import {
  ACTION, Environment, TASKS, drawOne, isAction, load, readState, setState,
} from "./environment.js";
import { addressOf, call, writeSeed } from "./kept.js";
import { integers, invalid, invalidSingle, isFinite32, numbers, wasm } from "./wasm.js";

/** A loop, because `slice` takes half as long again. */
function observation() {
  const [from, to] = [numbers(), new Float32Array(6)];
  for (let i = 0; i < 6; i++) to[i] = from[i];
  return to;
}

function results(flags) {
  const [terminated, truncated] = [(flags & 1) !== 0, (flags & 2) !== 0];
  return { observation: observation(), reward: numbers()[6], terminated, truncated };
}

export class Acrobot extends Environment {
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
    return observation();
  }

  step(action) {
    if (!isAction(action)) throw invalid(`action ${ACTION}`, action);
    return results(wasm().step_action(addressOf(this), action));
  }

  stepTorque(torque) {
    if (!isFinite32(torque)) throw invalidSingle("torque must be a finite number of N m", torque);
    return results(wasm().step_torque(addressOf(this), torque));
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
    return integers()[7];
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
    drawOne(this, 0, context, options);
  }
}
