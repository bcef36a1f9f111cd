// Wraps the WebAssembly module, whose functions take numbers, in methods that take JavaScript values. The page has one
// instance, and each worker has its own.

/** A minimal module that uses simd128: `i32.const 0`, `i8x16.splat`, `drop`. Only browsers with simd128 accept it. */
const SIMD128 = Uint8Array.of(
  0, 97, 115, 109, 1, 0, 0, 0, // magic and version
  1, 4, 1, 96, 0, 0, // a type: () -> ()
  3, 2, 1, 0, // a function of that type
  10, 9, 1, 7, 0, 65, 0, 253, 15, 26, 11, // its body
);

export const hasSimd128 = () => WebAssembly.validate(SIMD128);

/** The most steps of an episode. */
export const LIMIT = 500;

/** The parameters that the page can set: name, label, unit, Gymnasium's value, the slider's end and step, and a hint. */
export const PARAMETERS = [
  ["dt", "Time step dt", "s", 0.2, 0.5, 0.01],
  ["mass1", "Mass of link 1", "kg", 1, 4, 0.05],
  ["mass2", "Mass of link 2", "kg", 1, 4, 0.05],
  ["length1", "Length of link 1", "m", 1, 3, 0.05, "Moves the motor. The centre of mass stays 0.5 m from the fixed joint."],
  ["length2", "Length of link 2", "m", 1, 3, 0.05, "Changes only the picture and the tip height. The centre of mass stays 0.5 m from the motor."],
  ["gravity", "Gravity", "m/s²", 9.8, 25, 0.1],
].map(([name, label, unit, value, end, step, hint = ""]) => ({ name, label, unit, value, end, step, hint }));

export const DEFAULTS = {
  dynamics: "book",
  ...Object.fromEntries(PARAMETERS.map(({ name, value }) => [name, value])),
};

/** The size of the module's buffer in bytes, and the maximum number of 32-bit words that it reads of a seed. */
const BUFFER = 1 << 17;
const SEED_WORDS = 64;

/** The seed in a text. Throws an `Error` with the reason if the text is not a seed. */
export function parseSeed(text) {
  const digits = text.trim();
  const rule = "seed must be a decimal integer of at least 0 with at most 600 digits";
  if (digits === "") throw new Error(`${rule}, got an empty text`);
  const wrong = digits.search(/[^0-9]/);
  if (wrong >= 0) throw new Error(`${rule}, got '${digits[wrong]}' as character ${wrong + 1}`);
  if (digits.length > 600) throw new Error(`${rule}, got ${digits.length} digits`);
  return BigInt(digits);
}

export class Acrobot {
  #exports;
  #buffer;

  static async load(module) {
    return new Acrobot((await WebAssembly.instantiate(module)).exports);
  }

  constructor(exports) {
    this.#exports = exports;
    this.#buffer = exports.buffer();
  }

  /** A view of the module's memory, whose size never changes. */
  #bytes(length, address = this.#buffer) {
    return new Uint8Array(this.#exports.memory.buffer, address, length);
  }

  #floats(address, length) {
    return new Float32Array(this.#exports.memory.buffer, address, length);
  }

  #text(length, start = 0) {
    return new TextDecoder().decode(this.#bytes(length).slice(start));
  }

  /** Writes a seed into the module's buffer. Returns the number of words written. */
  #seed(seed) {
    const words = new DataView(this.#exports.memory.buffer, this.#buffer);
    let count = 0;
    for (; seed > 0n && count < SEED_WORDS; seed >>= 32n) {
      words.setUint32(4 * count++, Number(seed & 0xffff_ffffn), true);
    }
    return count;
  }

  reset(seed) {
    this.#exports.reset(this.#seed(seed));
  }

  /** Steps. Returns whether this reached the goal or the limit of steps. */
  step(action) {
    const flags = this.#exports.step(action);
    return { terminated: (flags & 1) !== 0, truncated: (flags & 2) !== 0 };
  }

  /** θ1, θ2, θ̇1, θ̇2, energy and height of the tip: a copy, in single precision. */
  numbers() {
    return this.#floats(this.#exports.numbers(), 6).slice();
  }

  /** Sets the parameters. If the crate rejects them, throws an `Error` with its reason and changes nothing. */
  setParams(params) {
    const { dynamics, dt, mass1, mass2, length1, length2, gravity } = params;
    const length = this.#exports.set_params(dynamics === "nips", dt, mass1, mass2, length1, length2, gravity);
    if (length === 0) return;
    const [name, unit, rule] = this.#text(length, 8).split("\n");
    const rounded = new DataView(this.#exports.memory.buffer, this.#buffer).getFloat64(0, true);
    // The number as the user wrote it, unless it rounds to zero or infinity in single precision.
    const value = params[name] * rounded > 0 && Number.isFinite(rounded) ? params[name] : rounded;
    throw new Error(`${name} must be ${rule} ${unit}, got ${String(value).replace("Infinity", "inf")}`);
  }

  /** The energy of standing upright, J. */
  standing() {
    return this.#exports.standing();
  }

  /** The action of a policy: `random`, `bang_bang`, `energy_law` or `learnt`. */
  act(policy) {
    return this.#exports[policy]();
  }

  resize(side) {
    this.#exports.resize(side, side);
    const pixels = this.#bytes(4 * side * side, this.#exports.pixels());
    return new ImageData(new Uint8ClampedArray(pixels.buffer, pixels.byteOffset, pixels.length), side, side);
  }

  paint(...colors) {
    this.#exports.paint(...colors);
  }

  /** Draws the acrobot at a part of its last step, from 0 to 1. Returns the tip's position [x, y] in m, x to the right and y up. */
  draw(part) {
    return this.#floats(this.#exports.draw(part), 2);
  }

  /** Loads weights for the policy `learnt`. If they are rejected, throws an `Error` with the reason and changes nothing. */
  load(weights) {
    if (weights.length > BUFFER) throw new Error(`weights must have at most ${BUFFER} bytes, got ${weights.length}`);
    this.#bytes(weights.length).set(weights);
    const length = this.#exports.load(weights.length);
    if (length !== 0) throw new Error(this.#text(length));
  }

  beginTraining(episodes, seed) {
    this.#exports.begin_training(episodes, this.#seed(seed));
  }

  /** Trains for one episode. Returns its return. */
  train() {
    return this.#exports.train();
  }

  save() {
    return this.#bytes(this.#exports.save()).slice();
  }

  scalarSteps(steps) {
    this.#exports.scalar_steps(steps);
  }

  batchSteps(steps) {
    this.#exports.batch_steps(steps);
  }
}
