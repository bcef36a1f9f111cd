// Saves and loads snapshots, which the module reads and writes.

import { call } from "./kept.js";
import { bytes, copied, integers, wasm } from "./wasm.js";

const noMemory = () =>
  new RangeError("WebAssembly's memory of at most 4 GiB has no room for the snapshot");

/** Why the module rejects a snapshot. */
const REASONS = ["another checksum", "another class, version or task", "invalid contents"];

export function save(kept) {
  const length = call(kept, "save");
  if (length === 0) throw noMemory();
  const [at, allocated] = integers();
  const snapshot = bytes(at, length).slice();
  wasm().snapshot_free(at, allocated);
  return snapshot;
}

/** Loads a snapshot, of the same task or of any, or throws. */
export function load(kept, snapshot, anyTask) {
  const copy = copied("the snapshot", snapshot);
  const { length } = copy;
  const at = wasm().snapshot_new(length) >>> 0;
  if (at === 0) throw noMemory();
  bytes(at, length).set(copy);
  try {
    const rejected = call(kept, "load", at, length, anyTask);
    if (rejected === 0) return;
    const rule = "the snapshot must be an undamaged one of the same class, version and task";
    throw new RangeError(`${rule}, got ${length} bytes with ${REASONS[rejected - 1]}`);
  } finally {
    wasm().snapshot_free(at, length);
  }
}
