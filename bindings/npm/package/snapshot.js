// Saves and loads snapshots, which the module reads and writes.

import { bytes, copied, integers, text, wasm } from "./wasm.js";

const noMemory = (length) =>
  new RangeError(`a snapshot must fit into WebAssembly's memory of 4 GiB, got ${length} bytes`);

export function save(kind, address) {
  const length = wasm()[`${kind}_save`](address);
  if (length === 0) throw noMemory("too many");
  const [at, allocated] = integers();
  const snapshot = bytes(at, length).slice();
  wasm().snapshot_free(at, allocated);
  return snapshot;
}

/** Calls a function with the address and the length of a copy in the module's memory. */
function lent(snapshot, call) {
  const { length } = snapshot;
  const at = wasm().snapshot_new(length) >>> 0;
  if (at === 0) throw noMemory(length);
  bytes(at, length).set(snapshot);
  try {
    return call(at, length);
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

/** Loads a copy of a snapshot, of the same task or of any, or throws. */
export function load(kind, address, snapshot, anyTask) {
  if (lent(snapshot, (...given) => wasm()[`${kind}_load`](address, ...given, anyTask))) return;
  const [own, got] = [save(kind, address), snapshot].map(described);
  const found = got === own ? "one with invalid contents" : got;
  throw new RangeError(`the snapshot must be a valid one of ${own}, got ${found}`);
}
