// The page's functions, in Node.js.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { randoms } from "../../../bindings/npm/test/module.mjs";
import { Acrobot } from "../dist/acrobot-rs/index.js";
import { Learner } from "../dist/acrobot-rs/policies.js";
import { Game } from "../dist/game.js";
import { decodeRun, encodeRun } from "../dist/link.js";
import { ticks } from "../dist/plot.js";
import { DEFAULTS } from "../dist/settings.js";
import { BASELINE } from "../dist/training.js";
import { ACTIONS } from "./native.mjs";

test("a plot has a scale, whatever its range", () => {
  for (let high = 0.01; high < 1000; high *= 1.01) {
    assert.ok(ticks(-high, high, 4).length >= 3, `±${high}`);
    assert.ok(ticks(0, high, 4).length >= 2, `0 to ${high}`);
  }
});

test("the curve's baseline is the mean return of the untrained policy", () => {
  const [learner, acrobot, episodes] = [new Learner(), new Acrobot({ seed: 42 }), 1000];
  let sum = 0;
  for (let episode = 0; episode < episodes; episode++, acrobot.reset()) {
    for (let step = {}; !step.terminated && !step.truncated; sum += step.reward) {
      step = acrobot.step(learner.act(acrobot));
    }
  }
  assert.ok(Math.abs(sum / episodes - BASELINE) < 2, `${sum / episodes}`);
  const html = readFileSync(new URL("../dist/index.html", import.meta.url), "utf8");
  assert.ok(html.includes(`untrained: −${-BASELINE}<`));
});

test("the picture between two steps has the angles and velocities of both", () => {
  const game = new Game(42n, DEFAULTS);
  let turned = 0;
  while (game.end === null) {
    const before = game.numbers;
    game.step(before[2] > 0 ? 0 : 2);
    for (const [part, state] of [[0, before], [1, game.numbers]]) {
      ["theta1", "theta2"].forEach((name, i) => {
        const angle = (part) => game.between(part)[name];
        assert.ok(Math.abs(Math.sin((angle(part) - state[i]) / 2)) < 1e-6);
        const velocity = (angle(part + 1e-4) - angle(part - 1e-4)) / 2e-4 / 0.2;
        assert.ok(Math.abs(velocity - state[i + 2]) < 1e-4, `${velocity} and ${state[i + 2]}`);
      });
    }
    turned += Math.abs(before[1] - game.numbers[1]) > Math.PI;
    const mean = 0.1 * (before[3] + game.numbers[3]);
    assert.ok(Math.abs(game.between(1).theta2 - before[1] - mean) <= Math.PI);
  }
  assert.ok(turned > 0);
  // A step with more turns than a picture can show.
  game.begin(0n, { ...DEFAULTS, dt: 1e30 });
  game.step(2);
  assert.ok(Math.abs(game.between(0.5).theta1) < 1e6);
});

test("an invalid link is rejected with the reason", () => {
  for (const [bad, message] of [
    ["#seed=4&actions=13", /^actions must be at most 500 of 0, 1 and 2, got "13"$/],
    ["#seed=", /^seed must have from 1 to 600 decimal digits, got ""$/],
    ["#sed=4", /^names in the link must be seed, .*, got "sed"$/],
  ]) {
    assert.throws(() => decodeRun(bad), { message });
  }
});

test("any link is replayed or is rejected with the reason", () => {
  const game = new Game(0n, DEFAULTS);
  // A zero with a sign.
  const params = { ...DEFAULTS, mass1: 1.5, dt: 0.05, gravity: -0, dynamics: "nips" };
  const link = encodeRun({ seed: 42n, params, actions: ACTIONS });
  assert.deepEqual(decodeRun(link), { seed: 42n, params, actions: ACTIONS });
  const others = [..."#&=%+-_.,09eEnaAzZ \u00e9\u{1f600}"];
  const below = randoms();
  let played = 0;
  for (let i = 0; i < 2000; i++) {
    const at = 1 + below(link.length);
    const added = others[below(others.length)].repeat(below(3));
    const changed = link.slice(0, at) + added + link.slice(at + below(10));
    try {
      const run = decodeRun(changed);
      assert.deepEqual(decodeRun(encodeRun(run)), run, changed);
      game.begin(run.seed, run.params);
      for (const action of run.actions) game.step(action);
      played++;
    } catch ({ message }) {
      assert.match(message, / must /, changed);
    }
  }
  assert.ok(played > 100 && played < 1900, `${played} of 2,000 links were replayed`);
});
