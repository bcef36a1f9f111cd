// The module and its memory, and the checks of arguments: what the classes share.

import inflate from "tiny-inflate";

// wasm.mjs defines the MODULE, in DEFLATE and base64, its LENGTH in bytes and its EXPORTS.

let compiled;

export function moduleBytes() {
  const deflated = Uint8Array.from(atob(MODULE), (letter) => letter.charCodeAt(0));
  return inflate(deflated, new Uint8Array(LENGTH));
}

export function setModule(module) {
  if (tagOf(module) !== "[object WebAssembly.Module]") {
    throw invalid("module must be a WebAssembly.Module", module, []);
  }
  const names = WebAssembly.Module.exports(module).map(({ name }) => name).join();
  const rule = "module must be compiled from the moduleBytes() of this version";
  if (names !== EXPORTS) throw new TypeError(`${rule}, got one that exports ${names}`);
  compiled = module;
}

/** The functions of a new instance, which a content security policy may reject. */
export function instantiate() {
  try {
    compiled ??= new WebAssembly.Module(moduleBytes());
    return new WebAssembly.Instance(compiled).exports;
  } catch (cause) {
    if (cause instanceof RangeError) throw cause; // no memory
    const needs = "WebAssembly with simd128, and 'wasm-unsafe-eval' in a content security policy";
    throw new Error(`acrobot-rs needs ${needs}: ${cause.message}`, { cause });
  }
}

// Bundlers to CommonJS do not rename a variable `exports`.
let shared;

/** The functions of the one instance that all acrobots share. */
export function wasm() {
  return (shared ??= instantiate());
}

let views = [];

/**
 * The module's words, as unsigned integers and as single-precision numbers. Every view of memory
 * has length 0 once the memory has grown.
 */
function words() {
  if (!views[0]?.length) {
    const { memory, words } = wasm();
    views = [Uint32Array, Float32Array].map((Type) => new Type(memory.buffer, words(), 90));
  }
  return views;
}

export const integers = () => words()[0];
export const numbers = () => words()[1];

/** A part of the module's memory. */
export const bytes = (address, length) => new Uint8Array(wasm().memory.buffer, address, length);

/** The text whose address and length are in the words from `at` on. */
export const text = (at) => decoded(bytes(...integers().subarray(at, at + 2)));

/** A text of the module. jsdom has no TextDecoder. */
export function decoded(utf8) {
  const codes = Array.from(utf8, (byte) => `%${byte.toString(16).padStart(2, "0")}`);
  return decodeURIComponent(codes.join(""));
}

const TypedArray = Object.getPrototypeOf(Uint8Array.prototype);
const { get } = Object.getOwnPropertyDescriptor(TypedArray, Symbol.toStringTag);
/** The type's name of a typed array of any realm, or undefined for other values and proxies. */
export const typeOf = (value) => get.call(value);

/** The error where a method's `this` has no private fields. */
export const foreign = (classes, value) => {
  const rule = "must be called on the object itself, not on a proxy or a copy";
  return invalid(`methods of ${classes} ${rule}`, value, []);
};

function toJSON() {
  const by = this.snapshot ? "snapshot()" : this.save ? "save()" : "the file it was made of";
  const { name } = this.constructor;
  throw new TypeError(`${name} must be saved by ${by}, not by JSON or structuredClone`);
}

/** An object whose data are in private fields. Copies and proxies have none of them. */
export class Opaque {
  /** An own property, because `structuredClone` ignores methods, and rejects functions. */
  toJSON = toJSON;

  /** For error messages. Vue makes proxies only of what is called Object, as without this. */
  get [Symbol.toStringTag]() {
    return this.constructor.name;
  }
}

/** A copy of a Uint8Array: other threads may write shared memory, and a proxy can run code. */
export function copied(what, given) {
  const valid = typeOf(given) === "Uint8Array" || given instanceof Uint8Array;
  if (!valid) throw invalid(`${what} must be a Uint8Array`, given, []);
  const copy = new Uint8Array(given.length);
  for (let i = 0; i < copy.length; i++) copy[i] = given[i];
  return copy;
}

const tagOf = (value) => Object.prototype.toString.call(value);

/** A value in an error message. */
function shown(value) {
  if (typeof value === "function") return "a function";
  if (typeof value === "bigint") return `${value}n`;
  if (Object.is(value, -0)) return "-0";
  if (typeof value !== "string" && Object(value) !== value) return String(value);
  const tag = tagOf(value);
  // JSON has neither NaN and infinity, nor -0 and undefined.
  const isMarked = (each) => typeof each === "number" || each === undefined;
  const marked = (_, each) => (isMarked(each) ? `\0${shown(each)}\0` : each);
  try {
    const json = () => JSON.stringify(value, marked).replace(/"\\u0000(.*?)\\u0000"/g, "$1");
    const text = / (Object|Array|String)]/.test(tag) ? json() : tag;
    return text.replace(/^(.{80}).+/su, "$1…"); // whole characters, whatever their length
  } catch {
    return tag; // a cycle, a BigInt
  }
}

/** The error for a value outside its range, which has one of these types, or of another type. */
export function invalid(rule, value, types = ["number"], note = "") {
  const Type = types.includes(typeof value) ? RangeError : TypeError;
  return new Type(`${rule}, got ${shown(value)}${note}`);
}

/** The error for a number whose single precision is outside its range, or for another value. */
export function invalidSingle(rule, value) {
  const single = typeof value === "number" ? Math.fround(value) : value;
  const lost = Number.isFinite(value) && value !== 0 && (single === 0 || !Number.isFinite(single));
  return invalid(rule, value, ["number"], lost ? `, which is ${single} in single precision` : "");
}

/** Whether an object is of no class, in any realm. */
function isPlain(object) {
  const prototype = Object.getPrototypeOf(object);
  return prototype === null || Object.getPrototypeOf(prototype) === null;
}

/**
 * A copy of an object with no properties but `names`. Each is read once, because that can run code
 * of the caller, which may change the module's memory.
 */
export function checked(what, given, names) {
  const isObject = / (Object|Module)]/.test(tagOf(given));
  const found = isObject ? names.filter((name) => name in given) : [];
  // An object of a class may have the names. Without them it is not meant as `{}`.
  if (found.length === 0 && !(isObject && isPlain(given))) {
    throw invalid(`${what} must be a plain object`, given, []);
  }
  const unknown = Object.keys(given).find((name) => !names.includes(name));
  if (unknown !== undefined) {
    throw new TypeError(`${what} must be among ${names.join(", ")}, got ${unknown}`);
  }
  return Object.fromEntries(found.map((name) => [name, given[name]]));
}

/** An integer from 1 to 2³² − 1. */
export function positive(name, value) {
  if (!Number.isInteger(value) || value < 1 || value >= 2 ** 32) {
    throw invalid(`${name} must be an integer from 1 to 2^32 - 1`, value);
  }
  return value;
}

/** The 32-bit words of a seed, the lowest first. Without a seed takes a random one. */
export function seedWords(seed = Math.floor(Math.random() * 2 ** 53)) {
  const isSeed = Number.isSafeInteger(seed) || (typeof seed === "bigint" && seed < 1n << 2048n);
  if (!isSeed || seed < 0) {
    const rule = "seed must be an integer from 0 to 2^53 - 1, or a BigInt from 0 to 2^2048 - 1";
    throw invalid(rule, seed, ["number", "bigint"]);
  }
  const words = [];
  let rest = BigInt(seed);
  do {
    words.push(Number(rest & 0xffff_ffffn));
    rest >>= 32n;
  } while (rest > 0n);
  return words;
}

/** Writes a seed into the module's words. Returns their number. */
export function writeSeed(seed) {
  const words = seedWords(seed);
  integers().set(words);
  return words.length;
}

/**
 * Throws if the module has rejected numbers. `given` has those of the caller by their names, as
 * numbers or in arrays.
 */
export function accept(kind, given = {}) {
  if (kind === 0) return;
  const shared = "ownParams must be true for parameters of each acrobot";
  if (kind === 3) throw invalid(shared, false, ["boolean"]);
  const [value] = numbers();
  const camel = (_, letter) => letter.toUpperCase();
  const name = text(1).replace(".joint", "").replace(/_(\w)/g, camel);
  const friction = '0 unless the task is "swingup", in N m s/rad';
  const rule = kind === 2 ? friction : `${text(3)} ${text(5)}`;
  // That which the caller gave, before it was rounded.
  const own = [given[name]].flat().find((number) => Object.is(Math.fround(number), value));
  throw invalidSingle(`${name} must be ${rule}`, own ?? value);
}
