// Scores to beat, and their links.

import assert from "node:assert/strict";
import { test } from "node:test";

import { linked, onPage, open, paused, press, says, shows, steps, text } from "./player.mjs";

onPage("the game has a score to beat, which a link carries", {}, async (page) => {
  await paused(page, 42);
  await shows(page, "#return-label", "Return, best known: −58.69");
  await page.selectOption("#policy", "bang_bang");
  await steps(page, 200);
  assert.deepEqual((await linked(page)).scores, { return: Number((await text(page, "#return"))
    .replace("−", "-")) });
  // Of an own controller, too.
  await page.selectOption("#example", "Bang-bang");
  await page.click("#run");
  await page.selectOption("#pace", "4");
  await says(page, "#verdict", /^Goal! \d+ steps$/);
  const now = Number((await text(page, "#return")).replace("−", "-"));
  assert.equal(now, (await linked(page)).scores.return);
  await page.fill("#mass1", "2");
  await shows(page, "#return-label", "Upright for");
  await page.evaluate(() => (location.hash = "seed=8&return=-70"));
  await shows(page, "#return-label", "Return, to beat: −70");
});

test("pulls grow until it falls, and a link has the seconds", async () => {
  let hash;
  await open({}, async (page) => {
    await page.selectOption("#machine", "Gymnasium, 5 N m");
    await page.click("#regulate-upright");
    await page.selectOption("#pace", "4");
    await page.click("#challenge");
    await says(page, "#return-label", /^Held, pull 2$/);
    await says(page, "#status", /^It held for \d+\.\d s and fell at pull \d\. That is the score/);
    const { held } = (await linked(page)).scores;
    assert.ok(held > 4 && held < 60, `${held}`);
    ({ hash } = new URL(await page.inputValue("#link")));
  });
  await open({ hash: hash.replace(/&(state|torques|pushes)=[^&]*/g, "") }, async (page) => {
    await page.click("#regulate-upright");
    await page.click("#challenge");
    await says(page, "#return-label", /^Held, pull 1, to beat: \d+\.\d s$/);
    assert.equal(await page.isVisible("#challenge"), false);
  });
});

onPage("the planner holds against pulls that grow", {}, async (page) => {
  await page.click("#balance");
  await page.selectOption("#pace", "4");
  await says(page, "#return", /^[2-9]\.\d s$/);
  await page.click("#challenge");
  await says(page, "#return-label", /^Held, pull 4$/);
  // A restart ends them.
  await page.click("#reset");
  await page.click("#pause");
  await press(page, [1, 1]);
  assert.ok((await linked(page)).pushes.every((push) => push === null));
  await page.click("#pause");
  await page.click("#challenge");
  // What is to beat belongs to its machine.
  await says(page, "#status", /^It held for .* That is the score to beat\./);
  await page.fill("#mass1", "1.1");
  await page.click("#challenge");
  assert.doesNotMatch(await text(page, "#return-label"), /to beat/);
});
