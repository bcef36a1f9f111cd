// Opens the page in a browser and operates it, for the tests in a file that imports this.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";

import { launch } from "../../../bindings/npm/browser.mjs";
import { decodeRun } from "../dist/link.js";

/** Tests write their files here. */
export const folder = mkdtempSync(join(tmpdir(), "acrobot-web-"));
let browser, origin, close;

before(async () => {
  ({ browser, origin, close } = await launch(fileURLToPath(new URL("../dist", import.meta.url))));
});

after(async () => {
  await close?.();
  rmSync(folder, { recursive: true });
});

/**
 * Opens the page and calls `play` once it and the planner have loaded. Asserts that its console has
 * no errors or warnings, and that it requests only its own files.
 */
export async function open({ hash = "", prepare, starts = true, ...options }, play) {
  const permissions = ["clipboard-read", "clipboard-write"];
  const window = await browser.newContext({ permissions, ...options });
  const page = await window.newPage();
  const wrong = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) wrong.push(message.text());
  });
  page.on("pageerror", (error) => wrong.push(error.message));
  window.on("request", (request) => {
    const url = request.url();
    if (!url.replace(/^blob:/, "").startsWith(origin)) wrong.push(`a request for ${url}`);
  });
  if (prepare) await page.addInitScript(prepare);
  await page.goto(origin + hash);
  try {
    await page.$$eval("details", (all) => all.forEach((each) => (each.open = true)));
    const loaded = ["#balance:enabled", "#policy:has([value=regulator]:enabled)", "#code:valid",
      "#curve[width]"];
    if (starts) for (const panel of loaded) await page.waitForSelector(panel);
    await play(page);
    assert.deepEqual(wrong, []);
  } finally {
    await window.close();
  }
}

/** A test in which `play` operates the page, with the options of `open`. */
export const onPage = (name, options, play) => test(name, () => open(options, play));

/** Resolves when the page has drawn its current state. */
const shown = (page) =>
  page.evaluate(
    () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))),
  );

export const text = async (page, selector) => {
  await shown(page);
  return page.textContent(selector);
};

/** Resolves when an element's text matches a pattern. */
export const says = (page, selector, { source }) =>
  page.waitForFunction(
    ([selector, source]) => new RegExp(source).test(document.querySelector(selector).textContent),
    [selector, source],
  );

/** Resolves when the page has taken so many steps. */
export const stepped = (page, count) =>
  page.waitForFunction((count) => document.querySelector("#step").textContent >= count, count);

export const shownBits = async (page) => {
  await shown(page);
  return page.locator("#state code").allTextContents();
};

/** Asserts what an element's text is. */
export const shows = async (page, selector, expected) =>
  assert.equal(await text(page, selector), expected);

export const showsBits = async (page, expected) =>
  assert.deepEqual(await shownBits(page), expected);

/** Pauses the page in the initial state of a seed, and lets the keys play. */
export async function paused(page, seed) {
  await page.selectOption("#policy", "keys");
  if ((await text(page, "#pause")) === "Pause") await page.click("#pause");
  await page.fill("#seed", String(seed));
}

/** Steps once for each action while the action's key is down. */
export async function press(page, actions) {
  await page.focus("#stage");
  for (const action of actions) {
    const key = ["ArrowLeft", null, "ArrowRight"][action];
    if (key) await page.keyboard.down(key);
    await page.keyboard.press("s");
    if (key) await page.keyboard.up(key);
  }
}

/** Lets the policy step, without a wait for each. */
export async function steps(page, count) {
  await page.focus("#stage");
  await page.evaluate((count) => {
    const key = new KeyboardEvent("keydown", { key: "s", bubbles: true });
    for (let i = 0; i < count; i++) document.activeElement.dispatchEvent(key);
  }, count);
}

/** The run in the page's link. */
export async function linked(page) {
  await page.click("#share");
  return decodeRun(new URL(await page.inputValue("#link")).hash);
}

export async function downloaded(page, button) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(button)]);
  return readFileSync(await download.path());
}
