// Measures size and speed of the page, and native speed in the same run. Prints the table of docs/wasm.md:
// `npm run figures`. `npm run figures -- --update` also writes it there.

import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";

import { chromium } from "playwright-core";

import { launch } from "./browser.mjs";
import { serve } from "./serve.mjs";

const DOCUMENT = new URL("../../docs/wasm.md", import.meta.url);
const HEAD = "| on one core | in the browser | native, in the same run |";
/** Rounds of all measurements. Medians count, because other programs may use the machine too. */
const ROUNDS = 3;

/** Steps per second of the native program. */
function native() {
  const args = ["run", "--release", "--quiet", "--locked", "--example", "throughput"];
  const text = execFileSync("cargo", args, { cwd: new URL("../..", import.meta.url), encoding: "utf8" });
  const rate = (name) => Number(new RegExp(`^${name} (\\d+)`, "m").exec(text)[1]);
  return { nativeScalar: rate("scalar_fast"), nativeBatch: rate("batch_fast_1024") };
}

/** Milliseconds, and numbers per second or minute, from the page's own measurements. */
async function inBrowser(browser, address) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  await page.goto(address);
  await page.waitForSelector("#app:not([hidden])");
  const read = async (id) => Number.parseFloat(await page.textContent(`#${id}`));
  const firstFrame = await page.evaluate(
    () => new Promise((resolve) => new PerformanceObserver((list) => resolve(list.getEntriesByName("first frame")[0].duration)).observe({ type: "measure", buffered: true })),
  );
  // For two seconds the page only plays.
  const frames = await page.evaluate(async () => {
    const start = performance.now();
    let frames = 0;
    while (performance.now() - start < 2000) {
      await new Promise(requestAnimationFrame);
      frames++;
    }
    return frames / 2;
  });
  const [physics, drawing] = [await read("physics"), await read("drawing")];
  await page.click("#measure");
  await page.waitForFunction(() => !document.querySelector("#measure").disabled);
  const [scalar, batch] = [(await read("scalar")) * 1e6, (await read("batch")) * 1e6];
  await page.fill("#episodes", "5000");
  await page.click("#train");
  await page.waitForFunction(() => document.querySelector("#train").textContent === "Train");
  const [, episodes] = /([\d,]+) episodes per minute/.exec(await page.textContent("#training-status"));
  await page.close();
  return { firstFrame, frames, physics, drawing, scalar, batch, training: Number(episodes.replaceAll(",", "")) };
}

const server = await serve(0);
const browser = await launch(chromium);
const version = browser.version();
const rounds = [];
for (let round = 0; round < ROUNDS; round++) {
  rounds.push({ ...native(), ...(await inBrowser(browser, `http://localhost:${server.address().port}/`)) });
}
await browser.close();
server.close();

const median = (name) => rounds.map((round) => round[name]).sort((a, b) => a - b)[(ROUNDS - 1) / 2];
const steps = (name) => `${(median(name) / 1e6).toPrecision(3)} million steps/s`;
const size = (name) => {
  const module = readFileSync(new URL(`dist/${name}.wasm`, import.meta.url));
  const [plain, zipped] = [module, gzipSync(module)].map(({ length }) => (length / 1000).toFixed(1));
  return `${plain} KB, with gzip ${zipped} KB`;
};
const rows = [
  ["module of the page, with simd128", size("acrobot-simd128")],
  ["module of the page, without simd128", size("acrobot")],
  ["module with one acrobot, without drawing and learning", size("simulation")],
  ["from the loaded module to the first frame", `${median("firstFrame").toFixed(0)} ms`],
  ["frames per second", median("frames").toFixed(0)],
  ["physics per frame", `${median("physics").toFixed(2)} ms`],
  ["drawing per frame", `${median("drawing").toFixed(1)} ms`],
  ["one acrobot, `Fast`", steps("scalar"), steps("nativeScalar")],
  ["batch of 1,024, `Fast`, without observations, with simd128 or native SIMD", steps("batch"), steps("nativeBatch")],
  ["training", `${Number(median("training").toPrecision(2)).toLocaleString("en")} episodes per minute`],
];
const table = [HEAD, "|---|---|---|", ...rows.map(([name, here, there = ""]) => `| ${name} | ${here} | ${there} |`)];
console.log(`Measured in Chromium ${version}.\n`);
console.log(table.join("\n"));

if (process.argv[2] === "--update") {
  const lines = readFileSync(DOCUMENT, "utf8").split("\n");
  const start = lines.indexOf(HEAD);
  if (start < 0) throw new Error(`docs/wasm.md must have the line ${HEAD}`);
  const end = lines.findIndex((line, i) => i > start && !line.startsWith("|"));
  lines.splice(start, end - start, ...table);
  writeFileSync(DOCUMENT, lines.join("\n"));
}
