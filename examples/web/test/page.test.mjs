// Tests the page in a browser, and compares its results with native ones.

import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

import { Learner } from "../dist/acrobot-rs/policies.js";
import { ACTIONS, trace } from "./native.mjs";
import {
  downloaded, folder, onPage, open, paused, press, says, shownBits, shows, showsBits, stepped,
  steps, text,
} from "./player.mjs";

onPage("the page loads and plays a policy", {}, async (page) => {
  await stepped(page, 2);
  await says(page, "#status", /^(Seed \d+\. )?Bang-bang plays\. To take over, press ← or →\.$/);
  const drawn = await page.evaluate(() => {
    const context = document.querySelector("#picture").getContext("2d");
    const { data } = context.getImageData(0, 0, 900, 900);
    return [...new Set(new Uint32Array(data.buffer))].map((pixel) => pixel.toString(16));
  });
  // Background, links, joints and torque: opacity, blue, green, red.
  const colors = ["0", "ffa8a012", "ff00646a", "ff2b3acc"];
  assert.deepEqual(colors.filter((color) => !drawn.includes(color)), []);
});

onPage("seeds give Gymnasium's initial states, others are rejected", {}, async (page) => {
  const seed = "123456789012345678901234567890";
  await paused(page, seed);
  await page.fill("#seed", "-1");
  const rule = "seed must have from 1 to 600 decimal digits";
  await shows(page, "#seed-reason", `${rule}, got "−1"`);
  assert.equal(await page.getAttribute("#seed", "aria-invalid"), "true");
  await showsBits(page, trace(seed, [])[0]);
  await page.fill("#seed", "5");
  await shows(page, "#seed-reason", "");
  await showsBits(page, trace("5", [])[0]);
});

onPage("reset, pause and next seed do what they say", {}, async (page) => {
  await paused(page, 42);
  const start = await shownBits(page);
  await press(page, [2, 2]);
  const before = await shownBits(page);
  await page.waitForTimeout(500);
  await showsBits(page, before);
  await page.keyboard.press("r");
  await showsBits(page, start);
  await page.click("#single");
  await page.click("#next");
  assert.equal(await page.inputValue("#seed"), "43");
  await shows(page, "#step", "0");
  await page.click("#pause");
  await stepped(page, 1);
  await shows(page, "#pause", "Pause");
});

onPage("after a policy's goal the next seed follows, and a key takes over", {}, async (page) => {
  await page.selectOption("#pace", "4");
  // The goal depends on the angles only.
  await page.fill("#length2", "2");
  await says(page, "#status", /^Goal after \d+ steps\. The next seed follows\.$/);
  await says(page, "#status", /^Seed 4\d\. Bang-bang plays\./);
  // The list loses the focus.
  await page.focus("#pace");
  await page.selectOption("#pace", "1");
  await page.keyboard.press("ArrowLeft");
  await says(page, "#status", /^You play on\. For an episode of your own, press Restart\.$/);
  assert.equal(await page.inputValue("#policy"), "keys");
});

onPage("keys and parameters give native bits, and invalid ones are rejected", {}, async (page) => {
  await paused(page, 42);
  await page.fill("#dt", "0.05");
  await page.selectOption("#dynamics", "nips");
  await press(page, ACTIONS);
  await showsBits(page, trace("42", ACTIONS, "--dt", "0.05", "--nips").at(-1));

  for (const [value, got] of [["-0.1", "−0.1"], ["abc", "NaN"]]) {
    await page.fill("#dt", value);
    await shows(page, "#dt-reason", `dt must be finite and above 0 s, got ${got}`);
  }
  assert.equal(await page.getAttribute("#dt", "aria-invalid"), "true");
  await page.focus(".parameter:has(#mass1) [type=range]");
  await page.keyboard.press("ArrowRight");
  assert.equal(await page.inputValue("#mass1"), "1.05");
  // At once, without a restart.
  await shows(page, "#step", String(ACTIONS.length));
  await shows(page, "#status", "The machine has changed.");

  await page.selectOption("#machine", "Gymnasium");
  assert.equal(await page.inputValue("#mass1"), "1");
  await page.focus("#stage");
  await page.keyboard.press("r");
  await press(page, ACTIONS);
  await showsBits(page, trace("42", ACTIONS).at(-1));
  await shows(page, "#return", `−${ACTIONS.length}`);
});

onPage("a tiny time step does not freeze the page", {}, async (page) => {
  await page.fill("#dt", "1e-9");
  await stepped(page, 500);
  assert.match(await text(page, "#status"), /^Out of time/);
  await page.selectOption("#policy", "planner");
  await stepped(page, 1500);
});

test("a link replays a run, and an invalid link is rejected", async () => {
  let link, state;
  await open({}, async (page) => {
    await paused(page, 7);
    await page.fill("#length2", "1.5");
    await page.selectOption("#dynamics", "nips");
    await press(page, ACTIONS);
    await page.click("#share");
    link = await page.inputValue("#link");
    assert.equal(await page.evaluate(() => navigator.clipboard.readText()), link);
    assert.equal(await page.url(), link);
    await shows(page, "#link-field label", "Copied: a link with seed, physics and 21 actions");
    state = await shownBits(page);
  });
  await open({ hash: new URL(link).hash }, async (page) => {
    await page.selectOption("#pace", "4");
    await says(page, "#status", /^The replay has ended\. Press Restart, or an arrow and Play\.$/);
    await showsBits(page, state);
    assert.equal(await page.inputValue("#length2"), "1.5");
    assert.equal(await page.url(), link);
  });
  await open({ hash: "#seed=4&mass1=0" }, async (page) => {
    const reason = "mass1 must be finite and above 0 kg, got 0";
    await shows(page, "#status", `The link is invalid: ${reason}`);
    assert.match(await page.url(), /#seed=42&policy=bang_bang$/);
    assert.equal(await page.inputValue("#seed"), "42");
    assert.equal(await page.inputValue("#mass1"), "1");
    // The address of an episode begins it again.
    await page.evaluate(() => (location.hash = "seed=8&mass2=0.75"));
    await says(page, "#status", /^Bang-bang plays\./);
    assert.equal(await page.inputValue("#seed"), "8");
    assert.equal(await page.inputValue("#mass2"), "0.75");
  });
});

/** Weights that the learner learns without a page. */
function learnt(episodes, seed) {
  const learner = new Learner({ episodes, seed });
  for (let episode = 0; episode < episodes; episode++) learner.train();
  return Buffer.from(learner.save());
}

// The package's test compares the learner with the native one.
onPage("the worker trains the weights of the learner", {}, async (page) => {
  const seed = "123456789012345678901";
  await page.fill("#episodes", "130");
  await page.fill("#training-seed", seed);
  await page.click("#train");
  await says(page, "#train", /^Train$/);
  assert.match(await text(page, "#training-status"), /^130 of 130 episodes/);
  assert.ok((await downloaded(page, "#save")).equals(learnt(130, BigInt(seed))));
  const [, own, gymnasium] = /: (.*) on the .* set, (.*) on G/.exec(await text(page, "#elsewhere"));
  assert.equal(own, gymnasium);
  // Without a torque no episode reaches the goal.
  await page.fill("#torque", "0");
  await page.fill("#episodes", "3");
  await page.click("#train");
  await says(page, "#training-status", /^3 of 3 episodes · mean return −500\.0 /);
  await says(page, "#elsewhere", /: −500\.0 on the machine that is set, −\d/);
  await page.fill("#episodes", "1000000");
  await page.click("#train");
  await says(page, "#training-status", /^[1-9].* of 1,000,000 episodes/);
  await page.click("#train");
  assert.match(await text(page, "#training-status"), / · stopped$/);
});

onPage("loaded weights reach the goal, and invalid ones are rejected", {}, async (page) => {
  const path = join(folder, "weights.bin");
  const good = learnt(200, 42);
  writeFileSync(path, good);
  await paused(page, 42);
  await page.setInputFiles("#load", path);
  await says(page, "#training-status", /is loaded\.$/);
  assert.ok((await downloaded(page, "#save")).equals(good));
  await page.click("#drive");
  await page.click("#pause");
  await steps(page, 200);
  await shows(page, "#verdict", `Goal! ${await text(page, "#step")} steps`);

  const short = join(folder, "short.bin");
  writeFileSync(short, good.subarray(0, 1000));
  await page.setInputFiles("#load", short);
  await says(page, "#weights-reason", /^short\.bin: weights must have 49172 bytes, got 1000$/);
  // A perceptron from Python, with the steps of crates/policy/tests/policy.rs.
  const policy = new URL("../../../crates/policy/policy.bin", import.meta.url);
  await page.setInputFiles("#load", fileURLToPath(policy));
  await says(page, "#training-status", /^policy\.bin is loaded\.$/);
  await page.fill("#seed", "1");
  await steps(page, 200);
  await shows(page, "#verdict", "Goal! 101 steps");
  for (const [episodes, seed] of [["0", "1"], ["1.5", "1"], ["10", "x"]]) {
    await page.fill("#episodes", episodes);
    await page.fill("#training-seed", seed);
    await page.click("#train");
    assert.match(await text(page, "#training-reason"), / must /);
    await shows(page, "#train", "Train");
  }
});

for (const [missing, message, options] of [
  ["WebAssembly", /needs WebAssembly/, { prepare: () => delete globalThis.WebAssembly }],
  ["JavaScript", /needs JavaScript/, { javaScriptEnabled: false }],
]) {
  onPage(`without ${missing} the page says so`, { ...options, starts: false }, async (page) => {
    await page.locator("#status", { hasText: message }).waitFor();
  });
}

const calm = { reducedMotion: "reduce" };
onPage("with reduced motion the page begins paused and moves step by step", calm, async (page) => {
  await shows(page, "#pause", "Play");
  assert.match(await text(page, "#status"), /^Press Play/);
  await page.waitForTimeout(500);
  await shows(page, "#step", "0");
});

onPage("a policy that cannot play says so, and the page goes on", {}, async (page) => {
  await page.fill("#mass1", "3e38");
  await page.selectOption("#policy", "energy_law");
  await says(page, "#status", /energy must be a finite number, got −Infinity$/);
  await shows(page, "#pause", "Play");
  assert.match(await text(page, "#energy-caption"), /too large J/);
  await page.selectOption("#machine", "Gymnasium");
  await page.click("#pause");
  await stepped(page, 2);
});

onPage("a torque ends where its button loses the focus", {}, async (page) => {
  const held = () => page.evaluate(() => document.querySelectorAll(".held").length);
  await page.focus("#left");
  await page.keyboard.down("Space");
  assert.equal(await held(), 1);
  await page.keyboard.press("Tab");
  assert.equal(await held(), 0);
  await page.keyboard.up("Space");
});
