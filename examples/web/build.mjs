// Builds the page into dist/: its files, and the npm package.

import { cpSync, rmSync } from "node:fs";
import { fileURLToPath } from "node:url";

import { bundle } from "../../bindings/npm/wasm.mjs";

process.chdir(fileURLToPath(new URL(".", import.meta.url)));
rmSync("dist", { recursive: true, force: true });
cpSync("page", "dist", { recursive: true });
bundle("dist/acrobot-rs");
