// Trains or measures outside the page's thread, with its own instance of the module. It receives { module, task, … } and
// posts reports. To stop a task, terminate the worker.

import { Acrobot } from "./module.js";

/** The time between two reports of a training, ms. */
const PERIOD = 150;

const tasks = {
  train(acrobot, { seed, episodes }) {
    acrobot.beginTraining(episodes, seed);
    let returns = [];
    let reported = performance.now();
    for (let episode = 1; episode <= episodes; episode++) {
      returns.push(acrobot.train());
      if (episode === episodes || performance.now() - reported >= PERIOD) {
        postMessage({ returns, weights: acrobot.save() });
        returns = [];
        reported = performance.now();
      }
    }
  },

  speed(acrobot) {
    const scalar = fastest(1_000_000, (steps) => acrobot.scalarSteps(steps));
    const batch = fastest(4_000_000, (steps) => acrobot.batchSteps(steps / 1000)) * 1.024;
    postMessage({ scalar, batch });
  },
};

/** Steps per second in the best of ten runs. During the first the browser may still compile. */
function fastest(steps, run) {
  let best = Infinity;
  for (let round = 0; round < 10; round++) {
    const start = performance.now();
    run(steps);
    best = Math.min(best, performance.now() - start);
  }
  return (steps / best) * 1000;
}

onmessage = ({ data }) => {
  const done = Acrobot.load(data.module).then((acrobot) => tasks[data.task](acrobot, data));
  done.catch((error) => postMessage({ failed: String(error) }));
};
