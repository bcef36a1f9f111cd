// Compiles crates to small WebAssembly modules, and bundles each with its JavaScript: for the
// package, and for the page of ../../examples/web.

import { execFileSync } from "node:child_process";
import { cpSync, readFileSync, statSync } from "node:fs";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateRawSync } from "node:zlib";

import { buildSync } from "esbuild";

const here = fileURLToPath(new URL(".", import.meta.url));
const run = (command, args, env) =>
  execFileSync(command, args, { cwd: here, stdio: "inherit", env });

/**
 * A loop is unrolled fully or not at all, and only up to 3 iterations: loops over the 4 lanes of a
 * batch's block become vectors instead. Fewer functions are inlined.
 */
const SMALL = ["-unroll-full-max-count=3", "-unroll-allow-partial=false", "-inline-threshold=10"];
/**
 * wasm-opt's passes for smaller code. `--const-hoisting` turns constants that occur often into
 * locals. `--low-memory-unused` is safe because Rust puts nothing below address 1024.
 */
const PASSES = [
  "--low-memory-unused", "-Os", "--const-hoisting", "-Os",
  "--strip-debug", "--strip-producers", "--strip-target-features",
];

/** Compiles a crate of this workspace to target/`library`.wasm, and returns its bytes. */
function compile(library) {
  const flags = [...SMALL.map((option) => `-Cllvm-args=${option}`), "-Ctarget-feature=+simd128"];
  // Named, because a user's configuration of Cargo may have others.
  const places = ["--target", "wasm32-unknown-unknown", "--target-dir", "target"];
  const args = ["--quiet", "--locked", "--release", ...places];
  const env = { ...process.env, RUSTFLAGS: flags.join(" ") };
  run("cargo", ["build", "--package", library.replace("_", "-"), ...args], env);
  const [text, out] = [`target/${library}.wat`, `target/${library}.wasm`];
  const built = `target/wasm32-unknown-unknown/release/${library}.wasm`;
  const time = (file) => statSync(here + file, { throwIfNoEntry: false })?.mtimeMs ?? 0;
  if (time(out) < Math.max(time(built), time("wasm.mjs"), time("package-lock.json"))) {
    // As text first, for the test that nothing panics: in the binary format, code that is never
    // reached also ends in `unreachable`.
    run("node_modules/.bin/wasm-opt", [built, "-S", "-o", text, ...PASSES]);
    run("node_modules/.bin/wasm-as", [text, "-o", out, "--all-features"]);
  }
  const module = readFileSync(here + out);
  console.log(`${library}.wasm: ${module.length} bytes`);
  return module;
}

/** The files of the package, and the library of the module that each has inside. */
const ENTRIES = { "index.js": "acrobot_npm", "policies.js": "acrobot_learner" };

const build = (options) =>
  buildSync({ absWorkingDir: here, bundle: true, format: "esm", ...options });

/** Writes each file with its module into a folder: a browser loads it with one request. */
export function bundle(folder) {
  // Names of the package stay, for messages and debuggers; those of the decompressor become short.
  build({ entryPoints: ["tiny-inflate"], minify: true, outfile: "target/inflate.js" });
  for (const [file, library] of Object.entries(ENTRIES)) {
    const module = compile(library);
    const exports = WebAssembly.Module.exports(new WebAssembly.Module(module));
    const names = exports.map(({ name }) => name);
    // A string, because all bundlers and servers pass strings on unchanged, and a constructor can
    // decode it without waiting.
    const deflated = deflateRawSync(module, { level: 9, memLevel: 9 }).toString("base64");
    build({
      entryPoints: [`package/${file}`],
      outfile: resolve(folder, file),
      target: "es2022",
      minifyWhitespace: true,
      minifySyntax: true,
      alias: { "tiny-inflate": "./target/inflate.js" },
      define: { LENGTH: `${module.length}`, MODULE: `"${deflated}"`, EXPORTS: `"${names}"` },
    });
  }
  cpSync(`${here}node_modules/tiny-inflate/LICENSE`, join(folder, "LICENSE-tiny-inflate"));
}
