// What acrobots and batches share: the checks of their arguments, and what the module keeps.

import {
  Opaque, accept, checked, foreign, invalid, invalidSingle, numbers, wasm, writeSeed,
} from "./wasm.js";

const STATE = ["theta1", "theta2", "dtheta1", "dtheta2"];
const TORQUES = ["torques[0]", "torques[1]", "torques[2]"];
/** The numbers among the parameters, in the order of the module. */
const SLOTS = [
  "length1", "length2", "mass1", "mass2", "centerOfMass1", "centerOfMass2", "inertia1", "inertia2",
  "gravity", "dt", "maxVelocity1", "maxVelocity2", ...TORQUES, "torqueNoise", "friction1",
  "friction2",
];
const DYNAMICS_SLOT = SLOTS.length;
/** What may be drawn. */
const DRAWN = [...new Set(SLOTS.map((name) => name.replace(/\[.*/, "")))];
const NAMES = [...DRAWN, "dynamics"];
const DYNAMICS = ["book", "nips"];
/** The kinds of draws in the order of the module, with the count of their numbers. */
const DRAWS = { fixed: 0, asBefore: 0, uniform: 2, logUniform: 2, normal: 4 };
export const TASKS = ["acrobot", "swingup"];
export const ACTION = "must be 0 (negative torque), 1 (none) or 2 (positive)";

export const isAction = (action) => action === 0 || action === 1 || action === 2;

const isNumber = (value) => typeof value === "number";

export const isFinite32 = (number) => isNumber(number) && Number.isFinite(Math.fround(number));

/** The index of a name, as the module has it. */
export function indexOf(what, names, name) {
  const index = names.indexOf(name);
  if (index < 0) throw invalid(`${what} must be "${names.join('" or "')}"`, name, []);
  return index;
}

export const readState = () =>
  Object.freeze(Object.fromEntries(STATE.map((name, i) => [name, numbers()[i]])));

function checkNumber(name, value) {
  if (!isNumber(value)) throw invalid(`${name} must be a number`, value);
}

/** The numbers of a state by their names. Reading them can run code of the caller. */
export function readGivenState(state) {
  const given = checked("state", state, STATE);
  for (const name of STATE) checkNumber(name, given[name]);
  return given;
}

/** Sets the state of an acrobot, of a batch that with this index. */
export function setState(kind, address, given, index) {
  numbers().set(STATE.map((name) => given[name]));
  accept(wasm()[`${kind}_set_state`](address, index), given);
}

/**
 * The elements of an array, each read once, because that can run code of the caller. They are not
 * converted: 258 and "2" are not 2.
 */
export function elements(what, array, count, isValid, rule) {
  const length = array?.length;
  if (length !== count) {
    const types = length === undefined ? [] : ["number"];
    const must = length === undefined ? "be an array of" : "have";
    throw invalid(`${what} must ${must} ${count} elements`, length ?? array, types);
  }
  const copy = [];
  for (let i = 0; i < count; i++) {
    const element = array[i];
    if (!isValid(element)) {
      const must = typeof rule === "function" ? rule(i) : rule;
      throw invalidSingle(`${what}[${i}] ${must}`, element);
    }
    copy.push(element);
  }
  return copy;
}

/** The parameters of acrobot `index`. A single one ignores the index. */
export function readParams(kind, address, index) {
  wasm()[`${kind}_params`](address, index);
  const values = [...numbers().subarray(0, DYNAMICS_SLOT + 1)];
  const next = (name) => {
    if (name === "dynamics") return DYNAMICS[values[0]];
    return name === "torques" ? Object.freeze(values.splice(0, 3)) : values.shift();
  };
  return Object.freeze(Object.fromEntries(NAMES.map((name) => [name, next(name)])));
}

/** Properties of an object by their names in `SLOTS`: of `torques`, each element. */
function readSlots(what, object, names) {
  const given = checked(what, object, names);
  if ("torques" in given) {
    const torques = elements("torques", given.torques, 3, () => true);
    delete given.torques;
    TORQUES.forEach((name, i) => (given[name] = torques[i]));
  }
  return given;
}

/** Changed parameters. Reading them can run code of the caller. */
export function readChanges(changes) {
  const given = readSlots("params", changes, NAMES);
  for (const [name, value] of Object.entries(given)) {
    if (name === "dynamics") given[name] = indexOf(name, DYNAMICS, value);
    else checkNumber(name, value);
  }
  return given;
}

/** Changes what `readChanges` returns in the parameters of all acrobots, or of acrobot `index`. */
export function writeParams(kind, address, given, index) {
  let mask = 0;
  for (const [name, value] of Object.entries(given)) {
    const slot = name === "dynamics" ? DYNAMICS_SLOT : SLOTS.indexOf(name);
    numbers()[slot] = value;
    mask |= 1 << slot;
  }
  accept(wasm()[`${kind}_set_params`](address, mask, index !== undefined, index), given);
}

/** A draw as the module reads it: the index of its kind, and its numbers. */
function readDraw(name, draw) {
  const object = Array.isArray(draw) ? { uniform: draw } : draw;
  const given = typeof draw === "string" ? [[draw, []]] : Object.entries(object ?? {});
  const [[kind, array] = []] = given;
  const index = Object.keys(DRAWS).indexOf(kind);
  if (index < 0 || given.length > 1) {
    const forms = "[low, high], { logUniform: [low, high] }, { normal: [mean, std, low, high] }";
    throw invalid(`${name} must be drawn by ${forms}, "asBefore" or "fixed"`, draw, []);
  }
  return [index, ...elements(name, array, DRAWS[kind], isNumber, "must be a number")];
}

/** Frees what the program has forgotten to free, if the engine says when. */
const free = ({ kind, address }) => wasm()[`${kind}_free`](address);
const registry = globalThis.FinalizationRegistry && new FinalizationRegistry(free);

/**
 * `keep` gives an acrobot or a batch the memory at an address, and `addressOf` returns the address.
 * No caller of the package reaches them, so the module gets only addresses of its own, and none
 * that it has freed. Each use begins with `addressOf`, whose errors come before others.
 */
export let keep, addressOf, seedSample;
let own;

/** What the module keeps at an address: an acrobot or a batch. */
export class Kept extends Opaque {
  #kind;
  #address = 0;
  /** Whether random actions have a seed. */
  #samples = false;

  static {
    keep = (kept, kind, address, count) => {
      const rule = "acrobots must fit into WebAssembly's memory of at most 4 GiB";
      if (address === 0) throw new RangeError(`${rule}, got ${count} more`);
      kept.#kind = kind;
      kept.#address = address;
      registry?.register(kept, { kind, address }, kept);
    };
    own = (kept, kind) => {
      if (#kind in Object(kept) && (!kind || kind === kept.#kind)) return kept;
      const classes = { acrobot: "Acrobot", batch: "Batch" };
      throw foreign(classes[kind] ?? "Acrobot and Batch", kept);
    };
    addressOf = (kept, kind) => {
      if (own(kept, kind).#address === 0) throw new Error(`the ${kept.#kind} has been freed`);
      return kept.#address;
    };
    // Returns the number of words of the seed, which is random the first time.
    seedSample = (kept, seed) => {
      if (seed === undefined && kept.#samples) return 0;
      const words = writeSeed(seed);
      kept.#samples = true;
      return words;
    };
  }

  get params() {
    const address = addressOf(this);
    return readParams(this.#kind, address, 0);
  }

  setParams(changes) {
    addressOf(this);
    const given = readChanges(changes);
    writeParams(this.#kind, addressOf(this), given);
  }

  setDraws(draws) {
    addressOf(this);
    const given = readSlots("draws", draws, DRAWN);
    for (const [name, draw] of Object.entries(given)) given[name] = readDraw(name, draw);
    const address = addressOf(this);
    numbers().fill(0);
    for (const [name, row] of Object.entries(given)) numbers().set(row, 5 * SLOTS.indexOf(name));
    accept(wasm()[`${this.#kind}_set_draws`](address), given);
  }

  free() {
    if (own(this).#address === 0) return;
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
    const { name } = this.constructor;
    if (!(#address in this)) return `${name} proxy or copy`;
    if (this.#address === 0) return `${name} freed`;
    const { state, elapsedSteps, maxSteps, params, settings } = this; // an acrobot has no settings
    return `${name} ${inspect(settings ?? { state, elapsedSteps, maxSteps, params }, options)}`;
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
