// A visitor's tour in Chromium, or with `ENGINE=firefox` or `webkit` in another engine.

import assert from "node:assert/strict";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

import { launch } from "../../../bindings/npm/browser.mjs";
import { decodeRun } from "../dist/link.js";

/* global click, pull, select */

/** Defines functions that act: `pull` pulls the tip to the side for half a second. */
const help = () => {
  window.click = (id) => document.querySelector(id).click();
  window.select = (id, value) => {
    document.querySelector(id).value = value;
    document.querySelector(id).dispatchEvent(new Event("change", { bubbles: true }));
  };
  window.pull = () => {
    const stage = document.querySelector("#stage");
    stage.setPointerCapture = () => {}; // needs a real pointer
    const { left, top, width } = stage.getBoundingClientRect();
    const send = (type, part) => stage.dispatchEvent(new PointerEvent(type, {
      pointerId: 1, clientX: left + part * width, clientY: top + 0.06 * width, bubbles: true,
    }));
    send("pointerdown", 0.5);
    send("pointermove", 0.8);
    return new Promise((done) => setTimeout(() => done(send("lostpointercapture", 0.8)), 500));
  };
};
const holds = () => /^[1-9]\d*\.\d s$/.test(document.querySelector("#return").textContent);
const loads = (page) => page.waitForFunction(() => document.querySelector("#first") === null);
const bits = (page) => page.evaluate(() => document.querySelector("#state").textContent);

test("the planner holds, is pulled down, and recovers; the link has the same bits", async () => {
  const dist = fileURLToPath(new URL("../dist", import.meta.url));
  const { browser, origin, close } = await launch(dist);
  try {
    const page = await browser.newPage();
    await page.goto(origin);
    await loads(page);
    await page.evaluate(help);
    await page.evaluate(() => {
      select("#rival", "bang_bang");
      click("#balance");
    });
    await page.waitForFunction(holds);
    await page.evaluate(() => pull());
    assert.equal(await page.evaluate(holds), false);
    await page.waitForFunction(holds);
    await page.evaluate(() => {
      click("#pause");
      click("#share");
    });
    const [hash, state] = [await page.evaluate(() => location.hash), await bits(page)];
    assert.match(hash, /policy=planner.*pushes=/);
    await page.goto("about:blank");
    await page.goto(origin + hash);
    await loads(page);
    await page.evaluate(help);
    const text = (id) => page.evaluate((id) => document.querySelector(id).textContent, id);
    if ((await text("#pause")) === "Pause") await page.evaluate(() => click("#pause"));
    const { levels } = decodeRun(hash);
    for (let step = Number(await text("#step")); step < levels.length; step++) {
      await page.evaluate(() => click("#single"));
    }
    await page.waitForFunction(
      (count) => Number(document.querySelector("#step").textContent) === count, levels.length,
    );
    assert.equal(await bits(page), state);
  } finally {
    await close();
  }
});
