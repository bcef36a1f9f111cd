// A visitor's tour in Chromium, or with `ENGINE=firefox` or `webkit` in another engine.

import assert from "node:assert/strict";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

import { launch } from "../../../bindings/npm/browser.mjs";
import { decodeRun } from "../dist/link.js";

/* global click, pull, release, select */

/** Defines functions that act: `pull` pulls the tip to the side, until `release`. */
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
    window.release = () => send("lostpointercapture", 0.8);
  };
};
const holds = () => /^[1-9]\d*\.\d s$/.test(document.querySelector("#return").textContent);
const falls = () => document.querySelector("#return").textContent === "0.0 s";
const loads = (page) =>
  page.waitForFunction(() => document.querySelector("#balance:enabled") !== null);
/** The text of an element after the next picture, which the page writes it with. */
const text = (page, id) => page.evaluate((id) => new Promise((done) => {
  const read = () => done(document.querySelector(id).textContent);
  requestAnimationFrame(() => requestAnimationFrame(read));
}), id);

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
      select("#pace", "4"); // WebKit draws slowly without a GPU
      click("#balance");
    });
    await page.waitForFunction(holds);
    await page.evaluate(() => (select("#pace", "1"), pull()));
    await page.waitForFunction(falls);
    await page.evaluate(() => (release(), select("#pace", "4")));
    await page.waitForFunction(holds);
    await page.evaluate(() => {
      click("#pause");
      click("#share");
    });
    const [hash, state] = [await page.evaluate(() => location.hash), await text(page, "#state")];
    assert.match(hash, /policy=planner.*torques=/);
    await page.goto("about:blank");
    await page.goto(origin + hash);
    await loads(page);
    await page.evaluate(help);
    if ((await text(page, "#pause")) === "Pause") await page.evaluate(() => click("#pause"));
    const { levels } = decodeRun(hash);
    for (let step = Number(await text(page, "#step")); step < levels.length; step++) {
      await page.evaluate(() => click("#single"));
    }
    assert.equal(Number(await text(page, "#step")), levels.length);
    assert.equal(await text(page, "#state"), state);
  } finally {
    await close();
  }
});

test("the user's own controller plays, and stops with a line", async () => {
  const dist = fileURLToPath(new URL("../dist", import.meta.url));
  const { browser, origin, close } = await launch(dist);
  try {
    const page = await browser.newPage();
    await page.goto(origin);
    await loads(page);
    await page.evaluate(help);
    await page.evaluate(() => (document.querySelector("#own").open = true));
    await page.waitForFunction(() => document.querySelector("#code").value !== "");
    await page.evaluate(() => (select("#example", "LQR"), click("#run-upright")));
    await page.waitForFunction(holds);
    for (const [line, reason] of [["while (true) {}", "loop did not end"], ["x.y()", "x"]]) {
      await page.evaluate((line) => {
        document.querySelector("#code").value = `function torque() {\n  ${line}\n}`;
        click("#run");
      }, line);
      await page.waitForFunction((start) => {
        const { textContent } = document.querySelector("#code-reason");
        return textContent.startsWith(start);
      }, `Line 2, “${line}”: `);
      assert.match(await text(page, "#code-reason"), new RegExp(reason));
    }
  } finally {
    await close();
  }
});
