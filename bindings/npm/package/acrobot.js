// One acrobot.

import { draw } from "./draw.js";
import {
  ACTION, Kept, SHOWN, addressOf, isAction, keep, orFree, readState, sample, writeState,
} from "./kept.js";
import { header, seal, unseal } from "./snapshot.js";
import { accept, bytes, checked, invalid, numbers, positive, wasm, writeSeed } from "./wasm.js";

/** A loop, because `slice` takes half as long again. */
function observation() {
  const [from, to] = [numbers(), new Float32Array(6)];
  for (let i = 0; i < 6; i++) to[i] = from[i];
  return to;
}

export class Acrobot extends Kept {
  /** Bundlers rename classes. */
  static get name() {
    return "Acrobot";
  }

  /** The action of the last step, for its picture. */
  #action = 1;

  constructor(options = {}) {
    super();
    const given = checked("options", options, ["seed", "params", "maxSteps"]);
    const { seed, params = {}, maxSteps = 500 } = given;
    keep(this, "acrobot", wasm().acrobot_new(positive("maxSteps", maxSteps)), 1);
    orFree(this, () => {
      this.setParams(params);
      wasm().acrobot_reset(this.#address, writeSeed(seed));
    });
  }

  get #address() {
    return addressOf(this);
  }

  static restore(snapshot) {
    const acrobot = new this();
    orFree(acrobot, () => acrobot.restore(snapshot));
    return acrobot;
  }

  reset(seed) {
    wasm().acrobot_reset(this.#address, seed === undefined ? 0 : writeSeed(seed));
    this.#action = 1;
    return observation();
  }

  step(action) {
    if (!isAction(action)) throw invalid(`action ${ACTION}`, action);
    const flags = wasm().acrobot_step(this.#address, action);
    this.#action = action;
    const [terminated, truncated] = [(flags & 1) !== 0, (flags & 2) !== 0];
    return { observation: observation(), reward: terminated ? 0 : -1, terminated, truncated };
  }

  sample() {
    return sample();
  }

  get observation() {
    wasm().acrobot_observe(this.#address);
    return observation();
  }

  get state() {
    wasm().acrobot_read(this.#address);
    return readState();
  }

  set state(state) {
    const valueOf = writeState(state);
    accept(wasm().acrobot_set_state(this.#address), valueOf);
  }

  get energy() {
    wasm().acrobot_read(this.#address);
    return numbers()[4];
  }

  get tipHeight() {
    wasm().acrobot_read(this.#address);
    return numbers()[5];
  }

  get elapsed() {
    return wasm().acrobot_elapsed(this.#address) >>> 0;
  }

  get maxSteps() {
    return wasm().acrobot_max_steps(this.#address) >>> 0;
  }

  snapshot() {
    const length = wasm().acrobot_save(this.#address);
    return seal([bytes().subarray(0, length)]);
  }

  restore(snapshot) {
    const content = unseal(snapshot);
    wasm().acrobot_save(this.#address);
    const rule = `the snapshot must be a valid one of ${header(bytes())}`;
    const reject = (got) => {
      throw new RangeError(`${rule}, got ${got}`);
    };
    if (content.length > 256) reject(`${content.length} bytes`);
    bytes().set(content);
    if (!wasm().acrobot_load(this.#address, content.length)) reject(header(content));
    this.#action = 1;
  }

  draw(context, options) {
    const { params, state } = this;
    draw("draw(context, options)", context, state, params, params.torques[this.#action], options);
  }

  get [SHOWN]() {
    const { state, elapsed, maxSteps, params } = this;
    return { state, elapsed, maxSteps, params };
  }
}
