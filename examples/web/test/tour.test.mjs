// A visitor's tour: the planner holds the acrobot up, somebody pulls it down, and it recovers.

import assert from "node:assert/strict";
import { test } from "node:test";

import { decodeRun } from "../dist/link.js";
import {
  linked, onPage, open, paused, press, says, shownBits, shows, showsBits, steps, text,
} from "./player.mjs";

const holds = (page) => says(page, "#return", /^[1-9]\d*\.\d s$/);

/** Drags the upright tip to the side, by a part of the picture's width, for a time in ms. */
async function drag(page, part, time) {
  const { x, y, width } = await page.locator("#stage").boundingBox();
  await page.mouse.move(x + width / 2, y + 0.06 * width);
  await page.mouse.down();
  await page.mouse.move(x + (0.5 + part) * width, y + 0.06 * width, { steps: 4 });
  await page.waitForTimeout(time);
  await page.mouse.up();
}

test("the planner holds the acrobot, also after pulls, and a link replays the bits", async () => {
  let link, state;
  await open({}, async (page) => {
    // The module for planning is not loaded before, and not in the page's thread.
    const files = await page.evaluate(() => performance.getEntriesByType("resource"));
    assert.deepEqual(files.filter(({ name }) => /control\.js|planning/.test(name)), []);
    await page.click("#balance");
    await says(page, "#thought", /^Plan of \d/);
    assert.match(page.workers()[0].url(), /planning\.js$/);
    await page.selectOption("#pace", "4");
    await holds(page);
    await page.selectOption("#pace", "1");
    await drag(page, 0.3, 400);
    await shows(page, "#return", "0.0 s");
    await page.selectOption("#pace", "4");
    await holds(page);
    await page.click("#pause");
    await page.click("#share");
    [link, state] = [new URL(await page.inputValue("#link")).hash, await shownBits(page)];
    await says(page, "#link-field label", /^Copied: a link with seed, physics and \d{3} torques$/);
  });
  await open({ hash: link, reducedMotion: "reduce" }, async (page) => {
    await says(page, "#status", /^Replay of a link/);
    await steps(page, decodeRun(link).levels.length);
    await showsBits(page, state);
    await steps(page, 2);
    assert.equal(await page.inputValue("#policy"), "planner");
  });
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
