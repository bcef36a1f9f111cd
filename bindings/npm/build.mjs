// Builds the package into dist/, and packs it.

import { execFile, execFileSync } from "node:child_process";
import {
  cpSync, mkdirSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync,
} from "node:fs";
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
const VECTORS = [
  "-Cllvm-args=-unroll-full-max-count=3", "-Cllvm-args=-unroll-allow-partial=false",
  "-Cllvm-args=-inline-threshold=60", "-Copt-level=2",
];
const ESM = { absWorkingDir: process.cwd(), bundle: true, format: "esm" };
/**
 * wasm-opt's passes for smaller code. `--const-hoisting` turns constants that occur often into
 * locals. `--low-memory-unused` is safe because Rust puts nothing below address 1024.
 */
const PASSES = [
  "--low-memory-unused", "-Os", "--const-hoisting", "-Os",
  "--strip-debug", "--strip-producers", "--strip-target-features",
];

/** Compiles an entry's crate for WebAssembly, and makes the module smaller. Returns its bytes. */
async function compile(entry, name, crate, library, flags, options) {
  const env = { ...process.env, RUSTFLAGS: ["-Ctarget-feature=+simd128", ...flags].join(" ") };
  // Named, because a user's configuration of Cargo may have others.
  const places = ["--target", "wasm32-unknown-unknown", "--target-dir", `target/${name}`];
  const common = ["--manifest-path", `${crate}/Cargo.toml`, "--quiet", "--locked", "--release"];
  run("cargo", ["rustc", ...common, ...places, "--crate-type", "cdylib", ...options], env);
  const built = `target/${name}/wasm32-unknown-unknown/release/${library}.wasm`;
  const [graph, text, out] = ["json", "wat", "wasm"].map((type) => `target/${name}.${type}`);
  const roots = JSON.stringify(used(entry, built));
  const time = (file) => statSync(file, { throwIfNoEntry: false })?.mtimeMs ?? 0;
  if (time(graph) === 0 || readFileSync(graph, "utf8") !== roots) writeFileSync(graph, roots);
  const inputs = [built, graph, "build.mjs", "package-lock.json"];
  if (time(out) < Math.max(...inputs.map(time))) {
    const binaryen = (tool, ...args) => runBeside(`node_modules/.bin/${tool}`, args);
    const reached = `${text}.wasm`;
    await binaryen("wasm-metadce", built, "--graph-file", graph, "-o", reached, "--all-features");
    // As text first, for the test that nothing panics: in the binary format, code that is never
    // reached also ends in `unreachable`.
    await binaryen("wasm-opt", reached, "-S", "-o", text, ...PASSES);
    await binaryen("wasm-as", text, "-o", out, "--all-features");
  }
  return readFileSync(out);
}

/** The exports that an entry names, or whose prefix it quotes, as roots for wasm-metadce. */
function used(entry, built) {
  const entryPoints = [`package/${entry}.js`];
  const { metafile } = buildSync({ ...ESM, entryPoints, metafile: true, write: false });
  const code = Object.keys(metafile.inputs).map((file) => readFileSync(file, "utf8")).join();
  const names = new Set(code.match(/\w+/g));
  const prefixes = code.match(/(?<=")acrobot\w*_estimator(?=")/g) ?? [];
  return WebAssembly.Module.exports(new WebAssembly.Module(readFileSync(built)))
    .filter(({ name }) => names.has(name) || prefixes.some((each) => name.startsWith(each)))
    .map(({ name }) => ({ name, root: true, export: name }));
}

/** Compiles the functions of bindings/abi with a feature. */
const compileAbi = (entry, name, flags) =>
  compile(entry, name, "../abi", "acrobot", flags, ["--no-default-features", "--features", name]);

/** Writes a file of the package with its module inside: a browser loads it with one request. */
async function bundle(entry, compiled) {
  const module = await compiled;
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
await Promise.all([
  bundle("index", compileAbi("index", "acrobots", VECTORS)),
  bundle("instruments", compileAbi("instruments", "instruments", VECTORS)),
  bundle("control", compileAbi("control", "control", ["-Copt-level=s"])),
  bundle("policies", compile("policies", "learner", "learner", "acrobot_learner", VECTORS, [])),
]);
// npm shows what users need to know.
writeFileSync("dist/README.md", readFileSync("README.md", "utf8").split("\n## Build and test")[0]);
for (const file of ["package/package.json", "../../LICENSE-APACHE", "../../LICENSE-MIT"]) {
  cpSync(file, `dist/${basename(file)}`, { dereference: true });
}
cpSync("node_modules/tiny-inflate/LICENSE", "dist/LICENSE-tiny-inflate");
run("npm", ["pack", "--silent", "./dist"]);
