// Trains outside the page's thread, with its own instance of the module. It receives { module, seed, episodes } and posts
// reports. To stop the training, terminate the worker.

import { Learner } from "./learner.js";

/** The time between two reports, ms. */
const PERIOD = 150;

async function train({ module, seed, episodes }) {
  const learner = await Learner.make(module, episodes, seed);
  let returns = [];
  let reported = performance.now();
  for (let episode = 1; episode <= episodes; episode++) {
    returns.push(learner.train());
    if (episode === episodes || performance.now() - reported >= PERIOD) {
      postMessage({ returns, weights: learner.save() });
      returns = [];
      reported = performance.now();
    }
  }
}

onmessage = ({ data }) => train(data).catch((error) => postMessage({ failed: String(error) }));
