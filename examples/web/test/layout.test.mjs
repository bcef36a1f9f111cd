// What is touched, and the layout, on a phone and on a desktop.

import assert from "node:assert/strict";

import { linked, onPage, paused, text } from "./player.mjs";

const touched = { hasTouch: true, isMobile: true };
const SCREENS = {
  phone: { viewport: { width: 390, height: 844 }, ...touched },
  landscape: { viewport: { width: 844, height: 390 }, ...touched },
  desktop: { viewport: { width: 1280, height: 900 } },
};

onPage("fingers hold torques, and pull the picture", SCREENS.landscape, async (page) => {
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

for (const [name, options] of Object.entries(SCREENS)) {
  onPage(`a ${name} shows what its player needs, and fits its width`, options, async (page) => {
    const { width, height } = options.viewport;
    assert.equal(await page.isVisible("#touch"), Boolean(options.hasTouch));
    assert.equal(await page.isVisible("#keys"), !options.hasTouch);
    assert.equal(/←|→/.test(await text(page, "#status")), !options.hasTouch);
    for (const id of ["stage", "left", "right", "pause", "reset", "step"]) {
      const box = await page.locator(`#${id}`).boundingBox();
      const isInside = box.x >= 0 && box.x + box.width <= width;
      assert.ok(isInside && box.y >= 0 && box.y + box.height <= height, id);
    }
    const stage = await page.locator("#stage").boundingBox();
    assert.ok(stage.width > 0.8 * Math.min(width, height, 500), `${stage.width}`);
    await page.click("#pause");
    for (const other of [width, ...(name === "desktop" ? [832, 1000, 1920] : [320, 568, 932])]) {
      await page.setViewportSize({ width: other, height });
      await text(page, "#step");
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), other);
    }
  });
}
