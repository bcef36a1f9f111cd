// Compiles a crate to a small WebAssembly module: the page's, and that of examples/npm. Both run in their own folder.

import { execFileSync } from "node:child_process";
import { readFileSync, statSync, writeFileSync } from "node:fs";
import { basename } from "node:path";

const run = (command, args, env = {}) =>
  execFileSync(command, args, { stdio: "inherit", env: { ...process.env, ...env } });

/** Smaller code: a loop is unrolled fully or not at all, and only up to 16 iterations, the lanes of a batch's block. */
const SMALL = ["-unroll-full-max-count=16", "-unroll-allow-partial=false"];
/**
 * wasm-opt's passes for smaller code. `--const-hoisting` turns constants that occur often into locals. `--low-memory-unused`
 * is safe because Rust puts nothing below address 1024.
 */
const PASSES = ["--low-memory-unused", "-Os", "--const-hoisting", "-Os", "--strip-debug", "--strip-producers", "--strip-target-features"];
/** The WebAssembly features that rustc assumes. Every browser with modules in workers has them. */
const FEATURES = ["bulk-memory", "multivalue", "mutable-globals", "nontrapping-float-to-int", "reference-types", "sign-ext"];

/**
 * Compiles the crate of the current folder, whose library is `library`, to the file `out`. `folder` is cargo's target folder,
 * `args` are further arguments of cargo, and `llvm` of LLVM.
 */
export function compile(library, out, { folder, simd128 = false, args = [], llvm = [] }) {
  const flags = [...SMALL, ...llvm].map((option) => `-Cllvm-args=${option}`);
  if (simd128) flags.push("-Ctarget-feature=+simd128");
  const cargo = ["rustc", "--quiet", "--locked", "--release", "--crate-type", "cdylib", "--target-dir", folder, ...args];
  run("cargo", cargo, { RUSTFLAGS: flags.join(" ") });
  const features = [...FEATURES, ...(simd128 ? ["simd"] : [])].map((feature) => `--enable-${feature}`);
  const module = `${folder}/wasm32-unknown-unknown/release/${library}.wasm`;
  const text = `${folder}/acrobot.wat`;
  run("node_modules/.bin/wasm-opt", [module, "-S", "-o", text, ...features, ...PASSES]);
  writeFileSync(text, withVectorsInGlobals(readFileSync(text, "utf8")));
  run("node_modules/.bin/wasm-as", [text, "-o", out, ...features]);
  console.log(`${basename(out)}: ${statSync(out).size} bytes`);
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
