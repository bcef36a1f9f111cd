// The packed package, installed in a fresh project, runs in Node.js, in bundles and in a browser.
// So does the code of its documentation.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
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
const run = (command, args, options) => execFileSync(command, args, { cwd: folder, encoding: "utf8", ...options });
let browser, origin, close;

before(async () => {
  run("npm", ["init", "-y"]);
  run("npm", ["install", "--silent", join(here, `acrobot-rs-${version}.tgz`)]);
  writeFileSync(join(folder, "record.js"), `(${record})()`);
  ({ browser, origin, close } = await launch(folder));
});

after(async () => {
  await close?.();
  rmSync(folder, { recursive: true });
});

/** The blocks of a page in one language. */
function blocks(page, language) {
  const text = readFileSync(join(root, page), "utf8");
  return [...text.matchAll(new RegExp(`^\`\`\`${language}\n(.*?)^\`\`\``, "gms"))].map(([, code]) => code);
}

const PROGRAMS = ["docs/wasm.md", "README.md", "bindings/npm/README.md"].flatMap((page) => blocks(page, "js"));
const printed = (program) => program.match(/^\/\/ prints: (.*)/m)?.[1] ?? "";

/**
 * Runs first in a page: records what its console has, and its errors. WebDriver has no such events.
 */
function record() {
  window.recorded = { lines: [], errors: [] };
  console.log = (line) => window.recorded.lines.push(line);
  addEventListener("error", ({ message }) => window.recorded.errors.push(message));
  addEventListener("unhandledrejection", ({ reason }) => window.recorded.errors.push(String(reason)));
}

/**
 * Opens a page in a browser and calls `play` with it. Asserts that there are no errors. Returns
 * what the console has.
 */
async function open(html, play = () => {}) {
  writeFileSync(join(folder, "index.html"), `<link rel="icon" href="data:,"><script src="record.js"></script>${html}`);
  const page = await browser.newPage();
  await page.goto(origin);
  await play(page);
  const { lines, errors } = await page.evaluate(() => window.recorded);
  await page.close?.();
  assert.deepEqual(errors, []);
  return lines;
}

test("the package has at most 120 KB and these files", () => {
  const [{ name, files, unpackedSize }] = JSON.parse(run("npm", ["pack", "--json", "--dry-run", join(here, "dist")]));
  const paths = files.map(({ path }) => path).sort();
  const entries = ["index", "policies"].flatMap((entry) =>
    ["cjs", "d.cts", "d.ts", "js"].map((type) => `${entry}.${type}`),
  );
  const others = ["LICENSE-APACHE", "LICENSE-MIT", "LICENSE-tiny-inflate", "README.md", "package.json"];
  assert.deepEqual(paths, [...others, ...entries].sort());
  assert.ok(unpackedSize <= 120_000, `the package must have at most 120,000 bytes, got ${unpackedSize}`);
  assert.equal(name, "acrobot-rs");
});

test("the module imports nothing and cannot panic", () => {
  const [text, learner] = ["npm", "learner"].map((name) => readFileSync(join(here, `target/acrobot_${name}.wat`), "utf8"));
  assert.match(text, /\(export "batch_step"/);
  assert.doesNotMatch(text + learner, /\(import/);
  assert.doesNotMatch(text, /unreachable/);
});

test("the programs of the documentation run in Node.js and print what they say", () => {
  assert.equal(PROGRAMS.length, 7);
  PROGRAMS.forEach((program, i) => {
    writeFileSync(join(folder, `program${i}.mjs`), program);
    assert.equal(run("node", [`program${i}.mjs`]).trim(), printed(program));
  });
  const required = 'const { Acrobot } = require("acrobot-rs"); console.log(Acrobot.name);';
  // From Node.js 20.19 on.
  if (process.features.require_module) assert.equal(run("node", ["--eval", required]), "Acrobot\n");
});

test("types pass tsc --strict, with the newest TypeScript and with 5.2", () => {
  PROGRAMS.forEach((program, i) => writeFileSync(join(folder, `program${i}.mts`), program));
  for (const extension of ["ts", "mts", "cts"]) cpSync(join(here, "test/typed.ts"), join(folder, `typed.${extension}`));
  const programs = PROGRAMS.map((_, i) => `program${i}.mts`);
  const [newest, oldest] = ["typescript", "oldest-typescript"].map((name) => join(here, "node_modules", name, "bin/tsc"));
  for (const [tsc, module, ...files] of [
    [newest, ["nodenext"], "typed.mts", "typed.cts", ...programs],
    [newest, ["esnext", "--moduleResolution", "bundler"], "typed.mts", ...programs],
    [oldest, ["node16"], "typed.mts", "typed.cts"],
    [oldest, ["esnext", "--moduleResolution", "bundler"], "typed.ts"],
    [oldest, ["commonjs"], "typed.ts"],
  ]) {
    assert.equal(run("node", [tsc, "--strict", "--noEmit", "--target", "es2022", "--module", ...module, ...files]), "");
  }
  // Without any option, which means ES5.
  writeFileSync(join(folder, "plain.ts"), 'import { Acrobot } from "acrobot-rs";\nimport { bangBang } from "acrobot-rs/policies";\nbangBang(new Acrobot());\n');
  assert.equal(run("node", [oldest, "plain.ts"]), "");
  // Without the types of a browser.
  writeFileSync(join(folder, "server.mts"), 'import { Acrobot } from "acrobot-rs";\nnew Acrobot().step(1);\n');
  const server = ["--strict", "--noEmit", "--lib", "es2022", "--module", "nodenext", "server.mts"];
  for (const tsc of [newest, oldest]) assert.equal(run("node", [tsc, ...server]), "");
});

test("no linter of packages has a warning", () => {
  const packed = join(here, `acrobot-rs-${version}.tgz`);
  const lint = (name, ...options) => run(join(here, "node_modules/.bin", name), [packed, ...options]);
  assert.match(lint("publint", "--strict"), /All good!/);
  assert.match(lint("attw", "--format", "ascii"), /No problems found/);
});

/**
 * A bundle of a program for es2020, which has no top-level await; Vite 6 and others compile for it.
 */
const bundled = (contents, format, minify) => {
  const stdin = { contents, resolveDir: folder };
  const options = { stdin, bundle: true, format, minify, target: "es2020", globalName: "bundle" };
  return buildSync({ ...options, write: false }).outputFiles[0].text;
};

test("bundles of every format run in Node.js and in a browser, with the classes' names", async () => {
  const names = `
    import { Batch } from "acrobot-rs";
    import { Learner, Perceptron } from "acrobot-rs/policies";
    console.log([Acrobot, Batch, Learner, Perceptron].map(({ name }) => name).join());`;
  for (const format of ["esm", "cjs", "iife"]) {
    for (const minify of [false, true]) {
      const path = join(folder, `bundle.${format === "esm" ? "mjs" : "cjs"}`);
      writeFileSync(path, bundled(PROGRAMS[0] + names, format, minify));
      const lines = [printed(PROGRAMS[0]), "Acrobot,Batch,Learner,Perceptron", ""];
      assert.deepEqual(run("node", [path]).split("\n"), lines);
    }
  }
  writeFileSync(join(folder, "bundle.js"), bundled(PROGRAMS[0], "iife", true));
  const page = (sources) => `<meta http-equiv="content-security-policy" content="script-src ${sources}"><script src="bundle.js"></script>`;
  assert.deepEqual(await open(page("'self' 'wasm-unsafe-eval'")), [printed(PROGRAMS[0])]);
  await assert.rejects(open(page("'self'")), /acrobot-rs needs WebAssembly with simd128, and 'wasm-unsafe-eval'/);
});

test("another realm, with few globals and without compilation, takes a compiled module", () => {
  const program = 'export * from "acrobot-rs"; export * as policies from "acrobot-rs/policies";';
  const context = createContext({ atob }, { codeGeneration: { wasm: false } });
  runInContext("delete globalThis.FinalizationRegistry", context);
  const own = runInContext(`${bundled(program, "iife", false)}; bundle`, context);
  const { Acrobot, Batch, moduleBytes, policies, setModule } = own;
  assert.throws(() => new Acrobot(), { message: /^acrobot-rs needs WebAssembly .*: .*disallowed/ });
  const modules = [own, policies].map(({ moduleBytes }) => new WebAssembly.Module(moduleBytes()));
  const message = "module must be a WebAssembly.Module, got [object Uint8Array]";
  assert.throws(() => setModule(moduleBytes()), { message });
  const other = /^module must be compiled from the moduleBytes\(\) of this version, got .*begin/;
  assert.throws(() => setModule(modules[1]), { message: other });
  setModule(modules[0]);
  policies.setModule(modules[1]);

  const acrobot = new Acrobot({ seed: 42 });
  while (!acrobot.step(policies.bangBang(acrobot)).terminated);
  assert.equal(acrobot.elapsed, 94);
  acrobot.restore(Buffer.from(new Acrobot({ seed: 42 }).snapshot()));
  assert.equal(acrobot.elapsed, 0);
  assert.deepEqual([...new Batch({ count: 2 }).step(Uint8Array.of(0, 2)).rewards], [-1, -1]);
  const gravity = "gravity must be a finite number of m/s², got NaN";
  assert.throws(() => acrobot.setParams({ gravity: NaN }), { message: gravity });
  const batch = new Batch({ count: 1 }).snapshot();
  assert.throws(() => acrobot.restore(batch), { message: /arithmetic "fast", got \d+ other bytes$/ });
  const policy = readFileSync(join(root, "crates/policy/policy.bin"));
  assert.equal(new policies.Perceptron(policy).act(acrobot), 2);
  const learner = new policies.Learner({ seed: 1 });
  learner.load(Buffer.from(learner.save()));
  assert.throws(() => learner.load(policy), { message: /^weights must begin with the bytes TILE$/ });
  acrobot.free();
});

/** Waits until a canvas shows another picture. */
async function moves(page) {
  const first = await page.evaluate(() => document.querySelector("canvas").toDataURL());
  await page.waitForFunction((first) => document.querySelector("canvas").toDataURL() !== first, first, { timeout: 5000 });
}

test("the page of the documentation draws episodes without a bundler", async () => {
  const [html] = blocks("docs/wasm.md", "html");
  await open(html, moves);
});

test("a picture is Gymnasium's, with the torque of the last step", async () => {
  cpSync(join(root, "tests/data/frames.png"), join(folder, "frames.png"));
  const canvas = `<canvas id="canvas" width="500" height="500"></canvas><img id="frames" src="frames.png">`;
  await open(canvas, async (page) => {
    const found = await page.evaluate(async () => {
      const { Acrobot, Batch } = await import("/node_modules/acrobot-rs/index.js");
      const context = document.querySelector("#canvas").getContext("2d", { willReadFrequently: true });
      const pixels = () => context.getImageData(0, 0, 500, 500).data;
      const acrobot = new Acrobot();
      // The seventh row of tests/data/frames.txt. Its frame is the seventh of the first row.
      acrobot.state = { theta1: 0.6289501539883458, theta2: 1.4360881438650939, dtheta1: 0, dtheta2: 0 };
      acrobot.draw(context);
      const drawn = pixels();
      await document.querySelector("#frames").decode();
      context.drawImage(document.querySelector("#frames"), -3000, 0);
      const theirs = pixels();
      let close = 0;
      for (let i = 0; i < theirs.length; i += 4) close += [0, 1, 2].every((j) => Math.abs(theirs[i + j] - drawn[i + j]) <= 32);

      /**
       * The side of the elbow on which most pixels in the torque's colour are: the arrow's head is
       * there. 0 without an arrow.
       */
      const head = () => {
        const [data, elbow] = [pixels(), 250 + (250 / 2.2) * Math.sin(acrobot.state.theta1)];
        let side = 0;
        for (let i = 0; i < data.length; i += 4) {
          if (data[i] === 204 && data[i + 1] === 0 && data[i + 2] === 0) side += (i / 4) % 500 < elbow ? -1 : 1;
        }
        return Math.sign(side);
      };
      const arrows = [2, 1, 0].map((action) => {
        acrobot.state = { theta1: 0.6, theta2: -1.5, dtheta1: 0, dtheta2: 0 };
        acrobot.step(action);
        acrobot.draw(context);
        return head();
      });
      acrobot.step(2);
      acrobot.reset();
      acrobot.draw(context);
      const afterReset = head();

      // A batch's picture in a corner, in other colours.
      const batch = new Batch({ count: 2, seed: 1 });
      const single = new Acrobot({ seed: 1n + (1n << 128n) });
      const options = { size: 100, colors: { link: "#010203", background: "transparent" } };
      context.fillStyle = "#040506";
      const corner = (draw) => {
        context.fillRect(0, 0, 500, 500);
        draw();
        return context.getImageData(0, 0, 101, 101).data.join();
      };
      const corners = [corner(() => batch.draw(context, 1, options)), corner(() => single.draw(context, options))];
      return {
        close: close / 250_000,
        arrows,
        afterReset,
        same: corners[0] === corners[1],
        dark: corners[0].includes("1,2,3,255"),
        outside: corners[0].endsWith("4,5,6,255"),
      };
    });
    assert.ok(found.close > 0.99, `${found.close} of the pixels are close`);
    assert.deepEqual({ ...found, close: 1 }, { close: 1, arrows: [-1, 0, 1], afterReset: 0, same: true, dark: true, outside: true });
  });
});

test("one's own module, as docs/wasm.md describes it, has 10 KB and draws episodes", async () => {
  const [manifest] = blocks("docs/wasm.md", "toml");
  const [library] = blocks("docs/wasm.md", "rust");
  const [, html] = blocks("docs/wasm.md", "html");
  run("cargo", ["new", "--quiet", "--vcs", "none", "--lib", "my_module"]);
  const path = join(folder, "my_module");
  const version = /"0\.1".*/;
  assert.match(manifest, version);
  const [head] = readFileSync(join(path, "Cargo.toml"), "utf8").split("[dependencies]");
  writeFileSync(join(path, "Cargo.toml"), head + manifest.replace(version, `{ path = ${JSON.stringify(root)} }`));
  writeFileSync(join(path, "src/lib.rs"), library);
  const target = join(here, "target/own");
  run("cargo", ["build", "--quiet", "--release", "--target", "wasm32-unknown-unknown", "--target-dir", target], { cwd: path });
  const module = readFileSync(join(target, "wasm32-unknown-unknown/release/my_module.wasm"));
  assert.equal(Math.round(module.length / 1000), 10);
  writeFileSync(join(folder, "my_module.wasm"), module);
  await open(html, moves);
});
