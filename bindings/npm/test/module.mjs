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

/** The bytes with their CRC-32 as zlib computes it: the end of a gzip file has it, before four bytes of length. */
export const sealed = (bytes) => Buffer.concat([bytes, gzipSync(bytes).subarray(-8, -4)]);
