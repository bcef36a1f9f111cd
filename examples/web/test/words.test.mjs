// What the page says, and where.

import assert from "node:assert/strict";

import { onPage, paused, says, shows, stepped, text } from "./player.mjs";

onPage("after the goal all numbers are those of the last step", {}, async (page) => {
  await page.selectOption("#pace", "4");
  await says(page, "#verdict", /^Goal!/);
  await page.waitForFunction(() => {
    const [, height] = /tip height (\d\.\d\d) m/.exec(document.body.textContent) ?? [];
    return Number(height) > 1;
  }, undefined, { timeout: 1000 });
  const energy = async () => /Energy(.*) J/.exec(await text(page, "#energy-caption"))[1];
  const last = await energy();
  await page.click("#pause");
  assert.equal(await energy(), last);
});

for (const [name, back, reason] of [
  ["gravity", "9.8", /^Gravity is 0/],
  ["torque", "5", /^The motor's largest torque is 0/],
]) {
  onPage(`with ${name} of 0 the planner says why, and then goes on`, {}, async (page) => {
    await page.click("#balance");
    await page.fill(`#${name}`, "0");
    await says(page, "#status", reason);
    await page.fill(`#${name}`, back);
    const now = Number(await text(page, "#step"));
    await stepped(page, now + 20);
    await shows(page, "#pause", "Pause");
  });
}

onPage("the panel shows the machine that is set", {}, async (page) => {
  const machine = () => page.inputValue("#machine");
  await page.click("#balance");
  await says(page, "#status", /^The machine is now Gymnasium, 5 N m/);
  await page.fill("#mass1", "1.5");
  assert.equal(await machine(), "");
  await shows(page, "#machine :checked", "Changed");
  await page.selectOption("#machine", "Gymnasium, 5 N m");
  assert.equal(await page.inputValue("#mass1"), "1");
  await page.selectOption("#dynamics", "nips");
  assert.equal(await machine(), "");
});

onPage("a training has only lines of its own machine, and a rule", {}, async (page) => {
  await paused(page, 1);
  await page.fill("#episodes", "110");
  await page.fill("#torque", "2");
  await page.click("#train");
  await says(page, "#train", /^Train$/);
  assert.doesNotMatch(await text(page, "#training-status"), /threshold/);
  const caption = await page.innerText("#curve-caption");
  assert.doesNotMatch(caption, /threshold/);
  assert.match(caption, /Bang-bang: −\d+\s*$/);
  assert.doesNotMatch(caption, /−84/);
  await page.fill("#friction", "0.1");
  await page.click("#train");
  await shows(page, "#training-reason", "friction must be 0 N m s/rad to train, got 0.1");
  await shows(page, "#train", "Train");
});

onPage("one polite status says what happens, and numbers are silent", {}, async (page) => {
  const live = "output, [role=status], [role=log], [aria-live]";
  assert.deepEqual(await page.$$eval(live, (all) => all.map(({ id }) => id)), ["status"]);
  await page.evaluate(() => {
    window.said = [];
    const status = document.querySelector("#status");
    new MutationObserver(() => window.said.push(status.textContent))
      .observe(status, { childList: true });
  });
  await page.click("#balance");
  await says(page, "#status", /Plan of /);
  await page.waitForTimeout(1000);
  const said = await page.evaluate(() => window.said);
  assert.ok(said.some((text) => text.endsWith("Planning…")) && said.length < 9, said.join("\n"));
});

for (const [width, height] of [[1366, 768], [360, 640]]) {
  const name = `at ${width} × ${height} the hints are in sight, and all is large enough`;
  const screen = { viewport: { width, height }, hasTouch: width < 500, isMobile: width < 500 };
  onPage(name, screen, async (page) => {
    const hint = await page.locator(width < 500 ? "#pause" : "#keys").boundingBox();
    assert.ok(hint.y + hint.height <= height, `${hint.y + hint.height}`);
    const small = await page.$$eval("summary, a, button, select, input:not([type=file])", (all) =>
      all.map((each) => [each.textContent || each.id, each.getBoundingClientRect().height])
        .filter(([, height]) => height > 0 && height < 24));
    assert.deepEqual(small, []);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= width, `${wide}`);
  });
}
