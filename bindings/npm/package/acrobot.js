// One acrobot.

import { draw } from "./draw.js";
import {
  ACTION, Kept, addressOf as addressOfKept, drawParams, isAction, isFinite32, keep, orFree,
  readState, seedSample, writeState,
} from "./kept.js";
import { begins, head, header, seal, taskIndex, taskOf, unseal } from "./snapshot.js";
import {
  accept, bytes, checked, invalid, invalidSingle, numbers, positive, wasm, writeSeed,
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
  #task;

  constructor(options = {}) {
    super();
    const names = ["seed", "params", "maxSteps", "task", "paramsRange"];
    const given = checked("options", options, names);
    const { seed, params = {}, maxSteps, task = "acrobot", paramsRange = {} } = given;
    const index = taskIndex(task);
    const limit = maxSteps === undefined ? 0 : positive("maxSteps", maxSteps);
    this.#task = task;
    keep(this, "acrobot", wasm().acrobot_new(limit, index), 1);
    orFree(this, () => {
      this.setParams(params);
      this.setParamsRange(paramsRange);
      wasm().acrobot_reset(addressOf(this), writeSeed(seed));
      drawParams(this, 0);
    });
  }

  static restore(snapshot) {
    const acrobot = new this({ task: taskOf("acrobot", unseal(snapshot)) });
    orFree(acrobot, () => acrobot.restore(snapshot));
    return acrobot;
  }

  reset(seed) {
    wasm().acrobot_reset(addressOf(this), seed === undefined ? 0 : writeSeed(seed));
    [this.#action, this.#torque] = [1];
    const first = observation();
    drawParams(this, 0);
    return first;
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
    addressOf(this);
    return this.#task;
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
    const valueOf = writeState(state);
    accept(wasm().acrobot_set_state(addressOf(this)), valueOf);
  }

  get energy() {
    wasm().acrobot_read(addressOf(this));
    return numbers()[4];
  }

  get tipHeight() {
    wasm().acrobot_read(addressOf(this));
    return numbers()[5];
  }

  get elapsed() {
    return wasm().acrobot_elapsed(addressOf(this)) >>> 0;
  }

  get maxSteps() {
    return wasm().acrobot_max_steps(addressOf(this)) >>> 0;
  }

  snapshot() {
    const length = wasm().acrobot_save(addressOf(this));
    return seal([head("acrobot", this.#task), bytes().subarray(0, length)]);
  }

  restore(snapshot) {
    addressOf(this);
    const content = unseal(snapshot);
    const [address, own] = [addressOf(this), head("acrobot", this.#task)];
    const rule = `the snapshot must be a valid one of ${header(Uint8Array.from(own))}`;
    const reject = (got) => {
      throw new RangeError(`${rule}, got ${got}`);
    };
    if (content.length > 256) reject(`${content.length} bytes`);
    const rest = content.subarray(own.length);
    bytes().set(rest);
    const valid = begins(content, own) && wasm().acrobot_load(address, rest.length);
    if (!valid) reject(header(content));
    [this.#action, this.#torque] = [1];
  }

  draw(context, options) {
    addressOf(this);
    const { params, state } = this;
    const torque = this.#torque ?? params.torques[this.#action];
    draw("draw(context, options)", context, state, params, torque, options);
  }
}
