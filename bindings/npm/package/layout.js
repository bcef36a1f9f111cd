// derive.py writes this file: what acrobot.h says, with the layout in wasm32.

export const TASKS = ["gymnasium", "swingup", "balance"];
export const STATUS = {
  ok: 0, null: 1, misaligned: 2, bufferTooSmall: 3, notInitialized: 4, moved: 5, unknownAction: 6,
  outOfRange: 7, wrongCount: 8, noSuchIndex: 9, overlap: 10, damagedSnapshot: 11, otherSnapshot: 12,
  sharedParams: 13,
};
export const KINDS = {
  outOfRange: 0, notFinite: 1, notSymmetric: 2, notSemidefinite: 3, notInEquilibrium: 4,
  notStabilizable: 5, notDetectable: 6, illConditioned: 7, noPlan: 8, notObservable: 9,
  notExcited: 10,
};

/** Bytes. */
export const SIZES = {
  acrobot: 304, actionSpace: 96, controller: 5808, estimator: 304, parameterEstimator: 1344,
  planner: 752, regression: 992, replanner: 5392, snapshot: 224, swingUp: 496,
};

/** First word of 32 bits, and words. Two bools in one are `flags`. */
export const STRUCTS = {
  acrobot_error_t: {
    value: [0, 2], kind: [2, 1], name: [3, 6], unit: [9, 4], rule: [13, 20],
  },
  acrobot_step_t: {
    observation: [0, 6], reward: [6, 1], flags: [7, 1],
  },
  acrobot_state_t: {
    theta1: [0, 1], theta2: [1, 1], dtheta1: [2, 1], dtheta2: [3, 1],
  },
  acrobot_params_t: {
    length1: [0, 1], length2: [1, 1], mass1: [2, 1], mass2: [3, 1], centerOfMass1: [4, 1],
    centerOfMass2: [5, 1], inertia1: [6, 1], inertia2: [7, 1], gravity: [8, 1], dt: [9, 1],
    maxVelocity1: [10, 1], maxVelocity2: [11, 1], torques: [12, 3], torqueNoise: [15, 1],
    damping1: [16, 1], damping2: [17, 1], coulomb1: [18, 1], coulomb2: [19, 1], rotor: [20, 1],
    dynamics: [21, 1],
  },
  acrobot_draw_t: {
    kind: [0, 1], low: [1, 1], high: [2, 1], mean: [3, 1], std: [4, 1],
  },
  acrobot_rates_t: {
    dtheta1: [0, 1], dtheta2: [1, 1], ddtheta1: [2, 1], ddtheta2: [3, 1],
  },
  acrobot_forces_t: {
    torques: [0, 2], reaction: [2, 2], elbow: [4, 2],
  },
  acrobot_linear_model_t: {
    a: [0, 16], b: [16, 4],
  },
  acrobot_weights_t: {
    q: [0, 16], r: [16, 1],
  },
  acrobot_lqr_t: {
    gain: [0, 4], costToGo: [4, 16],
  },
  acrobot_covariances_t: {
    w: [0, 16], s: [16, 2],
  },
  acrobot_lqe_t: {
    gain: [0, 8], priorCovariance: [8, 16],
  },
  acrobot_cost_t: {
    q: [0, 16], qf: [16, 16], angles: [32, 2], torque: [34, 1], torqueChange: [35, 1],
    power: [36, 1], below: [37, 1], height: [38, 1], margin: [39, 1], arrival: [40, 1],
  },
  acrobot_problem_t: {
    params: [0, 22], limit: [22, 1], target: [23, 4], torque: [27, 1], cost: [28, 41],
  },
  acrobot_knot_t: {
    state: [0, 4], torque: [4, 1], gain: [5, 4], workspace: [9, 2],
  },
  acrobot_feedback_t: {
    target: [0, 4], torque: [4, 1], moving: [5, 20], resting: [25, 20], reach: [45, 1],
  },
  acrobot_noise_t: {
    angleStd: [0, 1], torqueStd: [1, 1],
  },
  acrobot_parameter_std_t: {
    mass1: [0, 1], mass2: [1, 1], length1: [2, 1], inertia1: [3, 1], inertia2: [4, 1],
    damping1: [5, 1], damping2: [6, 1], coulomb1: [7, 1], coulomb2: [8, 1], rotor: [9, 1],
    zero1: [10, 1], zero2: [11, 1], torqueFactor: [12, 1],
  },
  acrobot_fit_t: {
    values: [0, 20], stdErrors: [20, 20], weakest: [40, 20], rankDeficiency: [60, 1],
  },
  acrobot_calibration_t: {
    zeros: [0, 4], delay: [4, 2], predictionError: [6, 2], angleNoise: [8, 2], fit: [10, 62],
    params: [72, 22],
  },
  acrobot_settings_t: {
    params: [0, 22], limit: [22, 1], counts: [23, 2], delay: [25, 1], planTimeout: [26, 1],
  },
  acrobot_report_t: {
    zeros: [0, 2], torqueFactor: [2, 1], misses: [3, 1], planAge: [4, 1],
  },
  acrobot_batch_results_t: {
    rewards: [0, 1], terminated: [1, 1], truncated: [2, 1], observations: [3, 1],
    finalObservations: [4, 1],
  },
  acrobot_batch_settings_t: {
    count: [0, 1], task: [1, 1], ownParams: [2, 1], autoreset: [3, 1], maxSteps: [4, 1],
  },
  acrobot_instruments_t: {
    actionDelay: [0, 1], observationDelay: [1, 1], motorLag: [2, 1], torqueError: [3, 1],
    angleNoise: [4, 1], encoderZero1: [5, 1], encoderZero2: [6, 1], encoderCounts: [7, 1],
    velocityFilter: [8, 1],
  },
};
