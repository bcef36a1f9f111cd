// What acrobots and batches share: the checks of their arguments, and what the module keeps.

import { accept, checked, invalid, numbers, wasm } from "./wasm.js";

const STATE = ["theta1", "theta2", "dtheta1", "dtheta2"];
/** The parameters in the order of the module, where three torques follow instead of `torques`. */
const NUMBERS = [
  "length1", "length2", "mass1", "mass2", "centerOfMass1", "centerOfMass2", "inertia1", "inertia2", "gravity", "dt",
  "maxVelocity1", "maxVelocity2", "torques", "torqueNoise",
];
export const ACTION = "must be 0 (negative torque), 1 (none) or 2 (positive)";

export const isAction = (action) => action === 0 || action === 1 || action === 2;

export const sample = () => Math.floor(3 * Math.random());

export const readState = () => Object.freeze(Object.fromEntries(STATE.map((name, i) => [name, numbers()[i]])));

/** Writes a state into the module's memory. Returns the function that `accept` needs. */
export function writeState(state) {
  const given = checked("state", state, STATE);
  for (const name of STATE) if (typeof given[name] !== "number") throw invalid(`${name} must be a number`, given[name]);
  numbers().set(STATE.map((name) => given[name]));
  return (name) => given[name];
}

/** The elements of an array, each read once, because that can run code of the caller. They are not converted: 258 and "2" are not 2. */
export function elements(what, array, count, isValid, rule) {
  const length = array?.length;
  if (length !== count) throw invalid(`${what} must have ${count} elements`, length ?? array, length === undefined ? [] : ["number"]);
  const copy = [];
  for (let i = 0; i < count; i++) {
    const element = array[i];
    if (!isValid(element)) throw invalid(`${what}[${i}] ${rule}`, element);
    copy.push(element);
  }
  return copy;
}

/** Frees what the program has forgotten to free. */
const registry = new FinalizationRegistry(({ kind, number }) => wasm()[`${kind}_free`](number));

/** Properties that only this package can read. */
export const [NUMBER, SHOWN] = [Symbol("number"), Symbol("shown")];

/** What the module keeps under a number: an acrobot or a batch. */
export class Kept {
  #kind;
  #number;

  /** Without memory, the module returns a negative number. */
  constructor(kind, number, count) {
    if (number < 0) throw new RangeError(`acrobots must fit into WebAssembly's memory of at most 4 GiB, got ${count} more`);
    this.#kind = kind;
    this.#number = number;
    registry.register(this, { kind, number }, this);
  }

  get [NUMBER]() {
    if (this.#number === undefined) throw new Error(`the ${this.#kind} has been freed`);
    return this.#number;
  }

  get params() {
    return this.readParams(0);
  }

  /** The parameters of an acrobot. A single one ignores the index. */
  readParams(index) {
    wasm()[`${this.#kind}_params`](this[NUMBER], index);
    const values = [...numbers()];
    const torques = Object.freeze(values.splice(12, 3));
    const params = Object.fromEntries(NUMBERS.filter((name) => name !== "torques").map((name, i) => [name, values[i]]));
    return Object.freeze({ ...params, torques, dynamics: values.at(-1) === 1 ? "nips" : "book" });
  }

  setParams(changes) {
    this.writeParams(changes, 0, () => wasm()[`${this.#kind}_set_params`](this[NUMBER]));
  }

  /** Reads the old parameters and calls `set` after the changes, whose properties can run code of the caller. */
  writeParams(changes, index, set) {
    const given = checked("params", changes, [...NUMBERS, "dynamics"]);
    if ("torques" in given) {
      const { torques } = given;
      if (!Array.isArray(torques) || torques.length !== 3) throw invalid("torques must be an array of 3 numbers", torques, []);
      given.torques = [0, 1, 2].map((i) => torques[i]);
    }
    const params = { ...this.readParams(index), ...given };
    const { torques, dynamics } = params;
    if (dynamics !== "book" && dynamics !== "nips") throw invalid('dynamics must be "book" or "nips"', dynamics, []);
    const values = NUMBERS.flatMap((name) => {
      const of = name === "torques" ? torques : [params[name]];
      for (const value of of) if (typeof value !== "number") throw invalid(`${name} must be a number`, value);
      return of;
    });
    numbers().set([...values, Number(dynamics === "nips")]);
    accept(set(), (name) => (name.startsWith("torques") ? torques[name.at(-2)] : params[name]));
  }

  free() {
    if (this.#number === undefined) return;
    registry.unregister(this);
    wasm()[`${this.#kind}_free`](this.#number);
    this.#number = undefined;
  }

  // Older engines have no `using`, and no such symbol.
  [Symbol.dispose ?? Symbol("dispose")]() {
    this.free();
  }

  /** What Node.js's console shows. */
  [Symbol.for("nodejs.util.inspect.custom")](depth, options, inspect) {
    const shown = this.#number === undefined ? "freed" : inspect(this[SHOWN], options);
    return `${this.constructor.name} ${shown}`;
  }
}
