// What is touched, on a phone on its side.

import assert from "node:assert/strict";

import { linked, onPage, paused, text } from "./player.mjs";

const screen = { viewport: { width: 844, height: 390 }, hasTouch: true, isMobile: true };

onPage("fingers hold torques, and pull the picture", screen, async (page) => {
  await paused(page, 42);
  const session = await page.context().newCDPSession(page);
  // Type of the event, and for each finger the part of the element's width, from the left.
  for (const [selector, type, ...parts] of [
    ["#left", "touchStart", 0.5],
    ["#left", "touchEnd"],
    ["#right", "touchStart", 0.5],
    ["#right", "touchEnd"],
    ["#stage", "touchStart", 0.9],
    ["#stage", "touchEnd"],
  ]) {
    await page.locator(selector).scrollIntoViewIfNeeded();
    const { x, y, width, height } = await page.locator(selector).boundingBox();
    const at = (part) => ({ x: x + part * width, y: y + height / 2, id: part * 10 });
    await session.send("Input.dispatchTouchEvent", { type, touchPoints: parts.map(at) });
    await text(page, "#step");
    await page.evaluate(() => document.querySelector("#single").click());
  }
  const { levels, pushes } = await linked(page);
  assert.deepEqual(levels.map(Math.sign), [-1, 0, 1, 0, 0, 0]);
  // To the right, and only with the finger.
  const isPushed = pushes.map((push) => push !== null && push[0] > 0);
  assert.deepEqual(isPushed, [false, false, false, false, true, false]);
});
