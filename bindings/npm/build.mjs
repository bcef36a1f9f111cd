// Builds the package into dist/, and packs it.

import { execFileSync } from "node:child_process";
import { cpSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { basename } from "node:path";
import { fileURLToPath } from "node:url";

import { bundle } from "./wasm.mjs";

process.chdir(fileURLToPath(new URL(".", import.meta.url)));
rmSync("dist", { recursive: true, force: true });
mkdirSync("dist");
// npm shows what users need to know.
writeFileSync("dist/README.md", readFileSync("README.md", "utf8").split("\n## Build and test")[0]);
for (const file of ["package/package.json", "../../LICENSE-APACHE", "../../LICENSE-MIT"]) {
  cpSync(file, `dist/${basename(file)}`, { dereference: true });
}
for (const entry of ["index", "policies"]) {
  // For CommonJS: a file that loads the same module, and the types, which ES modules can import.
  writeFileSync(`dist/${entry}.cjs`, `module.exports = require("./${entry}.js");\n`);
  const types = readFileSync(`package/${entry}.d.ts`, "utf8");
  writeFileSync(`dist/${entry}.d.cts`, types.replace('"./index.js"', '"./index.cjs"'));
  writeFileSync(`dist/${entry}.d.ts`, `export * from "./${entry}.cjs";\n`);
}
bundle("dist");
execFileSync("npm", ["pack", "--silent", "./dist"], { stdio: "inherit" });
