// What the modules share: what they keep in their memory, and checks of arguments.

import {
  Opaque, camelCase, checked, integers, invalid, invalidSingle, isNumber, numbers, seedWords, text,
  wasm,
} from "./wasm.js";

export const STATE = ["theta1", "theta2", "dtheta1", "dtheta2"];
export const DYNAMICS = ["book", "nips"];

export function checkNumber(name, value) {
  if (!isNumber(value)) throw invalid(`${name} must be a number`, value);
}

/** The index of a name, as the module has it. */
export function indexOf(what, names, name) {
  const index = names.indexOf(name);
  if (index < 0) throw invalid(`${what} must be "${names.join('" or "')}"`, name, []);
  return index;
}

/** A copy of an array whose elements are valid. They are not converted: 258 and "2" are not 2. */
export function elements(what, array, count, isValid, rule) {
  const length = array?.length;
  if (length === undefined) {
    throw invalid(`${what} must be an array of ${count} elements`, array, []);
  }
  if (length !== count) throw invalid(`${what} must have ${count} elements`, length);
  const copy = Array.from({ length: count }, (_, i) => array[i]);
  const wrong = copy.findIndex((element) => !isValid(element));
  if (wrong >= 0) throw invalidSingle(`${what}[${wrong}] ${rule}`, copy[wrong]);
  return copy;
}

/** Writes the four numbers of a state from a word on. Returns them by their names. */
export function writeState(state, at = 0) {
  const given = checked("state", state, STATE);
  for (const name of STATE) checkNumber(name, given[name]);
  numbers().set(STATE.map((name) => given[name]), at);
  return given;
}

/** Writes a seed into the module's words, if there is one. Returns the number of its words. */
export function writeSeed(seed) {
  if (seed === undefined) return 0;
  const words = seedWords(seed);
  integers().set(words);
  return words.length;
}

let slots;

/** The names of the parameters in the order of the module: its numbers, and the dynamics. */
export function parameters() {
  if (!slots) {
    wasm().param_names();
    const numbers = Array.from({ length: 21 }, (_, i) => camelCase(text(2 * i)));
    slots = [...numbers, "dynamics"];
  }
  return slots;
}

/** The properties of an object by their names in `slots`: of `torques`, each element. */
export function readSlots(what, object, slots) {
  const names = [...new Set(slots.map((name) => name.replace(/\[.*/, "")))];
  const entries = Object.entries(checked(what, object, names)).flatMap(([name, value]) => {
    const count = slots.filter((slot) => slot.startsWith(`${name}[`)).length;
    if (count === 0) return [[name, value]];
    return elements(name, value, count, () => true).map((each, i) => [`${name}[${i}]`, each]);
  });
  return Object.fromEntries(entries);
}

/**
 * Writes values by their names in `slots`, with `dynamics` as its index, from a word on. Returns
 * their mask.
 */
export function writeSlots(given, slots, from = 0) {
  for (const [name, value] of Object.entries(given)) {
    if (name === "dynamics") given[name] = indexOf(name, DYNAMICS, value);
    else checkNumber(name, value);
  }
  let mask = 0;
  for (const [name, value] of Object.entries(given)) {
    const slot = slots.indexOf(name);
    numbers()[from + slot] = value;
    mask |= 1 << slot;
  }
  return mask;
}

/**
 * Throws if the module has rejected numbers. `given` has those of the caller by their names, as
 * numbers or in arrays.
 */
export function accept(kind, given) {
  if (kind === 0) return;
  const shared = "ownParams must be true for parameters of each acrobot";
  if (kind === 3) throw invalid(shared, false, ["boolean"]);
  const [value] = numbers();
  const name = camelCase(text(1));
  const friction = `0 in the task "gymnasium", in ${text(5)}`;
  const rule = text(3).startsWith("0 unless") ? friction : `${text(3)} ${text(5)}`;
  // What the caller gave, before it was rounded.
  const all = [given[name], given[`${name}[0]`], given[`${name}[1]`]].flat();
  const own = all.find((number) => Object.is(Math.fround(number), value));
  throw invalidSingle(`${name} must be ${rule}`, own ?? value);
}

/** Frees what the program has forgotten to free, if the engine says when. */
const free = (address) => wasm().kept_free(address);
const registry = globalThis.FinalizationRegistry && new FinalizationRegistry(free);

/**
 * `addressOf` returns an address in the module, and `call` calls a function of the module with it.
 * Reading arguments can run code that frees the acrobot, so they come after all arguments.
 */
export let addressOf, call;

/** The address of what the module has memory for, or an error. */
export function allocated(what, count, address) {
  const rule = `${what} must fit into WebAssembly's memory of at most 4 GiB`;
  if (!address) throw new RangeError(`${rule}, got ${count} more`);
  return address;
}

/** What the module keeps at an address: an acrobot, a batch or a planner. */
export class Kept extends Opaque {
  #kind;
  #address;

  static {
    addressOf = (kept) => {
      if (kept.#address === 0) throw new Error(`the ${kept.#kind} has been freed`);
      return kept.#address;
    };
    call = (kept, name, ...given) => wasm()[name](addressOf(kept), ...given);
  }

  constructor(kind, address) {
    super();
    this.#kind = kind;
    this.#address = address;
    registry?.register(this, address, this);
  }

  free() {
    if (this.#address === 0) return;
    registry?.unregister(this);
    free(this.#address);
    this.#address = 0;
  }

  // Older engines have neither `using` nor this symbol.
  [Symbol.dispose ?? Symbol("dispose")]() {
    this.free();
  }
}
