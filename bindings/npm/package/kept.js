// The functions of acrobot.h, what they keep in the module's memory, and their structs.

import { KINDS, STATUS, STRUCTS } from "./layout.js";
import {
  Opaque, camelCase, checked, decoded, instantiate, invalid, invalidSingle, isNumber, seedWords,
} from "./wasm.js";

const { acrobot_error_t: ERROR, acrobot_params_t: PARAMS } = STRUCTS;
const DYNAMICS = ["book", "nips"];

// Bundlers to CommonJS do not rename a variable `exports`.
let shared;

/** The functions of the one instance that all acrobots share. */
export const wasm = () => (shared ??= instantiate());

/** The address of `size` bytes of zeros for `count` of something, or an error. */
function allocate(size, what, count) {
  const address = size < 2 ** 32 ? wasm().acrobot_memory_new(size) >>> 0 : 0;
  const rule = `${what} must fit into WebAssembly's memory of at most 4 GiB`;
  if (address === 0) throw new RangeError(`${rule}, got ${count} more`);
  return address;
}

/** In the memory for arguments: a reset's options, its seed, a result, and what `call` writes. */
const [OPTIONS, SEED, RESULT, REST, SIZE] = [0, 64, 320, 384, 16384];

const views = {};

/**
 * The memory for arguments: where a result of up to 64 bytes is written, and views of it and of
 * what is before. They have length 0 once the module's memory has grown.
 */
export function scratch() {
  if (!views.numbers?.length) {
    views.address ??= allocate(SIZE, "arguments", 1);
    const { buffer } = wasm().memory;
    const result = views.address + RESULT;
    views.result = result;
    views.words = new Uint32Array(buffer, views.address, REST / 4);
    views.numbers = new Float32Array(buffer, result, (REST - RESULT) / 4);
    views.integers = new Uint32Array(buffer, result, (REST - RESULT) / 4);
    views.flags = new Uint8Array(buffer, result, REST - RESULT);
    views.bytes = new Uint8Array(buffer, views.address, SIZE);
  }
  return views;
}

/** As `call`, for a function that writes a result and rejects nothing. Returns the views. */
export function read(name, ...args) {
  const views = scratch();
  accept(wasm()[name](...args, views.result));
  return views;
}

export function accept(status) {
  if (status !== 0) throw rejection(status);
}

/** The address of a reset's options: 0 without a seed. */
export function resetOptions(seed) {
  if (seed === undefined) return 0;
  const [own, { address, words }] = [seedWords(seed), scratch()];
  words.set(own, SEED / 4);
  words.set([address + SEED, own.length, 0], OPTIONS / 4);
  return address + OPTIONS;
}

/** The next size with which addresses stay aligned. */
export const padded = (size) => Math.ceil(size / 16) * 16;

const bytesOf = ({ buffer, byteOffset, byteLength }) =>
  new Uint8Array(buffer, byteOffset, byteLength);
export const bytesAt = (address, length) => new Uint8Array(wasm().memory.buffer, address, length);

const text = (at) => {
  const bytes = bytesAt(at, 128);
  return decoded(bytes.subarray(0, bytes.indexOf(0)));
};

const DAMAGES = {
  [STATUS.damagedSnapshot]: "another checksum",
  [STATUS.otherSnapshot]: "another class or version, or invalid contents",
};
const ERROR_SIZE = padded(4 * (ERROR.rule[0] + ERROR.rule[1]));
/** The errors without a number. */
const WITHOUT = [
  KINDS.notStabilizable, KINDS.notDetectable, KINDS.notObservable, KINDS.notExcited,
];
/** JavaScript's names of arguments that have others in Rust. */
const NAMES = { "the largest torque": "limit" };

/** The error for a status, or nothing if a planner finds no plan. */
function rejection(status, at, given) {
  if (status === STATUS.sharedParams) {
    return invalid("ownParams must be true for parameters of each acrobot", false, ["boolean"]);
  }
  if (status in DAMAGES) {
    const rule = "the snapshot must be an undamaged one of the same class and version";
    return new RangeError(`${rule}, got ${given.length} bytes with ${DAMAGES[status]}`);
  }
  if (status !== STATUS.outOfRange) return new Error(text(wasm().acrobot_status_text(status)));
  const { buffer } = wasm().memory;
  const [value] = new Float64Array(buffer, at + 4 * ERROR.value[0], 1);
  const [kind] = new Int32Array(buffer, at + 4 * ERROR.kind[0], 1);
  const [name, rule] = [ERROR.name, ERROR.rule].map(([word]) => text(at + 4 * word));
  if (kind === KINDS.noPlan) return undefined;
  if (WITHOUT.includes(kind)) return new RangeError(text(wasm().acrobot_error_text(kind)));
  const own = NAMES[name] ?? camelCase(name);
  // The number before it was rounded.
  const isGiven = (number) => Object.is(Math.fround(number), Math.fround(value));
  const exact = [given[own.replace(/\[.*/, "")]].flat().find(isGiven);
  return invalidSingle(`${own} must be ${rule}`, exact ?? value);
}

/**
 * Calls a function with numbers, objects that are kept, and typed arrays, which it reads and
 * writes. Throws what it rejects: `given` has the caller's values by their names. Returns false if
 * a planner finds no plan. Code of the caller must run before, because it can free and allocate.
 */
export function call(given, name, ...args) {
  const run = wasm()[name];
  const values = args.map((arg) => (arg instanceof Kept ? addressOf(arg) : arg));
  const copies = values.map((value) => ArrayBuffer.isView(value) && bytesOf(value));
  const size = copies.reduce((sum, { length = 0 }) => sum + padded(length), REST + ERROR_SIZE);
  const own = size > SIZE ? allocate(size, "arguments", 1) : 0;
  const { address, bytes } = own ? { address: own, bytes: bytesAt(own, size) } : scratch();
  let next = REST + ERROR_SIZE;
  const places = copies.map(({ length = 0 }) => (next += padded(length)) - padded(length));
  copies.forEach((copy, i) => copy && bytes.set(copy, places[i]));
  const addresses = values.map((value, i) => (copies[i] ? address + places[i] : value));
  // The error is the last argument of the functions that have one.
  const error = address + REST;
  const status = run(...addresses, ...(run.length > args.length ? [error] : []));
  copies.forEach((copy, i) => copy && copy.set(bytes.subarray(places[i], places[i] + copy.length)));
  const reason = status === 0 ? null : rejection(status, error, given);
  if (own) wasm().acrobot_memory_free(own, size);
  if (reason) throw reason;
  return reason === null;
}

export function checkNumber(name, value) {
  if (!isNumber(value)) throw invalid(`${name} must be a number`, value);
}

/** The index of a name, as the module has it. */
export function indexOf(what, names, name) {
  const index = names.indexOf(name);
  if (index < 0) throw invalid(`${what} must be "${names.join('" or "')}"`, name, []);
  return index;
}

/** The length of an array, if it has one. That of a proxy can throw. */
export function lengthOf(array) {
  try {
    return array?.length;
  } catch {
    return undefined;
  }
}

/** A copy of an array whose elements are valid. They are not converted: 258 and "2" are not 2. */
export function elements(
  what, array, count = lengthOf(array), isValid = isNumber, rule = "must be a number",
) {
  const length = lengthOf(array);
  if (length === undefined) {
    const size = count === undefined ? "" : ` of ${count} elements`;
    throw invalid(`${what} must be an array${size}`, array, []);
  }
  if (length !== count) throw invalid(`${what} must have ${count} elements`, length);
  const copy = Array.from({ length }, (_, i) => array[i]);
  const wrong = copy.findIndex((element) => !isValid(element));
  if (wrong >= 0) throw invalidSingle(`${what}[${wrong}] ${rule}`, copy[wrong]);
  return copy;
}

/** The elements of a matrix by rows. */
export const matrix = (name, rows) =>
  elements(name, rows, 4, () => true).flatMap((row, i) => elements(`${name}[${i}]`, row, 4));

/** A copy of an object with some fields of a struct: a number, or an array of numbers, for each. */
export function fields(what, object, struct) {
  const given = checked(what, object, Object.keys(struct));
  for (const [name, value] of Object.entries(given)) {
    const [, count] = struct[name];
    if (name === "dynamics") given[name] = indexOf(name, DYNAMICS, value);
    else if (count === 1) checkNumber(name, value);
    else given[name] = count === 16 ? matrix(name, value) : elements(name, value, count);
  }
  return given;
}

/** A copy of an object with all numbers of a struct, and its words. */
export function readAll(what, object, struct) {
  const names = Object.keys(struct);
  const given = checked(what, object, names);
  for (const name of names) checkNumber(name, given[name]);
  return [given, Float32Array.from(names, (name) => given[name])];
}

/** Writes fields at their places. Returns the words. */
export function pack(words, given, struct) {
  for (const [name, value] of Object.entries(given)) words.set([value].flat(), struct[name][0]);
  if (given.dynamics !== undefined) integersOf(words)[PARAMS.dynamics[0]] = given.dynamics;
  return words;
}

const integersOf = ({ buffer, byteOffset }) => new Int32Array(buffer, byteOffset);

/** A frozen object with the fields of a struct. */
export function unpack(words, struct) {
  const object = {};
  for (const [name, [at, count]] of Object.entries(struct)) {
    object[name] = count === 1 ? words[at] : Object.freeze([...words.subarray(at, at + count)]);
  }
  if (struct === PARAMS) object.dynamics = DYNAMICS[integersOf(words)[PARAMS.dynamics[0]]];
  return Object.freeze(object);
}

/** The words of a struct of zeros. */
export function empty(struct) {
  const [[at, count]] = Object.values(struct).slice(-1);
  return new Float32Array(at + count);
}

export const readChanges = (changes) => fields("params", changes, PARAMS);

/** The words of parameters that a function writes. */
export function paramsOf(name, ...args) {
  const words = empty(PARAMS);
  call({}, name, ...args, words);
  return words;
}

/** Frees what the program has forgotten to free, if the engine says when. */
const free = ({ address, size }) => wasm().acrobot_memory_free(address, size);
const registry = globalThis.FinalizationRegistry && new FinalizationRegistry(free);

/** Frees an object that is being made if that throws. */
export function orFree(kept, make) {
  try {
    make();
  } catch (error) {
    kept.free();
    throw error;
  }
}

/**
 * `addressOf` returns the address of an object's memory. `hold` gives it other memory, with room
 * for `count` of `what`, and calls `init`.
 */
export let addressOf, hold;

/** What has memory in the module: an acrobot, a batch, a planner and others. */
export class Kept extends Opaque {
  #memory;

  static {
    addressOf = (kept) => {
      if (!kept.#memory) throw new Error(`the ${kept.constructor.kind} has been freed`);
      return kept.#memory.address;
    };
    hold = (kept, size, init, what = `${kept.constructor.kind}s`, count = 1) => {
      kept.free();
      kept.#memory = { address: allocate(size, what, count), size };
      registry?.register(kept, kept.#memory, kept);
      orFree(kept, init);
    };
  }

  free() {
    if (!this.#memory) return;
    registry?.unregister(this);
    free(this.#memory);
    this.#memory = undefined;
  }

  // Older engines have neither `using` nor this symbol.
  [Symbol.dispose ?? Symbol("dispose")]() {
    this.free();
  }
}
