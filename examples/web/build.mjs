// Builds the page into dist/: copies its files and compiles three WebAssembly modules.

import { cpSync, mkdirSync, rmSync } from "node:fs";
import { fileURLToPath } from "node:url";

import { compile } from "./wasm.mjs";

const build = (name, options) => compile("acrobot_web", `dist/${name}.wasm`, { folder: `target/${name}`, ...options });

process.chdir(fileURLToPath(new URL(".", import.meta.url)));
rmSync("dist", { recursive: true, force: true });
mkdirSync("dist");
cpSync("page", "dist", { recursive: true });
build("acrobot-simd128", { simd128: true });
build("acrobot", {});
build("simulation", { args: ["--no-default-features"] });
