// The page's functions, in Node.js.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { randoms } from "../../../bindings/npm/test/module.mjs";
import { Acrobot } from "../dist/acrobot-rs/index.js";
import { Learner } from "../dist/acrobot-rs/policies.js";
import { FULL, Game, UNITS } from "../dist/game.js";
import { decodeRun, encodeRun } from "../dist/link.js";
import { placeOf } from "../dist/places.js";
import { ticks } from "../dist/plot.js";
import { pull } from "../dist/push.js";
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
  assert.ok(html.includes(`>−${-BASELINE}<`));
});

test("the picture between two steps moves from one to the other", () => {
  const game = new Game(42n, DEFAULTS);
  while (game.end === null) {
    const before = game.numbers;
    const push = game.steps % 9 === 0 ? [UNITS / 4, -UNITS / 2] : null;
    game.step(before[2] > 0 ? -FULL : FULL, push);
    assert.equal(game.between(1), game.acrobot);
    for (const [part, row, more] of [[1e-4, before, push ?? [0, 0]], [1 - 1e-4, game.numbers]]) {
      Object.values(game.between(part).state).forEach((value, i) => {
        const expected = row[i] + (more?.[i - 2] ?? 0) / UNITS;
        assert.ok(Math.abs(Math.sin((value - expected) / 2)) < 1e-3, `${value} and ${expected}`);
      });
    }
  }
  game.begin(0n, { ...DEFAULTS, dt: 1e-45 });
  game.step(FULL);
  game.between(0.25);
});

test("an invalid link is rejected with the reason", () => {
  for (const [bad, message] of [
    ["#seed=4&actions=13", /^actions must be at most 500 of 0, 1 and 2, got "13"$/],
    ["#seed=", /^seed must have from 1 to 600 decimal digits, got ""$/],
    ["#torques=2048", /^torques must be at most 500 integers up to ±2047, got "2048"$/],
    ["#torques=1&pushes=1_2_3", /^pushes must be of steps, got \[1,2,3\]$/],
    ["#state=1_2_3", /^state must be 4 numbers, got \[1,2,3\]$/],
    ["#policy=learnt", /^policy in the link must be planner, .*, got "learnt"$/],
    [`#controller=${"a".repeat(4001)}`, /^controller must have at most 4000 characters, got ""$/],
    ["#return=1", /^return must be from -500 to 0, got "1"$/],
    ["#held=x", /^held must be from 0 to 1000000, got "x"$/],
    ["#sed=4", /^names in the link must be seed, .*, got "sed"$/],
  ]) {
    assert.throws(() => decodeRun(bad), { message });
  }
});

/** A run of a game that has forgotten its beginning, with random torques and pushes. */
function longRun(below) {
  const game = new Game(7n, { ...DEFAULTS, dt: 0.02, torque: 5 });
  game.release();
  for (let step = 0; step < 700; step++) {
    const push = step % 9 === 0 ? [below(9001) - 4500, below(9001) - 4500] : null;
    game.step(below(2 * FULL + 1) - FULL, push);
  }
  return game;
}

test("the link of a game without an end replays the bits of its last steps", () => {
  const game = longRun(randoms());
  const { state, params: machine } = game.acrobot;
  const other = new Acrobot({ params: machine });
  other.state = { ...state, dtheta1: state.dtheta1 + 1, dtheta2: state.dtheta2 - 0.5 };
  other.stepTorque(5);
  game.step(FULL, [UNITS, -UNITS / 2]);
  assert.deepEqual(game.acrobot.state, other.state);

  const { seed, params, start, levels, pushes } = decodeRun(encodeRun({ ...game, scores: {} }));
  assert.deepEqual([levels.length, game.steps, game.end], [500, 701, null]);
  const replay = new Game(seed, params);
  replay.begin(seed, params, start);
  replay.free = true;
  levels.forEach((level, step) => replay.step(level, pushes[step]));
  assert.deepEqual(replay.numbers, game.numbers);
});

test("a game goes back, and on from there with the same bits", () => {
  const game = longRun(randoms());
  assert.deepEqual(game.span, [0, 700]);
  game.change({ ...game.params, mass1: 2 });
  for (let step = 0; step < 9; step++) game.step(FULL);
  for (const [step, mass, kept] of [[705, 2, 5], [700, 1, 0], [690, 1, 0], [709, 2, 9]]) {
    game.seek(step);
    assert.deepEqual([game.steps, game.params.mass1, game.span[1]], [step, mass, 709]);
    assert.deepEqual(game.numbers, game.rows[step].numbers);
    assert.deepEqual(Object.values(game.acrobot.state), [...game.numbers.slice(0, 4)]);
    const other = longRun(randoms());
    other.change({ ...game.params, mass1: 2 });
    for (let step = 0; step < 9; step++) other.step(FULL);
    other.seek(step);
    other.cut();
    assert.deepEqual([other.span[1], other.levels.length], [step, kept]);
    const { seed, params, start, levels, pushes } = decodeRun(encodeRun({ ...other, scores: {} }));
    const replay = new Game(seed, params);
    replay.begin(seed, params, start);
    replay.free = true;
    levels.forEach((level, i) => replay.step(level, pushes[i]));
    assert.deepEqual(replay.numbers.slice(0, 4), game.numbers.slice(0, 4));
  }
  const long = new Game(1n, { ...DEFAULTS, dt: 0.02 });
  long.release();
  for (let step = 0; step < 4000; step++) long.step(0);
  assert.deepEqual([...long.span, long.window[0]], [1000, 4000, 3500]);
});

test("a pull does the work that the energy gains", () => {
  const below = randoms();
  const part = () => below(1000) / 500 - 1;
  const acrobot = new Acrobot({ params: { mass2: 1.5, length1: 1.2, length2: 0.7, dt: 0.05 } });
  for (let i = 0; i < 200; i++) {
    const before = { theta1: 3 * part(), theta2: 3 * part(), dtheta1: part(), dtheta2: part() };
    const point = { link: below(2), part: below(100) / 99 };
    const target = [2 * part(), 2 * part()];
    acrobot.state = before;
    const { energy, params } = acrobot;
    const change = pull(point, target, before, params);
    const after = { ...before };
    change.forEach((more, j) => (after[`dtheta${j + 1}`] += more));
    acrobot.state = after;
    // The velocity of the point, from its places.
    const place = placeOf(point, before, params);
    const velocity = ({ dtheta1, dtheta2 }) => {
      const [theta1, theta2] = [before.theta1 + 1e-6 * dtheta1, before.theta2 + 1e-6 * dtheta2];
      return placeOf(point, { theta1, theta2 }, params).map((x, j) => (x - place[j]) / 1e-6);
    };
    const [first, last] = [velocity(before), velocity(after)];
    const work = [0, 1].map((j) => {
      const force = 60 * (target[j] - place[j] - 0.05 * last[j]) - 8 * last[j];
      return (0.05 * force * (first[j] + last[j])) / 2;
    });
    const gained = acrobot.energy - energy;
    assert.ok(Math.abs(gained - work[0] - work[1]) < 1e-4, `${gained} and ${work}`);
  }
});

test("any link is replayed or is rejected with the reason", () => {
  const game = new Game(0n, DEFAULTS);
  // A zero with a sign.
  const params = { ...DEFAULTS, mass1: 1.5, dt: 0.05, gravity: -0, dynamics: "nips" };
  const levels = ACTIONS.map((action) => FULL * (action - 1));
  const player = { policy: undefined, controller: undefined, scores: {} };
  const run = { seed: 42n, params, ...player, start: null, levels };
  const short = { ...run, pushes: levels.map(() => null) };
  const scores = { return: -70, held: 2.5 };
  const pushes = levels.map(() => [UNITS, -1]);
  const pushed = { ...short, policy: "planner", scores, controller: "a\n&b", pushes };
  const start = { theta1: 1, theta2: -0.5, dtheta1: 1e-9, dtheta2: -0 };
  const links = [short, { ...pushed, start }, pushed].map((run) => {
    assert.deepEqual(decodeRun(encodeRun(run)), run);
    return encodeRun(run);
  });
  const others = [..."#&=%+-_.,09eEnaAzZ \u00e9\u{1f600}"];
  const below = randoms();
  let played = 0;
  for (let i = 0; i < 3000; i++) {
    const link = links[i % 3];
    const at = 1 + below(link.length);
    const added = others[below(others.length)].repeat(below(3));
    const changed = link.slice(0, at) + added + link.slice(at + below(10));
    try {
      const run = decodeRun(changed);
      assert.deepEqual(decodeRun(encodeRun(run)), run, changed);
      game.begin(run.seed, run.params, run.start);
      run.levels.forEach((level, step) => game.step(level, run.pushes[step]));
      played++;
    } catch ({ message }) {
      assert.match(message, / must /, changed);
    }
  }
  assert.ok(played > 100 && played < 2900, `${played} of 3,000 links were replayed`);
});
