// Compiles crates to small WebAssembly modules, and bundles each with its JavaScript: for the package, and for the page of ../../examples/web.

import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateRawSync } from "node:zlib";

const here = fileURLToPath(new URL(".", import.meta.url));
const run = (command, args, env = {}) =>
  execFileSync(command, args, { cwd: here, stdio: "inherit", env: { ...process.env, ...env } });

/** A loop is unrolled fully or not at all, and only up to 16 iterations, the lanes of a batch's block. Fewer functions are inlined. */
const SMALL = ["-unroll-full-max-count=16", "-unroll-allow-partial=false", "-inline-threshold=75"];
/**
 * wasm-opt's passes for smaller code. `--const-hoisting` turns constants that occur often into locals. `--low-memory-unused`
 * is safe because Rust puts nothing below address 1024.
 */
const PASSES = ["--low-memory-unused", "-Os", "--const-hoisting", "-Os", "--strip-debug", "--strip-producers", "--strip-target-features"];

/** Compiles a crate of this workspace to target/`library`.wasm, and returns its bytes. */
function compile(library) {
  const flags = [...SMALL.map((option) => `-Cllvm-args=${option}`), "-Ctarget-feature=+simd128"];
  const args = ["build", "--quiet", "--locked", "--release", "--package", library.replace("_", "-"), "--target-dir", "target"];
  run("cargo", args, { RUSTFLAGS: flags.join(" ") });
  const [text, out] = [`target/${library}.wat`, `target/${library}.wasm`];
  // As text first, for the test that nothing panics: in the binary format, code that is never reached also ends in `unreachable`.
  run("node_modules/.bin/wasm-opt", [`target/wasm32-unknown-unknown/release/${library}.wasm`, "-S", "-o", text, ...PASSES]);
  run("node_modules/.bin/wasm-as", [text, "-o", out, "--all-features"]);
  const module = readFileSync(here + out);
  console.log(`${library}.wasm: ${module.length} bytes`);
  return module;
}

/** The files of the package, and the library of the module that each has inside. */
const ENTRIES = { "index.js": "acrobot_npm", "policies.js": "acrobot_learner" };

/** Writes each file with its module into a folder: a browser loads it with one request. */
export function bundle(folder) {
  for (const [file, library] of Object.entries(ENTRIES)) {
    const module = compile(library);
    // A string, because all bundlers and servers pass strings on unchanged, and a constructor can decode it without waiting.
    const deflated = deflateRawSync(module, { level: 9, memLevel: 9 }).toString("base64");
    const exports = WebAssembly.Module.exports(new WebAssembly.Module(module));
    const names = exports.map(({ name }) => name).join();
    const constants = Object.entries({ LENGTH: module.length, MODULE: deflated, EXPORTS: names });
    const values = constants.map(([name, value]) => `--define:${name}=${JSON.stringify(value)}`);
    // Names stay, for messages and debuggers.
    const options = ["--bundle", "--format=esm", "--target=es2022", "--minify-whitespace", "--minify-syntax", "--log-level=warning"];
    run("node_modules/.bin/esbuild", [`package/${file}`, `--outfile=${resolve(folder, file)}`, ...options, ...values]);
  }
}
