// The user's own controller: in a worker, with reasons, and in links.

import assert from "node:assert/strict";
import { test } from "node:test";

import { EXAMPLES } from "../dist/examples.js";
import { watched } from "../dist/loops.js";
import { linked, onPage, open, paused, press, says, shows, stepped, text } from "./player.mjs";

const run = async (page, code) => {
  await page.fill("#code", code);
  await page.click("#run");
};

test("loops call, and other text stays", () => {
  for (const [code, expected] of [
    ["while (a(b)) {}", "while ($loop(1),a(b)) {}"],
    ["\nfor (let i = f(';'); i < 3; i++) g();", "\nfor (let i = f(';'); i < 3;$loop(2), i++) g();"],
    ["for (;;) for (;;);", "for (;;$loop(1)) for (;;$loop(1));"],
    ["do {} while (1); // while (1)", "do {} while ($loop(1),1); // while (1)"],
    ["for (const x of y) 'for (;;)'; a.while(`for (;;)`);"],
    ["for (let f = () => { ; ; }; f(); ) {}", "for (let f = () => { ; ; }; f();$loop(1) ) {}"],
  ]) {
    assert.equal(watched(code), expected ?? code);
  }
});

onPage("each example plays, and two of them hold the acrobot", {}, async (page) => {
  for (const name of Object.keys(EXAMPLES)) {
    await page.selectOption("#example", name);
    await page.click("#run");
    await stepped(page, Number(await text(page, "#step")) + 5);
    if (EXAMPLES[name].strong) {
      await page.click("#run-upright");
      await page.selectOption("#pace", "4");
      await says(page, "#return", /^[2-9]\.\d s$/);
    }
  }
});

onPage("what fails has words and a line, and the page goes on", {}, async (page) => {
  for (const [code, reason] of [
    ["function torque() {\n  while (true) {\n  }\n}", /^Line 2, “while \(true\) \{”: the loop did/],
    ["function torque(state) {\n\n  return state.x.y;\n}", /^Line 3, “return .*TypeError: Ca/],
    ["function torque() {\n  return 1 +;\n}", /^Line 2, “return 1 \+;”: SyntaxError: /],
    ["const q = 1;\nregulator(q, 1);", /^Line 2, “regulator\(q, 1\);”: TypeError: q must /],
    ["const f = () => f();\nf();", /^Line 1, .*RangeError: Maximum call stack/],
    ["const torque = 1;", /^the code needs function torque\(state, t\)\.$/],
    ["function torque() {\n  return 'a';\n}", /^torque must return a finite number, N m, got a\.$/],
    ["function torque() {\n  return eval('1');\n}", /^Line 2, .* EvalError/],
    // The page's content security policy lets it reach no other site.
    [`let to = "";
      addEventListener("securitypolicyviolation", (event) => (to = event.blockedURI));
      fetch("https://gymnasium.farama.org/").catch(() => {});
      function torque() {
        if (to !== "") throw new Error("blocked: " + to);
        return 0;
      }`, /“if .*: blocked: https:\/\/gymnasium\.farama\.org/],
  ]) {
    await run(page, code);
    await says(page, "#code-reason", reason);
    await says(page, "#status", /^Your controller has stopped\. /);
    await shows(page, "#pause", "Play");
  }
  // With another machine it tries again.
  await run(page, "function torque() {\n  return params.mass1 > 1 ? 1 : x;\n}");
  await says(page, "#code-reason", /ReferenceError: x is not defined\.$/);
  await page.fill("#mass1", "2");
  await stepped(page, Number(await text(page, "#step")) + 5);
  await shows(page, "#code-reason", "");
});

test("a link carries the code, which begins only with a click", async () => {
  let hash;
  const code = "// é &\nfunction torque(state, t) {\n  return t < 0.3 ? 1 : -1;\n}\n";
  await open({}, async (page) => {
    await paused(page, 3);
    await run(page, code);
    await page.click("#pause");
    await page.click("#reset");
    for (let step = 1; step < 4; step++) {
      await press(page, [1]);
      await stepped(page, step);
    }
    const { controller, levels } = await linked(page);
    assert.equal(controller, code);
    assert.deepEqual(levels.map(Math.sign), [1, 1, -1]);
    ({ hash } = new URL(await page.inputValue("#link")));
  });
  for (const link of [hash, hash.replace(/&actions=\d+/, "")]) {
    await open({ hash: link }, async (page) => {
      await page.locator("#code-origin").waitFor();
      assert.equal(await page.inputValue("#code"), code);
      assert.equal(await page.isDisabled("[value=own]"), true);
      await page.waitForTimeout(500);
      assert.ok(page.workers().every((worker) => !worker.url().startsWith("blob:")));
      const now = Number(await text(page, "#step"));
      await page.click("#run");
      await stepped(page, now + 5);
      assert.ok(page.workers().some((worker) => worker.url().startsWith("blob:")));
    });
  }
});
