// Trains outside the page's thread. It receives { seed, episodes, params } and posts reports. To
// stop the training, terminate the worker.

import { Acrobot } from "./acrobot-rs/index.js";
import { Learner } from "./acrobot-rs/policies.js";

/** The time between two reports, ms. */
const PERIOD = 150;

onmessage = ({ data: { seed, episodes, params } }) => {
  const acrobot = new Acrobot({ task: "balance", params });
  const learner = new Learner({ episodes, seed, acrobot });
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
};
