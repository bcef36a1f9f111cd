// Jest, as CommonJS, and Vitest run this in jsdom: some globals are missing, and Node.js's bytes
// are those of another realm.

import { Acrobot } from "acrobot-rs";
import { Learner, bangBang } from "acrobot-rs/policies";
import { isProxy, reactive, ref } from "vue";

test("an episode is Gymnasium's, Node.js's bytes are a snapshot, and errors have texts", () => {
  const acrobot = new Acrobot({ seed: 42 });
  const bytes = Buffer.from(acrobot.snapshot());
  while (!acrobot.step(bangBang(acrobot)).terminated);
  expect(acrobot.elapsedSteps).toBe(94);
  expect(Acrobot.restore(bytes).elapsedSteps).toBe(0);
  const message = "gravity must be a finite number of m/s², got NaN";
  expect(() => acrobot.setParams({ gravity: NaN })).toThrow(message);
});

test("Vue leaves acrobots and learners alone", () => {
  const acrobot = ref(new Acrobot({ seed: 42 }));
  const { learner } = reactive({ learner: new Learner({ episodes: 1, seed: 1 }) });
  expect([acrobot.value, learner].map(isProxy)).toEqual([false, false]);
  expect(learner.act(acrobot.value)).toBeLessThan(3);
});
