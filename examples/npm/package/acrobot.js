// One acrobot.

import { draw } from "./draw.js";
import { ACTION, Kept, NUMBER, SHOWN, isAction, readState, sample, writeState } from "./kept.js";
import { header, seal, unseal } from "./snapshot.js";
import { accept, bytes, checked, invalid, numbers, positive, wasm, writeSeed } from "./wasm.js";

/** A loop, because `slice` takes half as long again. */
function observation() {
  const [from, to] = [numbers(), new Float32Array(6)];
  for (let i = 0; i < 6; i++) to[i] = from[i];
  return to;
}

export class Acrobot extends Kept {
  /** The action of the last step, for its picture. */
  #action = 1;

  constructor(options = {}) {
    const { seed, params = {}, maxSteps = 500 } = checked("options", options, ["seed", "params", "maxSteps"]);
    super("acrobot", wasm().acrobot_new(positive("maxSteps", maxSteps)), 1);
    try {
      this.setParams(params);
      wasm().acrobot_reset(this[NUMBER], writeSeed(seed));
    } catch (error) {
      this.free();
      throw error;
    }
  }

  static restore(snapshot) {
    const acrobot = new this();
    try {
      acrobot.restore(snapshot);
    } catch (error) {
      acrobot.free();
      throw error;
    }
    return acrobot;
  }

  reset(seed) {
    wasm().acrobot_reset(this[NUMBER], seed === undefined ? 0 : writeSeed(seed));
    this.#action = 1;
    return observation();
  }

  step(action) {
    if (!isAction(action)) throw invalid(`action ${ACTION}`, action);
    const flags = wasm().acrobot_step(this[NUMBER], action);
    this.#action = action;
    const terminated = (flags & 1) !== 0;
    return { observation: observation(), reward: terminated ? 0 : -1, terminated, truncated: (flags & 2) !== 0 };
  }

  sample() {
    return sample();
  }

  get observation() {
    wasm().acrobot_observe(this[NUMBER]);
    return observation();
  }

  get state() {
    wasm().acrobot_read(this[NUMBER]);
    return readState();
  }

  set state(state) {
    const valueOf = writeState(state);
    accept(wasm().acrobot_set_state(this[NUMBER]), valueOf);
  }

  get energy() {
    wasm().acrobot_read(this[NUMBER]);
    return numbers()[4];
  }

  get tipHeight() {
    wasm().acrobot_read(this[NUMBER]);
    return numbers()[5];
  }

  get elapsed() {
    return wasm().acrobot_elapsed(this[NUMBER]) >>> 0;
  }

  get maxSteps() {
    return wasm().acrobot_max_steps(this[NUMBER]) >>> 0;
  }

  snapshot() {
    const length = wasm().acrobot_save(this[NUMBER]);
    return seal([bytes().subarray(0, length)]);
  }

  restore(snapshot) {
    const content = unseal(snapshot);
    wasm().acrobot_save(this[NUMBER]);
    const rule = `the snapshot must be a valid one of ${header(bytes())}`;
    if (content.length > 256) throw new RangeError(`${rule}, got ${content.length} bytes`);
    bytes().set(content);
    if (!wasm().acrobot_load(this[NUMBER], content.length)) throw new RangeError(`${rule}, got ${header(content)}`);
    this.#action = 1;
  }

  draw(context, options) {
    const { params } = this;
    draw("draw(context, options)", context, this.state, params, params.torques[this.#action], options);
  }

  get [SHOWN]() {
    const { state, elapsed, maxSteps, params } = this;
    return { state, elapsed, maxSteps, params };
  }
}
