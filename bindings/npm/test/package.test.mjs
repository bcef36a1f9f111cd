// The packed package, installed in a fresh project, runs in Node.js, in a bundle and in a browser.
// So does the code of its documentation.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { cpSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { createContext, runInContext } from "node:vm";

import { buildSync } from "esbuild";

import { launch } from "../browser.mjs";

const here = fileURLToPath(new URL("..", import.meta.url));
const root = join(here, "../..");
const [, version] = /^version = "(.*)"/m.exec(readFileSync(join(root, "Cargo.toml"), "utf8"));
const folder = mkdtempSync(join(tmpdir(), "acrobot-npm-"));
const run = (command, args, options) =>
  execFileSync(command, args, { cwd: folder, encoding: "utf8", ...options });
const write = (name, text) => writeFileSync(join(folder, name), text);
let browser, origin, close;

before(async () => {
  run("npm", ["init", "-y"]);
  run("npm", ["install", "--silent", join(here, `acrobot-rs-${version}.tgz`)]);
  write("record.js", `(${record})()`);
  ({ browser, origin, close } = await launch(folder));
});

after(async () => {
  await close?.();
  rmSync(folder, { recursive: true });
});

/** The blocks of a page in one language. */
function blocks(page, language) {
  const block = new RegExp(`^\`\`\`${language}\n(.*?)^\`\`\``, "gms");
  return [...readFileSync(join(root, page), "utf8").matchAll(block)].map(([, code]) => code);
}

const PAGES = ["docs/wasm.md", "README.md", "bindings/npm/README.md"];
const PROGRAMS = PAGES.flatMap((page) => blocks(page, "js"));
const printed = (program) => program.match(/^\/\/ prints: (.*)/m)?.[1] ?? "";

/**
 * Runs first in a page: records what its console has, and its errors. WebDriver has no such events.
 */
function record() {
  const { lines, errors } = (window.recorded = { lines: [], errors: [] });
  console.log = (line) => lines.push(line);
  addEventListener("error", ({ message }) => errors.push(message));
  addEventListener("unhandledrejection", ({ reason }) => errors.push(String(reason)));
}

/** Opens a page and calls `play` with it. Without errors, returns what the console has. */
async function open(html, play = () => {}) {
  const head = '<link rel="icon" href="data:,"><script src="record.js"></script>';
  write("index.html", head + html);
  const page = await browser.newPage();
  await page.goto(origin);
  await play(page);
  const { lines, errors } = await page.evaluate(() => window.recorded);
  await page.close?.();
  assert.deepEqual(errors, []);
  return lines;
}

test("the package has at most 398 KB and these files", () => {
  const report = run("npm", ["pack", "--json", "--dry-run", join(here, "dist")]);
  const [{ name, files, unpackedSize }] = JSON.parse(report);
  const paths = files.map(({ path }) => path).sort();
  const entries = ["control", "index", "instruments", "policies"].flatMap((entry) =>
    ["cjs", "d.cts", "d.ts", "js"].map((type) => `${entry}.${type}`),
  );
  const licences = ["APACHE", "MIT", "tiny-inflate"].map((name) => `LICENSE-${name}`);
  assert.deepEqual(paths, [...licences, "README.md", "package.json", ...entries].sort());
  assert.ok(unpackedSize <= 398_000, `${unpackedSize} bytes`);
  assert.equal(name, "acrobot-rs");
});

test("the modules import nothing, and those of acrobots and of control cannot panic", () => {
  for (const [name, most, used] of [
    ["acrobots", 88_300, "acrobot_batch_step"],
    ["instruments", 100_900, "acrobot_batch_step"],
    ["control", 173_000, "acrobot_planner_plan"],
    ["learner", 23_000, "train"],
  ]) {
    const [text, module] = ["wat", "wasm"].map((type) => join(here, `target/${name}.${type}`));
    assert.match(readFileSync(text, "utf8"), new RegExp(`\\(export "${used}"`));
    assert.doesNotMatch(readFileSync(text, "utf8"), /\(import/);
    if (name !== "learner") assert.doesNotMatch(readFileSync(text, "utf8"), /unreachable/);
    assert.ok(statSync(module).size <= most, `${name}: ${statSync(module).size} bytes`);
  }
});

test("the programs of the documentation run in Node.js and print what they say", () => {
  assert.equal(PROGRAMS.length, 8, `programs of ${PAGES}: edit this count`);
  PROGRAMS.forEach((program, i) => {
    write(`program${i}.mjs`, program);
    assert.equal(run("node", [`program${i}.mjs`]).trim(), printed(program));
  });
  const required = 'const { Acrobot } = require("acrobot-rs"); console.log(Acrobot.name);';
  // From Node.js 20.19 on.
  if (process.features.require_module) assert.equal(run("node", ["--eval", required]), "Acrobot\n");
});

test("types pass tsc --strict, with the newest TypeScript and with 5.2", () => {
  PROGRAMS.forEach((program, i) => write(`program${i}.mts`, program));
  const typed = readFileSync(join(here, "test/typed.ts"));
  for (const extension of ["mts", "cts"]) write(`typed.${extension}`, typed);
  const programs = PROGRAMS.map((_, i) => `program${i}.mts`);
  const compiler = (name) => join(here, "node_modules", name, "bin/tsc");
  const [newest, oldest] = [compiler("typescript"), compiler("oldest-typescript")];
  const check = (tsc, ...given) => assert.equal(run("node", [tsc, ...given]), "");
  const strict = ["--strict", "--noEmit", "--target", "es2022", "--module"];
  check(newest, ...strict, "nodenext", "typed.mts", "typed.cts", ...programs);
  check(oldest, ...strict, "node16", "typed.mts", "typed.cts");
  // Without any option, which means ES5.
  const plain = 'import { Acrobot } from "acrobot-rs";\nnew Acrobot().step(1);\n';
  const policies = 'import { bangBang } from "acrobot-rs/policies";\nbangBang(new Acrobot());\n';
  write("plain.ts", plain + policies);
  check(oldest, "plain.ts");
  // Without the types of a browser.
  write("server.mts", plain);
  check(newest, ...strict, "nodenext", "--lib", "es2022", "server.mts");
});

/**
 * A bundle of a program for es2020, which has no top-level await; Vite 6 and others compile for it.
 * The job `bundlers` tries others.
 */
const bundled = (contents) => {
  const stdin = { contents, resolveDir: folder };
  const options = { stdin, bundle: true, format: "iife", target: "es2020", globalName: "bundle" };
  return buildSync({ ...options, write: false }).outputFiles[0].text;
};

test("a bundle runs in a browser, with a content security policy", async () => {
  write("bundle.js", bundled(PROGRAMS[0]));
  const page = (sources) => `
    <meta http-equiv="content-security-policy" content="script-src ${sources}">
    <script src="bundle.js"></script>`;
  assert.deepEqual(await open(page("'self' 'wasm-unsafe-eval'")), [printed(PROGRAMS[0])]);
  const needs = /acrobot-rs needs WebAssembly with simd128, and 'wasm-unsafe-eval'/;
  await assert.rejects(open(page("'self'")), needs);
});

/** What a batch of the package at an address computes, with noise and resets. */
async function results(address) {
  const { Batch } = await import(address);
  const params = { torqueNoise: 0.3, dynamics: "nips" };
  const batch = new Batch({ count: 37, seed: 5, params, maxSteps: 150 });
  for (let i = 0; i < 400; i++) batch.step(Array.from({ length: 37 }, (_, j) => (i * j) % 3));
  return [...batch.snapshot(), ...new Uint8Array(batch.observations.slice().buffer)];
}

test("a batch, with noise and resets, is bit-identical in a browser and in Node", async () => {
  await open("", async (page) => {
    const found = await page.evaluate(results, "/node_modules/acrobot-rs/index.js");
    assert.deepEqual(found, await results("../dist/index.js"));
  });
});

test("another realm, with few globals and without compilation, takes a compiled module", () => {
  const program = 'export * from "acrobot-rs"; export * as policies from "acrobot-rs/policies";';
  const context = createContext({ atob }, { codeGeneration: { wasm: false } });
  runInContext("delete globalThis.FinalizationRegistry", context);
  const own = runInContext(`${bundled(program)}; bundle`, context);
  const { Acrobot, moduleBytes, policies, setModule } = own;
  assert.throws(() => new Acrobot(), { message: /^acrobot-rs needs WebAssembly .*: .*disallowed/ });
  const modules = [own, policies].map(({ moduleBytes }) => new WebAssembly.Module(moduleBytes()));
  const message = "module must be a WebAssembly.Module, got [object Uint8Array]";
  assert.throws(() => setModule(moduleBytes()), { message });
  const other = /^module must be compiled from the moduleBytes\(\) of this version, got .*begin/;
  assert.throws(() => setModule(modules[1]), { message: other });
  setModule(modules[0]);
  policies.setModule(modules[1]);

  // Options and bytes of this realm.
  const acrobot = new Acrobot({ seed: 42 });
  const policy = new policies.Perceptron(readFileSync(join(root, "crates/policy/policy.bin")));
  acrobot.step(policy.act(acrobot));
  assert.equal(Acrobot.restore(Buffer.from(acrobot.snapshot())).elapsedSteps, 1);
  acrobot.free();
});

/** Waits until a canvas shows another picture. */
async function moves(page) {
  const first = await page.evaluate(() => document.querySelector("canvas").toDataURL());
  const hasMoved = (first) => document.querySelector("canvas").toDataURL() !== first;
  await page.waitForFunction(hasMoved, first, { timeout: 5000 });
}

test("the page of the documentation draws episodes without a bundler", () =>
  open(blocks("docs/wasm.md", "html")[0], moves));

test("a picture is Gymnasium's", async () => {
  cpSync(join(root, "tests/data/frames.png"), join(folder, "frames.png"));
  const canvas = '<canvas width="500" height="500"></canvas>';
  await open(`${canvas}<img src="frames.png">`, async (page) => {
    const close = await page.evaluate(async () => {
      const { Acrobot } = await import("/node_modules/acrobot-rs/index.js");
      const [canvas, frames] = document.querySelectorAll("canvas, img");
      const context = canvas.getContext("2d", { willReadFrequently: true });
      const colors = () => [...context.getImageData(0, 0, 500, 500).data];
      const acrobot = new Acrobot();
      // The seventh row of tests/data/frames.txt. Its frame is the seventh of the first row.
      const [theta1, theta2] = [0.6289501539883458, 1.4360881438650939];
      acrobot.state = { theta1, theta2, dtheta1: 0, dtheta2: 0 };
      acrobot.draw(context);
      const drawn = colors();
      await frames.decode();
      context.drawImage(frames, -3000, 0);
      return colors().filter((color, i) => Math.abs(color - drawn[i]) <= 32).length / drawn.length;
    });
    assert.ok(close > 0.99, `${close} of the colors are close`);
  });
});
