// Builds the package into dist/, and packs it.

import { execFileSync } from "node:child_process";
import { cpSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { basename } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateRawSync } from "node:zlib";

import { buildSync } from "esbuild";

import { compile } from "../web/wasm.mjs";

process.chdir(fileURLToPath(new URL(".", import.meta.url)));
rmSync("dist", { recursive: true, force: true });
mkdirSync("dist");
// npm shows what users need to know.
writeFileSync("dist/README.md", readFileSync("README.md", "utf8").split("\n## Build and test")[0]);
for (const file of ["package/package.json", "package/index.d.ts", "../../LICENSE-APACHE", "../../LICENSE-MIT"]) {
  cpSync(file, `dist/${basename(file)}`, { dereference: true });
}

const file = "target/acrobot.wasm";
compile("acrobot_npm", file, { folder: "target", simd128: true, llvm: ["-inline-threshold=75"] });
// A string, because all bundlers and servers pass strings on unchanged, and a constructor can decode it without waiting.
const module = readFileSync(file);
const deflated = deflateRawSync(module, { level: 9, memLevel: 9 }).toString("base64");
// One file, which a browser loads with one request. Names stay, for messages and debuggers.
buildSync({
  entryPoints: ["package/index.js"],
  outfile: "dist/index.js",
  bundle: true,
  format: "esm",
  target: "es2022",
  minifyWhitespace: true,
  minifySyntax: true,
  define: { LENGTH: String(module.length), MODULE: JSON.stringify(deflated) },
});
execFileSync("npm", ["pack", "--silent", "./dist"], { stdio: "inherit" });
