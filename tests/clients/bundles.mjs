// Bundles a program with each bundler, in each format, minified or not, and runs the bundles.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { promisify } from "node:util";

import nodeResolve from "@rollup/plugin-node-resolve";
import { rollup } from "rollup";
import * as vite from "vite";
import webpack from "webpack";

const PROGRAM = `
import { Acrobot, Batch } from "acrobot-rs";
import { bangBang } from "acrobot-rs/policies";
const acrobot = new Acrobot({ seed: 42 });
while (!acrobot.step(bangBang(acrobot)).terminated);
const { rewards } = new Batch({ count: 1 }).step([2]);
console.log(acrobot.elapsedSteps, rewards[0]);
`;
const PRINTED = "94 -1\n";
const input = resolve("program.mjs");
writeFileSync(input, PROGRAM);

/** Each writes the bundle to a file of this folder. The package's own tests have esbuild. */
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
    const library = { type: "commonjs2" };
    const stats = await promisify(webpack)({
      mode: "production",
      target: "node20",
      entry: input,
      output: { path: resolve(), filename, ...{ esm, cjs: { library } }[format] },
      optimization: { minimize },
      experiments: { outputModule: format === "esm" },
    });
    assert.ok(!stats.hasErrors(), stats.toString());
  },
};

for (const [bundler, bundle] of Object.entries(BUNDLERS)) {
  for (const format of ["esm", "cjs", "iife"]) {
    // Rollup alone does not minify.
    for (const minify of bundler === "rollup" ? [false] : [false, true]) {
      const type = format === "esm" ? "mjs" : "cjs";
      const file = `${bundler}-${format}${minify ? "-min" : ""}.${type}`;
      await bundle(file, format, minify);
      assert.equal(execFileSync("node", [file], { encoding: "utf8" }), PRINTED, file);
      console.log(`${file} runs`);
    }
  }
}
