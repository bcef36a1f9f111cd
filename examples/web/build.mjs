// Builds the page into dist/: its files, and those of the npm package.

import { cpSync, rmSync } from "node:fs";
import { fileURLToPath } from "node:url";

import "../../bindings/npm/build.mjs";

process.chdir(fileURLToPath(new URL(".", import.meta.url)));
rmSync("dist", { recursive: true, force: true });
cpSync("page", "dist", { recursive: true });
for (const file of ["index.js", "policies.js", "control.js"]) {
  cpSync(`../../bindings/npm/dist/${file}`, `dist/acrobot-rs/${file}`);
}
