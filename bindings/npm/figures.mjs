// Builds the package, and prints its rows of docs/wasm.md: sizes, and steps per second in Node.js.

import { execFileSync } from "node:child_process";
import { readFileSync, statSync } from "node:fs";
import { gzipSync } from "node:zlib";

import "./build.mjs";

const { Acrobot, Batch } = await import("./dist/index.js");
const kilobytes = (bytes) => `${(bytes / 1000).toFixed(1)} KB`;

/** Steps per second in the best of ten rounds, because other programs may use the machine too. */
function fastest(steps, run) {
  let best = Infinity;
  for (let round = 0; round < 10; round++) {
    const start = performance.now();
    run();
    best = Math.min(best, performance.now() - start);
  }
  return `${(steps / best / 1000).toPrecision(3)} million steps/s`;
}

const acrobot = new Acrobot({ seed: 42 });
const single = fastest(500_000, () => {
  for (let i = 0; i < 500_000; i++) {
    const { terminated, truncated } = acrobot.step(i % 3);
    if (terminated || truncated) acrobot.reset();
  }
});
const batch = new Batch({ seed: 42, count: 1024 });
const actions = Uint8Array.from({ length: 1024 }, (_, i) => i % 3);
const many = fastest(1024 * 2000, () => {
  for (let i = 0; i < 2000; i++) batch.step(actions);
});

const size = (path) => {
  const code = readFileSync(path);
  return `${kilobytes(code.length)}, with gzip ${kilobytes(gzipSync(code).length)}`;
};
const control = kilobytes(statSync("target/control.wasm").size);
const instruments = kilobytes(statSync("target/instruments.wasm").size);
const report = execFileSync("npm", ["pack", "--json", "--dry-run", "./dist"]);
const [{ size: packed, unpackedSize }] = JSON.parse(report);
console.log(`
| on one core, in Node.js ${process.versions.node.split(".")[0]} | |
|---|---|
| WebAssembly module, with simd128 | ${kilobytes(statSync("target/acrobots.wasm").size)} |
| \`index.js\`, with the module inside | ${size("dist/index.js")} |
| \`policies.js\`, with the learner's inside | ${size("dist/policies.js")} |
| \`control.js\`, with a module of ${control} inside | ${size("dist/control.js")} |
| \`instruments.js\`, with a module of ${instruments} inside | ${size("dist/instruments.js")} |
| package, with types and licences | ${kilobytes(unpackedSize)}, packed ${kilobytes(packed)} |
| \`Acrobot.step\` | ${single} |
| \`Batch.step\` of 1,024, with observations | ${many} |`);
