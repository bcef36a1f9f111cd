// What is touched, and the layout, on a phone and on a desktop.

import assert from "node:assert/strict";

import { linkedActions, onPage, paused, stepped, text } from "./player.mjs";

const touched = { hasTouch: true, isMobile: true };
const SCREENS = {
  phone: { viewport: { width: 390, height: 844 }, ...touched },
  landscape: { viewport: { width: 844, height: 390 }, ...touched },
  desktop: { viewport: { width: 1280, height: 900 } },
};

/**
 * Returns a function that touches an element: the type of the event, and for each finger the part
 * of the element's width, from the left.
 */
async function fingers(page, selector) {
  await page.locator(selector).scrollIntoViewIfNeeded();
  const { x, y, width, height } = await page.locator(selector).boundingBox();
  const session = await page.context().newCDPSession(page);
  const at = (part) => ({ x: x + part * width, y: y + height / 2, id: part * 10 });
  return (type, ...parts) =>
    session.send("Input.dispatchTouchEvent", { type, touchPoints: parts.map(at) });
}

onPage("a touched button applies torque until it is released", SCREENS.phone, async (page) => {
  await paused(page, 42);
  await page.focus("#stage");
  const touch = await fingers(page, "#right");
  await touch("touchStart", 0.5);
  await page.keyboard.press("s");
  await touch("touchEnd");
  await page.keyboard.press("s");
  assert.deepEqual(await linkedActions(page), [2, 1]);
});

onPage("a touched half of the picture applies torque", SCREENS.landscape, async (page) => {
  await paused(page, 42);
  const touch = await fingers(page, "#stage");
  const step = () => page.evaluate(() => document.querySelector("#single").click());
  for (const event of [
    ["touchStart", 0.2],
    ["touchEnd"],
    ["touchStart", 0.9],
    ["touchStart", 0.9, 0.2],
    ["touchEnd", 0.2], // the finger that leaves
    ["touchEnd"],
  ]) {
    await touch(...event);
    await text(page, "#step");
    await step();
  }
  assert.deepEqual(await linkedActions(page), [0, 1, 2, 1, 2, 1]);
});

/** Pairs of controls and texts that overlap. The picture may be behind its own texts. */
const overlaps = (page) =>
  page.evaluate(() => {
    const found = document.querySelectorAll(
      "button, input, select, label, p, figcaption, figure canvas, #stage, h1, h2, summary",
    );
    const boxes = [...found].filter((element) => element.checkVisibility()).map((element) => {
      const { left, right, top, bottom } = element.getBoundingClientRect();
      return { element, left, right, top: top + 0.5, bottom: bottom - 0.5 };
    });
    const before = (a, b) => a.right <= b.left || a.bottom <= b.top;
    const isOverlap = (a, b) => !a.element.contains(b.element) && !before(a, b) && !before(b, a);
    return boxes.flatMap((a, i) => {
      const others = boxes.slice(i + 1).filter((b) => isOverlap(a, b));
      return others.map((b) => `${a.element.outerHTML} and ${b.element.outerHTML}`);
    });
  });

for (const [name, options] of Object.entries(SCREENS)) {
  onPage(`a ${name} shows what its player needs, and nothing overlaps`, options, async (page) => {
    const { width, height } = options.viewport;
    assert.equal(await page.isVisible("#touch"), Boolean(options.hasTouch));
    assert.equal(await page.isVisible("#keys"), !options.hasTouch);
    assert.equal(/←|→/.test(await text(page, "#status")), !options.hasTouch);
    const inView = async (...ids) => {
      for (const id of ids) {
        const box = await page.locator(`#${id}`).boundingBox();
        const isInside = box.x >= 0 && box.x + box.width <= width;
        assert.ok(isInside && box.y >= 0 && box.y + box.height <= height, id);
      }
    };
    await inView("stage", "left", "right", "pause", "reset", "step", "best");
    const stage = await page.locator("#stage").boundingBox();
    assert.ok(stage.width > 0.8 * Math.min(width, height, 500), `${stage.width}`);
    await page.selectOption("#pace", "4");
    await stepped(page, 40);
    await page.click("#pause");
    // The picture stays in view.
    for (const id of ["drive", "gravity"]) {
      await page.evaluate((id) => document.querySelector(`#${id}`).scrollIntoView(), id);
      await text(page, "#step");
      await inView("stage");
    }
    await page.evaluate(() => scrollTo(0, 0));
    const others = name === "desktop" ? [832, 1000, 1920] : [320, 568, 932];
    for (const other of [width, ...others]) {
      await page.setViewportSize({ width: other, height });
      await text(page, "#step");
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), other);
      assert.deepEqual(await overlaps(page), [], `${other}×${height}`);
    }
  });
}
