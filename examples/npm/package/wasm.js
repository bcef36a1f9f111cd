// The module and its memory, and the checks of arguments: what the classes share.

import { inflate } from "./inflate.js";

/* global LENGTH, MODULE: wasm.mjs defines the module's length in bytes, and the module in DEFLATE and base64. */

let compiled;

/** The functions of a new instance. A content security policy rejects the module, or in WebKit its instance. */
export function instantiate() {
  try {
    compiled ??= new WebAssembly.Module(inflate(Uint8Array.from(atob(MODULE), (letter) => letter.charCodeAt(0)), LENGTH));
    return new WebAssembly.Instance(compiled).exports;
  } catch (cause) {
    if (cause instanceof RangeError) throw cause; // no memory
    const needs = "WebAssembly with simd128, and 'wasm-unsafe-eval' in a content security policy";
    throw new Error(`acrobot-rs needs ${needs}: ${cause.message}`, { cause });
  }
}

let exports;

/** The functions of the one instance that all acrobots share. */
export function wasm() {
  return (exports ??= instantiate());
}

let numbersView = new Float32Array();
let bytesView = new Uint8Array();

/** The memory for six numbers. Like every view of the module's memory, it has length 0 once that memory has grown. */
export function numbers() {
  if (numbersView.length === 0) numbersView = new Float32Array(wasm().memory.buffer, wasm().bytes(), 6);
  return numbersView;
}

/** The same memory, as 256 bytes. */
export function bytes() {
  if (bytesView.length === 0) bytesView = new Uint8Array(wasm().memory.buffer, wasm().bytes(), 256);
  return bytesView;
}

/** A value in an error message. */
function shown(value) {
  if (typeof value === "function") return "a function";
  if (typeof value === "bigint") return `${value}n`;
  if (typeof value !== "string" && Object(value) !== value) return String(value);
  const tag = Object.prototype.toString.call(value);
  try {
    const text = / (Object|Array|String)]/.test(tag) ? JSON.stringify(value) : tag;
    return text.length > 80 ? `${text.slice(0, 80)}…` : text;
  } catch {
    return tag; // a cycle, a BigInt
  }
}

/** The error for a value outside its range, which has one of these types, or of another type. */
export function invalid(rule, value, types = ["number"]) {
  return new (types.includes(typeof value) ? RangeError : TypeError)(`${rule}, got ${shown(value)}`);
}

/**
 * A copy of `given`, which must be an object without other properties than `names`. Each is read once, because that can run code of the
 * caller, which may use the package and change the module's memory.
 */
export function checked(what, given, names) {
  if (typeof given !== "object" || given === null || Array.isArray(given)) throw invalid(`${what} must be an object`, given, []);
  const unknown = Object.keys(given).find((name) => !names.includes(name));
  if (unknown !== undefined) throw new TypeError(`${what} must be among ${names.join(", ")}, got ${unknown}`);
  return Object.fromEntries(names.filter((name) => name in given).map((name) => [name, given[name]]));
}

/** An integer from 1 to 2³² − 1. */
export function positive(name, value) {
  if (!Number.isInteger(value) || value < 1 || value >= 2 ** 32) throw invalid(`${name} must be an integer from 1 to 2^32 - 1`, value);
  return value;
}

/** The 32-bit words of a seed, the lowest first. Without a seed takes a random one. */
export function seedWords(seed = Math.floor(Math.random() * 2 ** 53)) {
  const valid = typeof seed === "bigint" ? seed >= 0n && seed < 1n << 2048n : Number.isSafeInteger(seed) && seed >= 0;
  if (!valid) throw invalid("seed must be an integer from 0 to 2^53 - 1, or a BigInt from 0 to 2^2048 - 1", seed, ["number", "bigint"]);
  const words = [];
  let rest = BigInt(seed);
  do {
    words.push(Number(rest & 0xffff_ffffn));
    rest >>= 32n;
  } while (rest > 0n);
  return words;
}

/** Writes a seed into the module's memory. Returns the number of words. */
export function writeSeed(seed) {
  const words = seedWords(seed);
  bytes().set(new Uint8Array(Uint32Array.from(words).buffer));
  return words.length;
}

/** Throws if the module has rejected numbers: then `length` is that of the reason. `valueOf` returns the number with a name. */
export function accept(length, valueOf) {
  if (length === 0) return;
  const [name, rule, unit] = new TextDecoder().decode(bytes().slice(0, length)).split("\n");
  const camel = name.replace(/_(\w)/g, (_, letter) => letter.toUpperCase());
  const value = valueOf(camel);
  const rounded = Math.fround(value);
  const lost = Number.isFinite(value) && value !== 0 && (rounded === 0 || !Number.isFinite(rounded));
  throw new RangeError(`${camel} must be ${rule} ${unit}, got ${value}${lost ? `, which is ${rounded} in single precision` : ""}`);
}
