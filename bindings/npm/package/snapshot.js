// The checksum and the header of a snapshot.

import { copied, invalid } from "./wasm.js";

/** CRC-32 as in zlib. postcard's `crc32` functions append it to a snapshot, too. */
function checksum(bytes) {
  let crc = -1;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; bit++) crc = (crc >>> 1) ^ (crc & 1 && 0xedb88320);
  }
  return ~crc >>> 0;
}

/** Joins the parts of a snapshot, and adds the checksum. */
export function seal(parts) {
  const length = parts.reduce((sum, part) => sum + part.length, 0);
  const snapshot = new Uint8Array(length + 4);
  let at = 0;
  for (const part of parts) {
    snapshot.set(part, at);
    at += part.length;
  }
  new DataView(snapshot.buffer).setUint32(length, checksum(snapshot.subarray(0, length)), true);
  return snapshot;
}

/** A snapshot without its checksum. */
export function unseal(snapshot) {
  const copy = copied("the snapshot", snapshot);
  const content = copy.subarray(0, -4);
  if (seal([content]).some((byte, i) => byte !== copy[i])) {
    const rule = "the snapshot must have the bytes of snapshot()";
    throw new RangeError(`${rule}, got ${copy.length} bytes with another checksum`);
  }
  return content;
}

/** By task, in the order of the module's numbers: the crate's name, and whether it has friction. */
const TASKS = { acrobot: ["gymnasium", 0], swingup: ["swingup", 1] };

/** The module's number of a task. */
export function taskIndex(task) {
  const names = Object.keys(TASKS);
  if (!names.includes(task)) throw invalid(`task must be ${names.join(" or ")}`, task, []);
  return names.indexOf(task);
}

/** The version of the crate's snapshots. */
export const VERSION = 3;

/** The bytes of a header. */
export function head(kind, task) {
  const text = (text) => [text.length, ...Array.from(text, (letter) => letter.charCodeAt(0))];
  const [name, friction] = TASKS[task];
  return [...text(kind), VERSION, ...text(name), ...text("fast"), friction];
}

/** Whether bytes begin with others. */
export const begins = (bytes, others) => others.every((byte, i) => byte === bytes[i]);

/** The task of a snapshot whose header begins at its first byte, or undefined. */
export const taskOf = (kind, bytes) =>
  Object.keys(TASKS).find((task) => begins(bytes, head(kind, task)));

/** The header of a snapshot: texts after their lengths, version and friction. */
export function header(bytes) {
  let at = 0;
  const byte = () => bytes[at++];
  const text = () => {
    const start = at + 1;
    at = start + bytes[at];
    return `"${String.fromCharCode(...bytes.subarray(start, at))}"`;
  };
  const own = `${text()}, version ${byte()}`;
  const rest = `, task ${text()}, arithmetic ${text()}, friction ${[false, true][byte()]}`;
  // Other versions have other fields.
  const form = /^"\w+", version \d+(, task "\w+", arithmetic "[\w ]+", friction (true|false)$)?/;
  return form.exec(own + rest)?.[0] ?? `${bytes.length} other bytes`;
}
