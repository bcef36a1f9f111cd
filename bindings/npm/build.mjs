// Builds the package into dist/, and packs it.

import { execFile, execFileSync } from "node:child_process";
import { cpSync, mkdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { basename } from "node:path";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";
import { deflateRawSync } from "node:zlib";

import { buildSync } from "esbuild";

process.chdir(fileURLToPath(new URL(".", import.meta.url)));
const run = (command, args, env) => execFileSync(command, args, { stdio: "inherit", env });
const runBeside = promisify(execFile);

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

/** Compiles this workspace for WebAssembly. */
function compile() {
  const flags = [...SMALL.map((option) => `-Cllvm-args=${option}`), "-Ctarget-feature=+simd128"];
  const env = { ...process.env, RUSTFLAGS: flags.join(" ") };
  // Named, because a user's configuration of Cargo may have others.
  const places = ["--target", "wasm32-unknown-unknown", "--target-dir", "target"];
  run("cargo", ["build", "--workspace", "--quiet", "--locked", "--release", ...places], env);
}

/** Makes a library of the workspace smaller, to target/`library`.wasm, and returns its bytes. */
async function optimize(library) {
  const [text, out] = [`target/${library}.wat`, `target/${library}.wasm`];
  const built = `target/wasm32-unknown-unknown/release/${library}.wasm`;
  const time = (file) => statSync(file, { throwIfNoEntry: false })?.mtimeMs ?? 0;
  if (time(out) < Math.max(time(built), time("build.mjs"), time("package-lock.json"))) {
    // As text first, for the test that nothing panics: in the binary format, code that is never
    // reached also ends in `unreachable`.
    await runBeside("node_modules/.bin/wasm-opt", [built, "-S", "-o", text, ...PASSES]);
    await runBeside("node_modules/.bin/wasm-as", [text, "-o", out, "--all-features"]);
  }
  return readFileSync(out);
}

const ESM = { absWorkingDir: process.cwd(), bundle: true, format: "esm" };

/** Writes a file of the package with its module inside: a browser loads it with one request. */
async function bundle(entry, library) {
  const module = await optimize(library);
  const exports = WebAssembly.Module.exports(new WebAssembly.Module(module));
  const names = exports.map(({ name }) => name);
  // A string, because all bundlers and servers pass strings on unchanged, and a constructor can
  // decode it without waiting.
  const deflated = deflateRawSync(module, { level: 9, memLevel: 9 }).toString("base64");
  buildSync({
    entryPoints: [`package/${entry}.js`],
    outfile: `dist/${entry}.js`,
    ...ESM,
    target: "es2022",
    minifyWhitespace: true,
    minifySyntax: true,
    alias: { "tiny-inflate": "./target/inflate.js" },
    define: { LENGTH: `${module.length}`, MODULE: `"${deflated}"`, EXPORTS: `"${names}"` },
  });
  // For CommonJS: a file that loads the same module, and the types, which ES modules can import.
  writeFileSync(`dist/${entry}.cjs`, `module.exports = require("./${entry}.js");\n`);
  const types = readFileSync(`package/${entry}.d.ts`, "utf8");
  writeFileSync(`dist/${entry}.d.cts`, types.replaceAll('"./index.js"', '"./index.cjs"'));
  writeFileSync(`dist/${entry}.d.ts`, `export * from "./${entry}.cjs";\n`);
}

rmSync("dist", { recursive: true, force: true });
mkdirSync("dist");
// Names of the package stay, for messages and debuggers; those of the decompressor become short.
buildSync({ entryPoints: ["tiny-inflate"], minify: true, outfile: "target/inflate.js", ...ESM });
compile();
await Promise.all([
  bundle("index", "acrobot_npm"),
  bundle("policies", "acrobot_learner"),
  bundle("control", "acrobot_control"),
]);
// npm shows what users need to know.
writeFileSync("dist/README.md", readFileSync("README.md", "utf8").split("\n## Build and test")[0]);
for (const file of ["package/package.json", "../../LICENSE-APACHE", "../../LICENSE-MIT"]) {
  cpSync(file, `dist/${basename(file)}`, { dereference: true });
}
cpSync("node_modules/tiny-inflate/LICENSE", "dist/LICENSE-tiny-inflate");
run("npm", ["pack", "--silent", "./dist"]);
