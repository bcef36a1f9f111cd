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
for (const file of ["package/package.json", "package/index.d.ts", "../../LICENSE-APACHE", "../../LICENSE-MIT"]) {
  cpSync(file, `dist/${basename(file)}`, { dereference: true });
}
bundle("dist/index.js");
execFileSync("npm", ["pack", "--silent", "./dist"], { stdio: "inherit" });
