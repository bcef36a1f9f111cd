import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { gzipSync, inflateRawSync } from "node:zlib";

/** The source with its own instance of the module, whose memory a test can see. */
export async function instance() {
  const bundle = readFileSync(new URL("../dist/index.js", import.meta.url), "utf8");
  globalThis.MODULE = /"([\w+/=]{10000,})"/.exec(bundle)[1];
  globalThis.LENGTH = inflateRawSync(Buffer.from(globalThis.MODULE, "base64")).length;
  const classes = await import("../package/index.js");
  const { wasm } = await import("../package/wasm.js");
  return { ...classes, size: () => wasm().memory.buffer.byteLength };
}

/** The bytes with zlib's CRC-32, after which four bytes of length end a gzip file. */
export const sealed = (bytes) => Buffer.concat([bytes, gzipSync(bytes).subarray(-8, -4)]);

/** A snapshot with other bytes from `start` on, and with the right checksum. */
export function changed(snapshot, start, ...bytes) {
  const content = Buffer.from(snapshot.subarray(0, -4));
  content.set(bytes, start);
  return sealed(content);
}

export const ACTION = "must be 0 (negative torque), 1 (none) or 2 (positive)";
export const SEED = "seed must be an integer from 0 to 2^53 - 1, or a BigInt from 0 to 2^2048 - 1";

/** The same numbers below `n` in each test run, from a linear congruential generator. */
export function randoms() {
  let state = 1;
  return (n) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * n);
  };
}

/** Rows of the error's name, the rule, and pairs of a call and the value in its error's message. */
export function assertRejected(rows, unchanged = () => {}) {
  for (const [name, rule, ...cases] of rows) {
    for (const [value, call] of cases) {
      assert.throws(call, { name, message: `${rule}, got ${value}` });
      unchanged(call);
    }
  }
}
