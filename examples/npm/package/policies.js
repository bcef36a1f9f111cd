// Policies, and a learner in a separate module. policies.d.ts describes the interface.

import { checked, instantiate, invalid, positive, seedWords } from "./wasm.js";

export const bangBang = ({ state }) => (state.dtheta1 > 0 ? 0 : 2);

export const uprightEnergy = ({ gravity, mass1, mass2, length1, centerOfMass1, centerOfMass2 }) =>
  gravity * (mass1 * centerOfMass1 + mass2 * (length1 + centerOfMass2));

export function energyLaw({ state, energy, params }) {
  const missing = uprightEnergy(params) - energy;
  return 1 + Math.max(-1, Math.min(1, Math.round(-missing * state.dtheta1)));
}

/** The size of the module's buffer in bytes. */
const BUFFER = 1 << 17;

export class Learner {
  #exports;

  constructor(options = {}) {
    const { episodes = 2000, seed } = checked("options", options, ["episodes", "seed"]);
    positive("episodes", episodes);
    const words = seedWords(seed);
    this.#exports = instantiate();
    this.#bytes(4 * words.length).set(new Uint8Array(Uint32Array.from(words).buffer));
    this.#exports.begin(episodes, words.length);
  }

  /** A view of the buffer. It ends when the module's memory grows. */
  #bytes(length) {
    return new Uint8Array(this.#exports.memory.buffer, this.#exports.buffer(), length);
  }

  train() {
    return this.#exports.train();
  }

  act({ state }) {
    const numbers = ["theta1", "theta2", "dtheta1", "dtheta2"].map((name) => state?.[name]);
    if (!numbers.every(Number.isFinite)) throw invalid("act's argument must have a state of four finite numbers", state);
    return this.#exports.act(...numbers);
  }

  save() {
    return this.#bytes(this.#exports.save()).slice();
  }

  load(weights) {
    if (!(weights instanceof Uint8Array)) throw invalid("weights must be a Uint8Array", weights);
    const { length } = weights;
    if (length > BUFFER) throw new RangeError(`weights must have at most ${BUFFER} bytes, got ${length}`);
    this.#bytes(length).set(weights);
    const reason = this.#exports.load(length);
    if (reason !== 0) throw new RangeError(new TextDecoder().decode(this.#bytes(reason)));
  }
}
