// Bundles the programs of docs/wasm.md with each bundler, in each format, minified or not, and runs
// the bundles. The package's own tests have esbuild.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { promisify } from "node:util";

import nodeResolve from "@rollup/plugin-node-resolve";
import { rollup } from "rollup";
import * as vite from "vite";
import webpack from "webpack";

const page = readFileSync(process.argv[2], "utf8");
const programs = [...page.matchAll(/^```js\n(.*?)^```/gms)].map(([, code]) => code);
const printed = programs.map((code) => /^\/\/ prints: (.*)/m.exec(code)[1]);
for (const entry of ["", "/control", "/policies"]) {
  assert.ok(programs.join().includes(`from "acrobot-rs${entry}"`), `acrobot-rs${entry}`);
}
programs.forEach((code, i) => writeFileSync(`program${i}.mjs`, code));
const input = resolve("programs.mjs");
writeFileSync(input, programs.map((_, i) => `import "./program${i}.mjs";\n`).join(""));
writeFileSync("printed.json", JSON.stringify(printed)); // for Vitest

/** Each writes the bundle to a file of this folder. */
const BUNDLERS = {
  rollup: async (file, format) => {
    const bundle = await rollup({ input, plugins: [nodeResolve()] });
    await bundle.write({ file, format });
  },
  vite: (file, format, minify) => {
    const lib = { entry: input, formats: [format], name: "program", fileName: () => file };
    const build = { lib, minify, outDir: ".", emptyOutDir: false };
    return vite.build({ logLevel: "error", build });
  },
  webpack: async (filename, format, minimize) => {
    const esm = { module: true, chunkFormat: "module" };
    const stats = await promisify(webpack)({
      mode: "production",
      target: "node18",
      entry: input,
      output: { path: resolve(), filename, ...(format === "esm" ? esm : {}) },
      optimization: { minimize },
      experiments: { outputModule: format === "esm" },
    });
    assert.ok(!stats.hasErrors(), stats.toString());
  },
};

for (const [bundler, bundle] of Object.entries(BUNDLERS)) {
  for (const format of ["esm", "cjs"]) {
    // Rollup alone does not minify.
    for (const minify of bundler === "rollup" ? [false] : [false, true]) {
      const file = `${bundler}${minify ? "-min" : ""}.${format === "esm" ? "mjs" : "cjs"}`;
      await bundle(file, format, minify);
      const lines = execFileSync("node", [file], { encoding: "utf8" }).trim().split("\n");
      assert.deepEqual(lines, printed, file);
      console.log(`${file} runs`);
    }
  }
}
