// Controllers to begin with. A `strong` one needs a motor that is stronger than Gymnasium's.

export const EXAMPLES = {
  "Nothing": { code: `// The motor does nothing.
// state has theta1 and theta2, rad, dtheta1 and dtheta2, rad/s. t is in s.
function torque(state, t) {
  return 0; // N m
}
` },
  "Bang-bang": { code: `// Full torque against the velocity of link 1.
function torque(state, t) {
  return state.dtheta1 > 0 ? -params.torque : params.torque;
}
` },
  "Swing up by energy": { code: `// Adds the energy that it lacks for standing upright.
const standing = energy(UPRIGHT); // J
function torque(state, t) {
  const lacks = standing - energy(state);
  return -lacks * state.dtheta1;
}
` },
  "LQR": { strong: true, code: `// A linear-quadratic regulator. It holds near upright only.
const { gain } = regulator(diagonal([1, 1, 1, 1]), 1);
function torque(state, t) {
  const x = deviation(state); // from upright
  return -(gain[0] * x[0] + gain[1] * x[1] + gain[2] * x[2] + gain[3] * x[3]);
}
` },
  "Plan and follow": { strong: true, code: `// Plans once, corrects deviations, and then holds.
let planned;
function torque(state, t) {
  planned ??= plan(state);
  return planTorque(planned, t, state);
}
` },
};
