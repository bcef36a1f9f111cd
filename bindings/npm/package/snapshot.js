// Saves and loads snapshots, which the module reads and writes.

import { call } from "./kept.js";
import { bytes, integers, text, wasm } from "./wasm.js";

const noMemory = () =>
  new RangeError("WebAssembly's memory of at most 4 GiB has no room for the snapshot");

export function save(kept) {
  const length = call(kept, "save");
  if (length === 0) throw noMemory();
  const [at, allocated] = integers();
  const snapshot = bytes(at, length).slice();
  wasm().snapshot_free(at, allocated);
  return snapshot;
}

/** Calls a function with the address and the length of a copy in the module's memory. */
function lent(snapshot, use) {
  const { length } = snapshot;
  const at = wasm().snapshot_new(length) >>> 0;
  if (at === 0) throw noMemory();
  bytes(at, length).set(snapshot);
  try {
    return use(at, length);
  } finally {
    wasm().snapshot_free(at, length);
  }
}

/** What a snapshot says that it is. */
const described = (snapshot) =>
  lent(snapshot, (...given) => {
    const found = wasm().snapshot_header(...given);
    const what = ["bytes with another checksum", "other bytes"][found];
    if (what) return `${snapshot.length} ${what}`;
    const [version, friction] = integers();
    const names = `task "${text(4)}", arithmetic "${text(6)}", friction ${friction === 1}`;
    return `"${text(2)}", version ${version}, ${names}`;
  });

/** Loads a snapshot, of the same task or of any, or throws. */
export function load(kept, snapshot, anyTask) {
  if (lent(snapshot, (...given) => call(kept, "load", ...given, anyTask))) return;
  const [own, got] = [save(kept), snapshot].map(described);
  const found = got === own ? "one with invalid contents" : got;
  throw new RangeError(`the snapshot must be a valid one of ${own}, got ${found}`);
}
