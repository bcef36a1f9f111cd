// What acrobots and batches share: the checks of their arguments, and what the module keeps.

import {
  Opaque, accept, bytes, checked, foreign, invalid, invalidSingle, numbers, wasm, writeSeed,
} from "./wasm.js";

const STATE = ["theta1", "theta2", "dtheta1", "dtheta2"];
/** The units of the parameters, in the order of Rust's `Params`. */
const UNITS = {
  length1: "m", length2: "m", mass1: "kg", mass2: "kg", centerOfMass1: "m", centerOfMass2: "m",
  inertia1: "kg m²", inertia2: "kg m²", gravity: "m/s²", dt: "s", maxVelocity1: "rad/s",
  maxVelocity2: "rad/s", torques: "N m", torqueNoise: "N m", dynamics: "",
  friction1: "N m s/rad", friction2: "N m s/rad",
};
const NAMES = Object.keys(UNITS);
const TORQUES = ["torques[0]", "torques[1]", "torques[2]"];
/** The names of the numbers: sixteen before the byte of the dynamics, and two after it. */
const SLOTS = NAMES.filter((name) => name !== "dynamics").flatMap((name) =>
  name === "torques" ? TORQUES : name,
);
const DYNAMICS = ["book", "nips"];
const DYNAMICS_AT = 64;
export const PARAMS_LENGTH = 73;
export const ACTION = "must be 0 (negative torque), 1 (none) or 2 (positive)";

export const isAction = (action) => action === 0 || action === 1 || action === 2;

export const isFinite32 = (number) =>
  typeof number === "number" && Number.isFinite(Math.fround(number));

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

/** The memory for parameters, whose last two numbers are not aligned, and where a number is. */
const view = () => new DataView(bytes().buffer, bytes().byteOffset);
const placeOf = (slot) => (4 * slot < DYNAMICS_AT ? 4 * slot : 4 * slot + 1);
const put = (name, value) => view().setFloat32(placeOf(SLOTS.indexOf(name)), value, true);

/** The parameters of acrobot `index`, in postcard's format. A single one ignores the index. */
export function readParams(kind, address, index) {
  wasm()[`${kind}_params`](address, index);
  const values = SLOTS.map((_, slot) => view().getFloat32(placeOf(slot), true));
  const next = (name) => {
    if (name === "dynamics") return DYNAMICS[bytes()[DYNAMICS_AT]];
    return name === "torques" ? Object.freeze(values.splice(0, 3)) : values.shift();
  };
  return Object.freeze(Object.fromEntries(NAMES.map((name) => [name, next(name)])));
}

/** Changed parameters by their names in `SLOTS`. Reading them can run code of the caller. */
export function readChanges(changes) {
  const given = checked("params", changes, NAMES);
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

/** Changes what `readChanges` returns in the parameters of acrobot `index`, or of all with 0. */
export function writeParams(kind, address, index, given) {
  wasm()[`${kind}_params`](address, index);
  for (const [name, value] of Object.entries(given)) {
    if (name === "dynamics") bytes()[DYNAMICS_AT] = DYNAMICS.indexOf(value);
    else put(name, value);
  }
  const length = wasm()[`${kind}_set_params`](address, index);
  accept(length, (name) => given[name] ?? readParams(kind, address, index)[name]);
}

/** Ranges of parameters, as rows of name, low and high. */
function readRanges(range) {
  const names = NAMES.filter((name) => !["torques", "dynamics"].includes(name));
  const given = checked("range", range, names);
  return Object.entries(given).map(([name, ends]) => {
    const number = (end) => typeof end === "number";
    const [low, high] = elements(name, ends, 2, number, "must be a number");
    if (low > high) {
      const rule = `${name} must have a low of at most its high, in ${UNITS[name]}`;
      throw invalid(rule, [low, high], ["object"]);
    }
    return [name, low, high];
  });
}

/** Frees what the program has forgotten to free, if the engine says when. */
const free = ({ kind, address }) => wasm()[`${kind}_free`](address);
const registry = globalThis.FinalizationRegistry && new FinalizationRegistry(free);

/**
 * `keep` gives an acrobot or a batch the memory at an address, and `addressOf` returns the address.
 * No caller of the package reaches them, so the module gets only addresses of its own, and none
 * that it has freed. Each use begins with `addressOf`, whose errors come before others.
 */
export let keep, addressOf, drawParams, seedSample;
let own;

/** What the module keeps at an address: an acrobot or a batch. */
export class Kept extends Opaque {
  #kind;
  #address = 0;
  /** The ranges from which each reset draws parameters. */
  #ranges = [];
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
    // As in the crate: after the initial state, from the same generator.
    drawParams = (kept, index) => {
      if (kept.#ranges.length === 0) return;
      const [kind, address] = [kept.#kind, addressOf(kept)];
      wasm()[`${kind}_params`](address, index);
      for (const [name, low, high] of kept.#ranges) {
        const isFixed = low === high;
        put(name, isFixed ? low : wasm()[`${kind}_uniform`](address, index, low, high));
      }
      wasm()[`${kind}_set_params`](address, index);
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
    writeParams(this.#kind, addressOf(this), 0, given);
  }

  setParamsRange(range) {
    addressOf(this);
    const ranges = readRanges(range);
    const [kind, address] = [this.#kind, addressOf(this)];
    wasm()[`${kind}_params`](address, 0);
    const before = bytes().slice(0, PARAMS_LENGTH);
    try {
      for (const end of [1, 2]) {
        const ends = Object.fromEntries(ranges.map((row) => [row[0], row[end]]));
        writeParams(kind, address, 0, ends);
      }
    } finally {
      bytes().set(before);
      wasm()[`${kind}_set_params`](address, 0);
    }
    this.#ranges = ranges.map(([name, ...ends]) => [name, ...ends.map(Math.fround)]);
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
    const { state, elapsed, maxSteps, params, settings } = this; // an acrobot has no settings
    return `${name} ${inspect(settings ?? { state, elapsed, maxSteps, params }, options)}`;
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
