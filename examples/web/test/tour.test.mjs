// A visitor's tour: the planner holds the acrobot up, somebody pulls it down, and it recovers.

import assert from "node:assert/strict";

import {
  downloaded, linked, onPage, paused, press, says, shownBits, shows, showsBits, steps, text,
} from "./player.mjs";

const holds = (page) => says(page, "#return", /^[1-9]\d*\.\d s$/);

/** Drags the upright tip to the side, by a part of the picture's width, until it falls. */
async function drag(page, part) {
  const { x, y, width } = await page.locator("#stage").boundingBox();
  await page.mouse.move(x + width / 2, y + 0.06 * width);
  await page.mouse.down();
  await page.mouse.move(x + (0.5 + part) * width, y + 0.06 * width, { steps: 4 });
  await says(page, "#return", /^0\.0 s$/);
  await page.mouse.up();
}

onPage("the planner holds the acrobot, also after pulls", {}, async (page) => {
  // The page begins without the module for planning, and does not plan in its thread.
  const first = await page.$$eval("[rel=modulepreload]", (links) => links.map(({ href }) => href));
  assert.deepEqual(["index", "control"].map((name) => first.join().includes(`/${name}.js`)),
    [true, false]);
  await page.click("#balance");
  await says(page, "#status", /Plan of \d/);
  assert.ok(page.workers().some((worker) => worker.url().endsWith("/planning.js")));
  await page.selectOption("#pace", "4");
  await holds(page);
  await page.selectOption("#pace", "1");
  await drag(page, 0.3);
  await page.selectOption("#pace", "4");
  await holds(page);
});

for (const [machine, settings] of [
  ["dm_control", {}],
  ["RealAIGym", {}],
  ["Gymnasium, 5 N m", { friction: "0.1", noise: "0.2", angleNoise: "0.002" }],
]) {
  const name = `the planner holds the machine of ${machine} with ${JSON.stringify(settings)}`;
  onPage(name, {}, async (page) => {
    await page.selectOption("#machine", machine);
    for (const [id, value] of Object.entries(settings)) await page.fill(`#${id}`, value);
    await page.click("#balance");
    await page.selectOption("#pace", "4");
    await holds(page);
    assert.equal(await page.inputValue("#machine"), "friction" in settings ? "" : machine);
  });
}

onPage("noise acts on the motor, and blinds the planner", {}, async (page) => {
  await paused(page, 42);
  await page.fill("#noise", "0.5");
  await press(page, [1, 1]);
  const { levels } = await linked(page);
  assert.ok(levels[0] !== levels[1], `${levels}`);
  await page.selectOption("#machine", "Gymnasium, 5 N m");
  await page.click("#balance");
  await page.selectOption("#pace", "4");
  await holds(page);
  await page.fill("#angleNoise", "0.5");
  await says(page, "#return", /^0\.0 s$/);
});

onPage("another acrobot is pulled, too, and an animation is saved", {}, async (page) => {
  await paused(page, 42);
  await page.selectOption("#rival", "bang_bang");
  await page.selectOption("#policy", "bang_bang");
  await page.focus("#stage");
  await page.keyboard.down("Shift");
  await page.keyboard.down("ArrowRight");
  await steps(page, 9);
  await page.keyboard.up("Shift");
  await page.keyboard.up("ArrowRight");
  const animation = String(await downloaded(page, "#animate"));
  const [angles, , rings] = animation.match(/values="[^"]*"/g).map((list) => list.split(";"));
  assert.equal(angles.length, 10);
  assert.equal(rings.join(), `values="0${",1".repeat(9)}"`);
  await steps(page, 200);
  const verdict = await text(page, "#verdict");
  assert.match(verdict, /^Goal! \d+ steps$/);
  await shows(page, "#rival-steps", verdict);
});

onPage("one goes back, and on from there, and saves the run", {}, async (page) => {
  await paused(page, 42);
  await press(page, [2, 2, 0, 0, 1, 1]);
  const last = await shownBits(page);
  await page.focus("#scrub");
  for (let i = 0; i < 4; i++) await page.keyboard.press("ArrowLeft");
  await shows(page, "#step", "2");
  await shows(page, "#ago", "0.8 s ago");
  assert.match(await text(page, "#torques-caption"), /1\.00 N m/);
  assert.notDeepEqual(await shownBits(page), last);
  await press(page, [0, 0, 1, 1]);
  await shows(page, "#ago", "now");
  await showsBits(page, last);
  const lines = String(await downloaded(page, "#csv")).trim().split("\n");
  assert.equal(lines.length, 8);
  assert.match(lines[0], /^time_s,theta1_rad,/);
  assert.match(lines[7], /^1\.200000,.*,0$/);
  assert.equal((await linked(page)).levels.map(Math.sign).join(), "1,1,-1,-1,0,0");
});

onPage("who plays changes without a jump", {}, async (page) => {
  await page.click("#balance");
  await page.waitForFunction(() => document.querySelector("#step").textContent > 60);
  await page.click("#pause");
  const state = await shownBits(page);
  for (const policy of ["keys", "bang_bang", "planner", "energy_law"]) {
    await page.selectOption("#policy", policy);
    await showsBits(page, state);
    assert.equal(await page.inputValue("#machine"), "Gymnasium, 5 N m");
  }
});

onPage("keys push the tip, in every policy", {}, async (page) => {
  await paused(page, 42);
  await page.focus("#stage");
  await page.keyboard.down("Shift");
  await page.keyboard.down("ArrowRight");
  await press(page, [1, 1, 1]);
  await page.keyboard.up("Shift");
  await page.keyboard.up("ArrowRight");
  assert.match(await text(page, "#torques-caption"), /0\.00 N m/);
  const { levels, pushes } = await linked(page);
  assert.deepEqual(levels, [0, 0, 0]);
  assert.ok(pushes[0][0] > 400, `${pushes}`);
});
