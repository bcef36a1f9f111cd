// Builds the page into dist/: its files as they stand, and three modules.

import { execFileSync } from "node:child_process";
import { cpSync, mkdirSync, rmSync, statSync } from "node:fs";

const run = (command, args, env = {}) =>
  execFileSync(command, args, { cwd: import.meta.dirname, stdio: "inherit", env: { ...process.env, ...env } });

/** For size: no loop is unrolled but whole, none of more turns than a batch's block has lanes, and none made of vectors. */
const SMALL = ["-Cllvm-args=-unroll-full-max-count=8", "-Cllvm-args=-unroll-allow-partial=false", "-Cno-vectorize-loops"];
/** Of wasm-opt's passes those for size, and constants that stand often as locals. Rust puts nothing below address 1024. */
const PASSES = ["--low-memory-unused", "-Os", "--const-hoisting", "-Os", "--strip-debug", "--strip-producers", "--strip-target-features"];
/** What Rust's compiler takes for granted in WebAssembly, which every browser with modules in workers has. */
const FEATURES = ["bulk-memory", "multivalue", "mutable-globals", "nontrapping-float-to-int", "reference-types", "sign-ext"];

function build(name, { simd128 = false, args = [] }) {
  const folder = `target/${name}`;
  const flags = [...SMALL, ...(simd128 ? ["-Ctarget-feature=+simd128"] : [])];
  run("cargo", ["build", "--quiet", "--locked", "--release", "--target-dir", folder, ...args], { RUSTFLAGS: flags.join(" ") });
  const features = [...FEATURES, ...(simd128 ? ["simd"] : [])].map((feature) => `--enable-${feature}`);
  const module = `${folder}/wasm32-unknown-unknown/release/acrobot_web.wasm`;
  run("node_modules/.bin/wasm-opt", [module, "-o", `dist/${name}.wasm`, ...features, ...PASSES]);
  console.log(`${name}.wasm: ${statSync(new URL(`dist/${name}.wasm`, import.meta.url)).size} bytes`);
}

process.chdir(import.meta.dirname);
rmSync("dist", { recursive: true, force: true });
mkdirSync("dist");
cpSync("page", "dist", { recursive: true });
build("acrobot-simd128", { simd128: true });
build("acrobot", {});
build("simulation", { args: ["--no-default-features"] });
