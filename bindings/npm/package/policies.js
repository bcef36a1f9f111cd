// Policies, and a learner in a separate module. policies.d.ts describes the interface.

import {
  Opaque, checked, copied, decoded, instantiate, invalid, invalidSingle, isFinite32, positive,
  randomSeed, seedWords, tagOf,
} from "./wasm.js";

export { moduleBytes, setModule } from "./wasm.js";

/** Numbers of an object, finite in single precision. `what` names the object in an error. */
const finite = (what, object, names) =>
  names.map((name) => {
    const number = object?.[name];
    if (!isFinite32(number)) throw invalidSingle(`${what}.${name} must be a finite number`, number);
    return number;
  });

export function bangBang(acrobot) {
  const [dtheta1] = finite("acrobot.state", acrobot?.state, ["dtheta1"]);
  return dtheta1 > 0 ? 0 : 2;
}

export function uprightEnergy(params) {
  const names = ["gravity", "mass1", "mass2", "length1", "centerOfMass1", "centerOfMass2"];
  const [g, m1, m2, l1, lc1, lc2] = finite("params", params, names);
  return g * (m1 * lc1 + m2 * (l1 + lc2));
}

export function energyLaw(acrobot) {
  const [energy] = finite("acrobot", acrobot, ["energy"]);
  const [dtheta1] = finite("acrobot.state", acrobot.state, ["dtheta1"]);
  const torque = (energy - uprightEnergy(acrobot.params)) * dtheta1;
  return 1 + Math.max(-1, Math.min(1, Math.round(torque)));
}

/** The size of the module's buffer in bytes. */
const BUFFER = 1 << 19;

/** An instance of the module. */
class Instance {
  exports = instantiate();

  /** A view of the buffer. It ends when the module's memory grows. */
  bytes(length) {
    return new Uint8Array(this.exports.memory.buffer, this.exports.buffer(), length);
  }

  /** Calls `load` with the length of a file in the buffer. */
  load(what, file, load) {
    const copy = copied(what, file);
    const { length } = copy;
    const rule = `${what} must have at most ${BUFFER} bytes`;
    if (length > BUFFER) throw new RangeError(`${rule}, got ${length}`);
    this.bytes(length).set(copy);
    const reason = load(length);
    if (reason !== 0) throw new RangeError(decoded(this.bytes(reason)));
  }
}

export class Learner extends Opaque {
  #module;
  #training;

  constructor(options = {}) {
    super();
    const given = checked("options", options, ["episodes", "seed", "acrobot"]);
    const { episodes = 2000, seed = randomSeed(), acrobot } = given;
    positive("episodes", episodes);
    const words = seedWords(seed);
    const params = Object.values(acrobot?.params ?? {}).flat();
    const numbers = params.map((value) => (value === "book" ? 0 : value === "nips" ? 1 : value));
    const data = [Uint32Array.from(words), Float32Array.from(numbers)];
    const bytes = data.flatMap(({ buffer }) => [...new Uint8Array(buffer)]);
    this.#module = new Instance();
    this.#module.bytes(bytes.length).set(bytes);
    this.#training = this.#module.exports.begin(episodes, words.length, numbers.length);
    // Only the parameters of an acrobot are all there, and in the order of the module.
    const isAcrobot = acrobot === undefined || tagOf(acrobot) === "[object Acrobot]";
    if (this.#training === 0 || !isAcrobot) {
      throw invalid("options.acrobot must be an Acrobot without friction and rotor", acrobot, []);
    }
  }

  train() {
    return this.#module.exports.train(this.#training);
  }

  act(acrobot) {
    const names = ["theta1", "theta2", "dtheta1", "dtheta2"];
    const state = finite("acrobot.state", acrobot?.state, names);
    return this.#module.exports.act(this.#training, ...state);
  }

  save() {
    return this.#module.bytes(this.#module.exports.save(this.#training)).slice();
  }

  load(weights) {
    const { load, weights_len: size } = this.#module.exports;
    this.#module.load("weights", weights, (length) => {
      if (length === size()) return load(this.#training, length);
      throw new RangeError(`weights must have ${size()} bytes, got ${length}`);
    });
  }
}

export class Perceptron extends Opaque {
  #module = new Instance();

  constructor(file) {
    super();
    this.#module.load("the policy", file, this.#module.exports.load_perceptron);
  }

  act(acrobot) {
    const numbers = finite("acrobot.observation", acrobot?.observation, [0, 1, 2, 3, 4, 5]);
    return this.#module.exports.act_perceptron(...numbers);
  }
}
