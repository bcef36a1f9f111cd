// The module and the checks of arguments: what the entries share.

import inflate from "tiny-inflate";

// build.mjs defines the MODULE, in DEFLATE and base64, its LENGTH in bytes and its EXPORTS.

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

/** A text of the module. jsdom has no TextDecoder. */
export function decoded(utf8) {
  const codes = Array.from(utf8, (byte) => `%${byte.toString(16).padStart(2, "0")}`);
  return decodeURIComponent(codes.join(""));
}

/** JavaScript's name of a parameter. */
export const camelCase = (name) =>
  name.replace(/_(\w)/g, (_, letter) => letter.toUpperCase());

export const tagOf = (value) => Object.prototype.toString.call(value);

/** An object with its data in private fields. Vue makes no proxies of it, which have none. */
export class Opaque {
  get [Symbol.toStringTag]() {
    return this.constructor.name;
  }
}

/** A copy of a Uint8Array. In jsdom, Node.js's bytes are of another realm. */
export function copied(what, given) {
  if (given?.[Symbol.toStringTag] !== "Uint8Array") {
    throw invalid(`${what} must be a Uint8Array`, given, []);
  }
  return new Uint8Array(given);
}

function shown(value) {
  if (typeof value === "string") return JSON.stringify(value);
  if (typeof value === "bigint") return `${value}n`;
  return Object(value) === value ? tagOf(value) : String(value);
}

/** The error for a value outside its range, which has one of these types, or of another type. */
export function invalid(rule, value, types = ["number"]) {
  const Type = types.includes(typeof value) ? RangeError : TypeError;
  return new Type(`${rule}, got ${shown(value)}`);
}

/** As `invalid`, for a number that the module keeps in single precision. */
export function invalidSingle(rule, value) {
  const error = invalid(rule, value);
  if (Number.isFinite(value) && value !== 0) {
    const single = Math.fround(value);
    const isLost = single === 0 || !Number.isFinite(single);
    if (isLost) error.message += `, which is ${single} in single precision`;
  }
  return error;
}

/** A copy of a plain object that has no properties but `names`. */
export function checked(what, given, names) {
  if (tagOf(given) !== "[object Object]") {
    throw invalid(`${what} must be a plain object`, given, []);
  }
  const copy = { ...given };
  const unknown = Object.keys(copy).find((name) => !names.includes(name));
  if (unknown !== undefined) {
    throw new TypeError(`${what} must be among ${names.join(", ")}, got ${unknown}`);
  }
  return copy;
}

export const isNumber = (value) => typeof value === "number";

export const isFinite32 = (number) => isNumber(number) && Number.isFinite(Math.fround(number));

/** Rejects what is no integer from 1 to 2^bits − 1. */
export function positive(name, value, bits = 32) {
  if (!Number.isInteger(value) || value < 1 || value >= 2 ** bits) {
    throw invalid(`${name} must be an integer from 1 to 2^${bits} - 1`, value);
  }
}

export const randomSeed = () => Math.floor(Math.random() * 2 ** 53);

/** The 32-bit words of a seed, the lowest first. */
export function seedWords(seed, bits = 2048) {
  const isBig = typeof seed === "bigint" && BigInt.asUintN(bits, seed) === seed;
  if (!isBig && !(Number.isSafeInteger(seed) && seed >= 0)) {
    const rule = "seed must be an integer from 0 to 2^53 - 1, or a BigInt from 0 to";
    throw invalid(`${rule} 2^${bits} - 1`, seed, ["number", "bigint"]);
  }
  const words = [];
  let rest = BigInt(seed);
  do {
    words.push(Number(rest & 0xffff_ffffn));
    rest >>= 32n;
  } while (rest > 0n);
  return words;
}
