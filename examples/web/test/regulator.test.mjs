// The panel of the regulator.

import assert from "node:assert/strict";
import { test } from "node:test";

import { eigenvalues, leanOf, torqueBy } from "../dist/law.js";
import { linked, onPage, says, shows, text } from "./player.mjs";

test("eigenvalues are those of a matrix", () => {
  for (const [matrix, expected] of [
    [
      [[2, 1, 0, 0], [0, 3, 0, 5], [0, 0, -1, 1], [0, 0, 0, 0.5]],
      [[-1, 0], [0.5, 0], [2, 0], [3, 0]],
    ],
    [
      [[0, 1, 0, 7], [-4, 0, 3, 0], [0, 0, 1, -1], [0, 0, 1, 1]],
      [[0, -2], [0, 2], [1, -1], [1, 1]],
    ],
  ]) {
    const found = eigenvalues(matrix);
    found.sort(([a, b], [c, d]) => Math.round(1e6 * (a - c)) || b - d);
    found.flat().forEach((value, i) => {
      assert.ok(Math.abs(value - expected.flat()[i]) < 1e-6, `${found}`);
    });
  }
});

test("the torque is that of the deviation from upright", () => {
  for (const theta1 of [3, -3]) {
    const lean = theta1 - Math.sign(theta1) * Math.PI;
    assert.equal(leanOf(theta1), lean);
    const torque = torqueBy([1, 2, 3, 4], { theta1, theta2: 0.5, dtheta1: 2, dtheta2: 1 });
    assert.equal(torque, -(lean + 1 + 6 + 4));
  }
});

onPage("the regulator plays, and gain, poles and region follow the weights", {}, async (page) => {
  await page.selectOption("#machine", "Gymnasium, 5 N m");
  await page.fill("#dt", "0.01");
  await page.click("#regulate-upright");
  // The gain of docs/control.md.
  await shows(page, "#gain", "−182.3, −45.5, −86.0, −28.0");
  await says(page, "#verdict-now", /^it holds from here$/);
  await says(page, "#return", /^[2-9]\.\d s$/);
  const poles = await text(page, "#poles");
  await page.fill("#weight4", "3");
  assert.notEqual(await text(page, "#poles"), poles);
  await shows(page, "#weight4-value", "1000");
  // Far from the region.
  const { width, height } = await page.locator("#plane").boundingBox();
  await page.click("#plane", { position: { x: 0.9 * width, y: 0.1 * height } });
  await says(page, "#verdict-now", /^it falls$/);
  // By keys, one cell to the right of upright: the state is out of sight.
  await page.waitForFunction(() => document.querySelector("#return").textContent === "0.0 s");
  await page.waitForTimeout(2000);
  await page.focus("#plane");
  await page.keyboard.press("ArrowRight");
  const { start } = await linked(page);
  assert.ok(Math.abs(start.theta1 - Math.PI - 0.0128) < 1e-4, `${start.theta1}`);
  assert.deepEqual([start.theta2, start.dtheta1, start.dtheta2], [0, 0, 0]);
  await page.fill("#gravity", "0");
  await says(page, "#status", /^Gravity is 0/);
  assert.match(await text(page, "#regulator-reason"), /^Gravity is 0/);
  await page.fill("#gravity", "9.8");
  await shows(page, "#pause", "Pause");
});
