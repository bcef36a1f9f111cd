// Builds the page into dist/: copies its files and compiles three WebAssembly modules.

import { execFileSync } from "node:child_process";
import { cpSync, mkdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

const run = (command, args, env = {}) =>
  execFileSync(command, args, { stdio: "inherit", env: { ...process.env, ...env } });

/** Smaller code: a loop is unrolled fully or not at all, and only up to 16 iterations, the lanes of a batch's block. */
const SMALL = ["-Cllvm-args=-unroll-full-max-count=16", "-Cllvm-args=-unroll-allow-partial=false"];
/**
 * wasm-opt's passes for smaller code. `--const-hoisting` turns constants that occur often into locals. `--low-memory-unused`
 * is safe because Rust puts nothing below address 1024.
 */
const PASSES = ["--low-memory-unused", "-Os", "--const-hoisting", "-Os", "--strip-debug", "--strip-producers", "--strip-target-features"];
/** The WebAssembly features that rustc assumes. Every browser with modules in workers has them. */
const FEATURES = ["bulk-memory", "multivalue", "mutable-globals", "nontrapping-float-to-int", "reference-types", "sign-ext"];

function build(name, { simd128 = false, args = [] }) {
  const folder = `target/${name}`;
  const flags = [...SMALL, ...(simd128 ? ["-Ctarget-feature=+simd128"] : [])];
  const cargo = ["rustc", "--quiet", "--locked", "--release", "--crate-type", "cdylib", "--target-dir", folder, ...args];
  run("cargo", cargo, { RUSTFLAGS: flags.join(" ") });
  const features = [...FEATURES, ...(simd128 ? ["simd"] : [])].map((feature) => `--enable-${feature}`);
  const module = `${folder}/wasm32-unknown-unknown/release/acrobot_web.wasm`;
  const text = `${folder}/acrobot.wat`;
  run("node_modules/.bin/wasm-opt", [module, "-S", "-o", text, ...features, ...PASSES]);
  writeFileSync(text, withVectorsInGlobals(readFileSync(text, "utf8")));
  run("node_modules/.bin/wasm-as", [text, "-o", `dist/${name}.wasm`, ...features]);
  console.log(`${name}.wasm: ${statSync(`dist/${name}.wasm`).size} bytes`);
}

/**
 * Moves vector constants into globals. A vector constant takes 18 bytes wherever it occurs, and V8 compiles it to four
 * instructions. A global takes 2 bytes and a load, so it is better for a constant that occurs three times or more in a
 * function. The global is mutable, because V8 would replace an immutable one by the constant.
 */
function withVectorsInGlobals(text) {
  const vector = /\(v128\.const [^)]*\)/g;
  const globals = [];
  const functions = text.split(/^(?= \(func )/m).map((code) => {
    const found = code.match(vector) ?? [];
    return code.replace(vector, (constant) => {
      if (found.filter((other) => other === constant).length < 3) return constant;
      if (!globals.includes(constant)) globals.push(constant);
      return `(global.get $vector${globals.indexOf(constant)})`;
    });
  });
  const declared = globals.map((constant, number) => ` (global $vector${number} (mut v128) ${constant})\n`);
  return functions.join("").replace(" (global ", `${declared.join("")} (global `);
}

process.chdir(fileURLToPath(new URL(".", import.meta.url)));
rmSync("dist", { recursive: true, force: true });
mkdirSync("dist");
cpSync("page", "dist", { recursive: true });
build("acrobot-simd128", { simd128: true });
build("acrobot", {});
build("simulation", { args: ["--no-default-features"] });
