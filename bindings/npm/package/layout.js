// derive.py writes this file: names and places of what acrobot.h has in C.

export const PARAMS = [
  "length1", "length2", "mass1", "mass2", "centerOfMass1", "centerOfMass2", "inertia1", "inertia2",
  "gravity", "dt", "maxVelocity1", "maxVelocity2", "torques", "torqueNoise", "damping1", "damping2",
  "coulomb1", "coulomb2", "rotor", "dynamics",
];

export const WEIGHTS = [
  "q", "qf", "angles", "torque", "torqueChange", "power", "below", "height", "margin", "arrival",
];

export const PARAMETER_STD = [
  "mass1", "mass2", "length1", "inertia1", "inertia2", "damping1", "damping2", "coulomb1",
  "coulomb2", "rotor",
];

export const DRAWS = [
  "fixed", "uniform", "logUniform", "normal",
];

export const TASKS = [
  "gymnasium", "swingup", "balance",
];

/** Bytes, and of each field its first word and words, or byte and bytes of text. */
export const STRUCTS = {
  acrobot_t: {
    size: 304,
  },
  acrobot_error_t: {
    size: 136, value: [0, 2], kind: [2, 1], name: [12, 24], unit: [36, 16], rule: [52, 80],
  },
  acrobot_observation_t: {
    size: 24, cosTheta1: [0, 1], sinTheta1: [1, 1], cosTheta2: [2, 1], sinTheta2: [3, 1],
    dtheta1: [4, 1], dtheta2: [5, 1],
  },
  acrobot_reset_options_t: {
    size: 12, seed: [0, 1], seedWords: [1, 1], bounds: [2, 1],
  },
  acrobot_step_t: {
    size: 32, observation: [0, 6], reward: [6, 1], terminated: [28, 1], truncated: [29, 1],
  },
  acrobot_state_t: {
    size: 16, theta1: [0, 1], theta2: [1, 1], dtheta1: [2, 1], dtheta2: [3, 1],
  },
  acrobot_params_t: {
    size: 88, length1: [0, 1], length2: [1, 1], mass1: [2, 1], mass2: [3, 1], centerOfMass1: [4, 1],
    centerOfMass2: [5, 1], inertia1: [6, 1], inertia2: [7, 1], gravity: [8, 1], dt: [9, 1],
    maxVelocity1: [10, 1], maxVelocity2: [11, 1], torques: [12, 3], torqueNoise: [15, 1],
    damping1: [16, 1], damping2: [17, 1], coulomb1: [18, 1], coulomb2: [19, 1], rotor: [20, 1],
    dynamics: [21, 1],
  },
  acrobot_draw_t: {
    size: 20, kind: [0, 1], low: [1, 1], high: [2, 1], mean: [3, 1], std: [4, 1],
  },
  acrobot_draws_t: {
    size: 420, length1: [0, 5], length2: [5, 5], mass1: [10, 5], mass2: [15, 5],
    centerOfMass1: [20, 5], centerOfMass2: [25, 5], inertia1: [30, 5], inertia2: [35, 5],
    gravity: [40, 5], dt: [45, 5], maxVelocity1: [50, 5], maxVelocity2: [55, 5], torques: [60, 15],
    torqueNoise: [75, 5], damping1: [80, 5], damping2: [85, 5], coulomb1: [90, 5],
    coulomb2: [95, 5], rotor: [100, 5],
  },
  acrobot_rates_t: {
    size: 16, dtheta1: [0, 1], dtheta2: [1, 1], ddtheta1: [2, 1], ddtheta2: [3, 1],
  },
  acrobot_forces_t: {
    size: 24, torques: [0, 2], reaction: [2, 2], elbow: [4, 2],
  },
  acrobot_linear_model_t: {
    size: 80, a: [0, 16], b: [16, 4],
  },
  acrobot_step_model_t: {
    size: 80, a: [0, 16], b: [16, 4],
  },
  acrobot_weights_t: {
    size: 68, q: [0, 16], r: [16, 1],
  },
  acrobot_lqr_t: {
    size: 80, gain: [0, 4], costToGo: [4, 16],
  },
  acrobot_cost_t: {
    size: 164, q: [0, 16], qf: [16, 16], angles: [32, 2], torque: [34, 1], torqueChange: [35, 1],
    power: [36, 1], below: [37, 1], height: [38, 1], margin: [39, 1], arrival: [40, 1],
  },
  acrobot_problem_t: {
    size: 276, params: [0, 22], limit: [22, 1], target: [23, 4], torque: [27, 1], cost: [28, 41],
  },
  acrobot_planner_t: {
    size: 752,
  },
  acrobot_knot_t: {
    size: 44, state: [0, 4], torque: [4, 1], gain: [5, 4], workspace: [9, 2],
  },
  acrobot_region_t: {
    size: 80, gain: [0, 4], factor: [4, 16],
  },
  acrobot_feedback_t: {
    size: 184, target: [0, 4], torque: [4, 1], moving: [5, 20], resting: [25, 20], reach: [45, 1],
  },
  acrobot_swing_up_t: {
    size: 496,
  },
  acrobot_estimator_t: {
    size: 288,
  },
  acrobot_noise_t: {
    size: 8, angleStd: [0, 1], torqueStd: [1, 1],
  },
  acrobot_parameter_estimator_t: {
    size: 960,
  },
  acrobot_parameter_std_t: {
    size: 40, mass1: [0, 1], mass2: [1, 1], length1: [2, 1], inertia1: [3, 1], inertia2: [4, 1],
    damping1: [5, 1], damping2: [6, 1], coulomb1: [7, 1], coulomb2: [8, 1], rotor: [9, 1],
  },
  acrobot_regression_t: {
    size: 992,
  },
  acrobot_sample_t: {
    size: 32, angles: [0, 4], torques: [4, 4],
  },
  acrobot_fit_t: {
    size: 248, values: [0, 20], stdErrors: [20, 20], weakest: [40, 20], rankDeficiency: [60, 1],
  },
  acrobot_controller_t: {
    size: 5552,
  },
  acrobot_settings_t: {
    size: 104, params: [0, 22], limit: [22, 1], counts: [23, 2], ticks: [25, 1],
  },
  acrobot_replanner_t: {
    size: 5376,
  },
  acrobot_action_space_t: {
    size: 96,
  },
  acrobot_batch_results_t: {
    size: 20, rewards: [0, 1], terminated: [1, 1], truncated: [2, 1], observations: [3, 1],
    finalObservations: [4, 1],
  },
  acrobot_batch_settings_t: {
    size: 20, count: [0, 1], task: [1, 1], ownParams: [8, 1], autoreset: [3, 1], maxSteps: [4, 1],
  },
};
