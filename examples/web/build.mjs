// Builds the page into dist/: its files, the npm package, and the learner.

import { cpSync, rmSync } from "node:fs";
import { fileURLToPath } from "node:url";

import { bundle, compile } from "../npm/wasm.mjs";

process.chdir(fileURLToPath(new URL(".", import.meta.url)));
rmSync("dist", { recursive: true, force: true });
cpSync("page", "dist", { recursive: true });
bundle("dist/acrobot.js");
cpSync(compile(".", "acrobot_web"), "dist/learner.wasm");
