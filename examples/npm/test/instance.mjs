import { readFileSync } from "node:fs";
import { inflateRawSync } from "node:zlib";

/** The source with its own instance of the module, whose memory a test can see. */
export async function instance() {
  const bundle = readFileSync(new URL("../dist/index.js", import.meta.url), "utf8");
  globalThis.MODULE = /"([\w+/=]{10000,})"/.exec(bundle)[1];
  globalThis.LENGTH = inflateRawSync(Buffer.from(globalThis.MODULE, "base64")).length;
  const classes = await import("../package/index.js");
  const { wasm } = await import("../package/wasm.js");
  return { ...classes, size: () => wasm().memory.buffer.byteLength };
}
