// Wraps the learner's WebAssembly module, whose functions take numbers, in methods that take JavaScript values. The page has one
// instance, and each worker has its own.

/** The size of the module's buffer in bytes. */
const BUFFER = 1 << 17;

export class Learner {
  #exports;

  constructor(exports) {
    this.#exports = exports;
  }

  /** An untrained learner, whose training takes this number of episodes. */
  static async make(module, episodes = 1, seed = 0n) {
    const { exports } = await WebAssembly.instantiate(module);
    const words = new DataView(exports.memory.buffer, exports.buffer());
    let count = 0;
    for (; seed > 0n; seed >>= 32n) words.setUint32(4 * count++, Number(seed & 0xffff_ffffn), true);
    exports.begin(episodes, count);
    return new Learner(exports);
  }

  /** A view of the buffer. It ends when the module's memory grows. */
  #bytes(length) {
    return new Uint8Array(this.#exports.memory.buffer, this.#exports.buffer(), length);
  }

  /** Trains for one episode. Returns its return. */
  train() {
    return this.#exports.train();
  }

  save() {
    return this.#bytes(this.#exports.save()).slice();
  }

  /** Loads weights. If they are rejected, throws an `Error` with the reason and changes nothing. */
  load(weights) {
    if (weights.length > BUFFER) throw new Error(`weights must have at most ${BUFFER} bytes, got ${weights.length}`);
    this.#bytes(weights.length).set(weights);
    const length = this.#exports.load(weights.length);
    if (length !== 0) throw new Error(new TextDecoder().decode(this.#bytes(length)));
  }

  /** The learnt policy's action. */
  act({ theta1, theta2, dtheta1, dtheta2 }) {
    return this.#exports.act(theta1, theta2, dtheta1, dtheta2);
  }
}
