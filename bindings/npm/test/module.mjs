import assert from "node:assert/strict";
import { gzipSync } from "node:zlib";

/** The bytes with zlib's CRC-32, after which four bytes of length end a gzip file. */
export const sealed = (bytes) => Buffer.concat([bytes, gzipSync(bytes).subarray(-8, -4)]);

/** The same numbers below `n` in each test run, from a linear congruential generator. */
export function randoms() {
  let state = 1;
  return (n) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * n);
  };
}

/** Rows of the error's name, the rule, and pairs of the value in its error's message and a call. */
export function assertRejected(rows, unchanged = () => {}) {
  for (const [name, rule, ...cases] of rows) {
    for (const [value, call] of cases) {
      assert.throws(call, { name, message: `${rule}, got ${value}` });
      unchanged();
    }
  }
}
