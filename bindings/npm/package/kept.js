// What acrobots and batches share: the checks of their arguments, and what the module keeps.

import { accept, bytes, checked, invalid, numbers, wasm } from "./wasm.js";

const STATE = ["theta1", "theta2", "dtheta1", "dtheta2"];
/** The parameters that are numbers, and the three torques, in the order of Rust's `Params`. */
const NUMBERS = [
  "length1", "length2", "mass1", "mass2", "centerOfMass1", "centerOfMass2", "inertia1", "inertia2",
  "gravity", "dt", "maxVelocity1", "maxVelocity2", "torques", "torqueNoise",
];
/** The names of the sixteen numbers. */
const TORQUES = ["torques[0]", "torques[1]", "torques[2]"];
const SLOTS = NUMBERS.flatMap((name) => (name === "torques" ? TORQUES : name));
const DYNAMICS = ["book", "nips"];
/** The byte of the dynamics, behind the numbers. Two numbers for friction follow, which are 0. */
const DYNAMICS_AT = 64;
export const PARAMS_LENGTH = 73;
export const ACTION = "must be 0 (negative torque), 1 (none) or 2 (positive)";

export const isAction = (action) => action === 0 || action === 1 || action === 2;

export const sample = () => Math.floor(3 * Math.random());

export const readState = () =>
  Object.freeze(Object.fromEntries(STATE.map((name, i) => [name, numbers()[i]])));

function checkNumber(name, value) {
  if (typeof value !== "number") throw invalid(`${name} must be a number`, value);
}

/** Writes a state into the module's memory. Returns the function that `accept` needs. */
export function writeState(state) {
  const given = checked("state", state, STATE);
  for (const name of STATE) checkNumber(name, given[name]);
  numbers().set(STATE.map((name) => given[name]));
  return (name) => given[name];
}

/**
 * The elements of an array, each read once, because that can run code of the caller. They are not
 * converted: 258 and "2" are not 2.
 */
export function elements(what, array, count, isValid, rule) {
  const length = array?.length;
  if (length !== count) {
    const types = length === undefined ? [] : ["number"];
    throw invalid(`${what} must have ${count} elements`, length ?? array, types);
  }
  const copy = [];
  for (let i = 0; i < count; i++) {
    const element = array[i];
    if (!isValid(element)) throw invalid(`${what}[${i}] ${rule}`, element);
    copy.push(element);
  }
  return copy;
}

/**
 * The parameters of acrobot `index` in postcard's format: sixteen numbers, a byte for the dynamics,
 * and the friction. A single one ignores the index.
 */
export function readParams(kind, address, index) {
  wasm()[`${kind}_params`](address, index);
  const values = [...numbers()];
  const next = (name) => (name === "torques" ? Object.freeze(values.splice(0, 3)) : values.shift());
  const params = Object.fromEntries(NUMBERS.map((name) => [name, next(name)]));
  return Object.freeze({ ...params, dynamics: DYNAMICS[bytes()[DYNAMICS_AT]] });
}

/** Changed parameters by their names in `SLOTS`. Reading them can run code of the caller. */
export function readChanges(changes) {
  const given = checked("params", changes, [...NUMBERS, "dynamics"]);
  if ("torques" in given) {
    const { torques } = given;
    delete given.torques;
    if (!Array.isArray(torques) || torques.length !== 3) {
      throw invalid("torques must be an array of 3 numbers", torques, []);
    }
    TORQUES.forEach((name, i) => (given[name] = torques[i]));
  }
  for (const [name, value] of Object.entries(given)) {
    if (name !== "dynamics") checkNumber(name, value);
    else if (!DYNAMICS.includes(value)) {
      throw invalid('dynamics must be "book" or "nips"', value, []);
    }
  }
  return given;
}

/** Changes what `readChanges` returns in the parameters of acrobot `index`. */
export function writeParams(kind, address, index, given, set = `${kind}_set_params`) {
  wasm()[`${kind}_params`](address, index);
  for (const [name, value] of Object.entries(given)) {
    if (name === "dynamics") bytes()[DYNAMICS_AT] = DYNAMICS.indexOf(value);
    else numbers()[SLOTS.indexOf(name)] = value;
  }
  const length = wasm()[set](address, index);
  accept(length, (name) => given[name] ?? readParams(kind, address, index)[name]);
}

/** Frees what the program has forgotten to free, if the engine says when. */
const free = ({ kind, address }) => wasm()[`${kind}_free`](address);
const registry = globalThis.FinalizationRegistry && new FinalizationRegistry(free);

/** A property that only this package can read. */
export const SHOWN = Symbol("shown");

/**
 * `keep` gives an acrobot or a batch the memory at an address, and `addressOf` returns the address.
 * No caller of the package reaches them, so the module gets only addresses of its own, and none
 * that it has freed.
 */
export let keep, addressOf;

/** What the module keeps at an address: an acrobot or a batch. */
export class Kept {
  #kind;
  #address = 0;

  static {
    keep = (kept, kind, address, count) => {
      const rule = "acrobots must fit into WebAssembly's memory of at most 4 GiB";
      if (address === 0) throw new RangeError(`${rule}, got ${count} more`);
      kept.#kind = kind;
      kept.#address = address;
      registry?.register(kept, { kind, address }, kept);
    };
    addressOf = (kept) => {
      if (kept.#address === 0) throw new Error(`the ${kept.#kind} has been freed`);
      return kept.#address;
    };
  }

  /** Vue makes no proxy of an object with this property. A proxy has no private fields. */
  get __v_skip() {
    return true;
  }

  get params() {
    return readParams(this.#kind, addressOf(this), 0);
  }

  setParams(changes) {
    const given = readChanges(changes);
    writeParams(this.#kind, addressOf(this), 0, given);
  }

  free() {
    if (this.#address === 0) return;
    registry?.unregister(this);
    free({ kind: this.#kind, address: this.#address });
    this.#address = 0;
  }

  // Older engines have neither `using` nor this symbol.
  [Symbol.dispose ?? Symbol("dispose")]() {
    this.free();
  }

  /** What Node.js's console shows. */
  [Symbol.for("nodejs.util.inspect.custom")](depth, options, inspect) {
    const shown = this.#address === 0 ? "freed" : inspect(this[SHOWN], options);
    return `${this.constructor.name} ${shown}`;
  }
}

/** Calls a function, and frees what is being made if that throws. */
export function orFree(kept, call) {
  try {
    call();
  } catch (error) {
    kept.free();
    throw error;
  }
}
