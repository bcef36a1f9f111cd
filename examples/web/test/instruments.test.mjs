// A machine that is not perfect: its motor and its encoders.

import assert from "node:assert/strict";
import { test } from "node:test";

import { FULL, Game } from "../dist/game.js";
import { DEFAULTS, FAULTY } from "../dist/settings.js";
import { linked, onPage, open, paused, press, says, shownBits, showsBits } from "./player.mjs";

test("a motor acts late and slowly, and a run has what acts", () => {
  const params = { ...DEFAULTS, actionDelay: 2, motorLag: 0.1 };
  const game = new Game(1n, params);
  for (let step = 0; step < 4; step++) game.send(FULL);
  // In each step two thirds of the rest, by implicit Euler.
  assert.deepEqual(game.levels, [0, 0, ...[2 / 3, 8 / 9].map((part) => Math.round(part * FULL))]);
  const replay = new Game(1n, params);
  for (const level of game.levels) replay.step(level);
  assert.deepEqual(replay.numbers, game.numbers);
  // From an earlier step, the same levels are on their way.
  game.seek(3);
  game.send(-FULL);
  assert.deepEqual(game.levels, replay.levels);
  for (const wrong of [{ actionDelay: 1.5 }, { encoderZero2: 4 }, { encoderCounts: -1 }]) {
    const [name] = Object.keys(wrong);
    assert.throws(() => game.change({ ...params, ...wrong }), { message: RegExp(`^${name} must`) });
  }
});

onPage("the planner holds by the estimate, and falls without it", {}, async (page) => {
  await page.click("#faulty");
  await page.click("#balance");
  await page.selectOption("#pace", "4");
  await says(page, "#return", /^1\d\.\d s$/);
  assert.equal(await page.inputValue("#machine"), "Gymnasium, 5 N m");
  // The ghost's grey.
  assert.ok(await page.evaluate(() => {
    const context = document.querySelector("#picture").getContext("2d");
    return new Uint32Array(context.getImageData(0, 0, 900, 900).data.buffer).includes(0xff6d685c);
  }));
  await page.uncheck("#estimate");
  await says(page, "#return", /^0\.0 s$/);
  await page.waitForTimeout(2500);
  await says(page, "#return", /^0\.\d s$/);
  await page.click("#ideal");
  assert.ok(await page.isChecked("#estimate"));
  await says(page, "#return", /^[2-9]\.\d s$/);
});

test("a link has the faults, and its replay the same bits", async () => {
  let hash, state;
  await open({}, async (page) => {
    await paused(page, 3);
    await page.click("#faulty");
    await page.uncheck("#estimate");
    await press(page, [2, 2, 2, 0, 0]);
    const { params, levels } = await linked(page);
    assert.deepEqual(params, { ...DEFAULTS, ...FAULTY, estimate: 0 });
    assert.deepEqual(levels, [0, 0, FULL, FULL, FULL]);
    state = await shownBits(page);
    ({ hash } = new URL(await page.inputValue("#link")));
  });
  assert.match(hash, /actionDelay=2.*encoderCounts=1024.*estimate=0/);
  await open({ hash }, async (page) => {
    await says(page, "#status", /^The replay has ended/);
    await showsBits(page, state);
    assert.equal(await page.isChecked("#estimate"), false);
    assert.equal(await page.inputValue("#encoderZero1"), "0.018");
  });
});
