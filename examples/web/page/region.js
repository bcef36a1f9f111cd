// From which states a regulator holds. A worker simulates each state of a grid in the plane of θ1
// and θ1′, and at last that of the machine, and posts for each whether it stands at the end.

import { Batch } from "./acrobot-rs/index.js";
import { leanOf } from "./law.js";

/** How long it is simulated, s, and the most steps. */
const [SECONDS, STEPS] = [4, 400];

onmessage = ({ data: { params, gain, xs, ys, theta2, dtheta2, state } }) => {
  const grid = ys.flatMap((y) => xs.flatMap((x) => [Math.PI + x, theta2, y, dtheta2]));
  const count = grid.length / 4 + 1;
  const batch = new Batch({ task: "balance", params, count, autoreset: "Disabled" });
  batch.setStates([...grid, ...state]);
  const torques = new Float32Array(count);
  const limit = params.torques[2];
  const [k1, k2, k3, k4] = gain;
  let { states } = batch;
  const steps = Math.min(Math.ceil(SECONDS / params.dt), STEPS);
  for (let step = 0; step < steps; step++) {
    for (let i = 0, at = 0; i < count; i++, at += 4) {
      const torque = -(k1 * leanOf(states[at]) + k2 * states[at + 1] + k3 * states[at + 2] +
        k4 * states[at + 3]);
      torques[i] = Math.max(-limit, Math.min(limit, torque));
    }
    batch.stepTorque(torques);
    ({ states } = batch);
  }
  batch.free();
  const stands = (at) => Math.abs(leanOf(states[at])) < 0.1 && Math.abs(states[at + 1]) < 0.1 &&
    Math.abs(states[at + 2]) < 0.5;
  postMessage(Uint8Array.from(torques, (_, i) => Number(stands(4 * i))));
};
