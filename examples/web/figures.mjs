// Measures the README's figures of the browser, and native speed in the same run: `npm run figures`.

import { execFileSync } from "node:child_process";
import { statSync } from "node:fs";

import { launch } from "./browser.mjs";
import { serve } from "./serve.mjs";

const root = new URL("../..", import.meta.url);
const args = ["run", "--release", "--quiet", "--locked", "--example", "throughput"];
const throughput = execFileSync("cargo", args, { cwd: root, encoding: "utf8" });
const native = (name) => Number(new RegExp(`^${name} (\\d+)`, "m").exec(throughput)[1]);

const server = await serve(0);
const browser = await launch();
const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
await page.goto(`http://localhost:${server.address().port}/`);
await page.waitForSelector("#app:not([hidden])");
const firstFrame = await page.evaluate(
  () => new Promise((resolve) => new PerformanceObserver((list) => resolve(list.getEntriesByName("first frame")[0].duration)).observe({ type: "measure", buffered: true })),
);
// Two seconds of nothing except the swing.
const frames = await page.evaluate(async () => {
  const start = performance.now();
  let frames = 0;
  while (performance.now() - start < 2000) {
    await new Promise(requestAnimationFrame);
    frames++;
  }
  return frames / 2;
});
const read = (id) => page.textContent(`#${id}`);
const [physics, drawing] = [await read("physics"), await read("drawing")];
await page.click("#measure");
await page.waitForFunction(() => !document.querySelector("#measure").disabled);
const [scalar, batch] = (await Promise.all(["scalar", "batch"].map(read))).map((text) => Number.parseFloat(text) * 1e6);
await page.fill("#episodes", "5000");
await page.click("#train");
await page.waitForFunction(() => document.querySelector("#train").textContent === "Train");
const training = /[\d,]+ episodes a minute/.exec(await read("training-status"))[0];
await browser.close();
server.close();

const million = (rate) => `${(rate / 1e6).toFixed(1)} million steps a second`;
const size = (name) => `${statSync(new URL(`dist/${name}.wasm`, import.meta.url)).size} bytes`;
const nativeScalar = native("scalar_fast");
for (const [name, value] of Object.entries({
  "the page's module, with simd128": size("acrobot-simd128"),
  "the page's module, without": size("acrobot"),
  "the plain simulation": size("simulation"),
  "from the module's arrival to the first frame": `${firstFrame.toFixed(0)} ms`,
  "frames a second": frames.toFixed(0),
  "physics of a frame": physics,
  "drawing of a frame": drawing,
  "one acrobot, browser": million(scalar),
  "one acrobot, native": million(nativeScalar),
  "ratio": (scalar / nativeScalar).toFixed(2),
  "batch of 1,024, browser": million(batch),
  "batch of 1,024, native": million(native("batch_fast_1024")),
  "batch to one acrobot, browser": (batch / scalar).toFixed(2),
  "training, fast": training,
})) {
  console.log(`${name}: ${value}`);
}
