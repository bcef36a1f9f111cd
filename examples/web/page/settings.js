// What the page can set: the seed and the parameters.

/** The most steps of an episode, and of a link. */
export const LIMIT = 500;

/**
 * By the element that has their fields: name, label, unit, Gymnasium's value, the slider's end and
 * step, a hint, and its start.
 */
const TABLES = {
  params: [
    ["dt", "Time step dt", "s", 0.2, 0.5, 0.01],
    ["torque", "Largest torque of the motor", "N m", 1, 10, 0.1, "", 0],
    ["mass1", "Mass of link 1", "kg", 1, 4, 0.05],
    ["mass2", "Mass of link 2", "kg", 1, 4, 0.05],
    ["length1", "Length of link 1", "m", 1, 3, 0.05, "Its centre of mass stays."],
    ["length2", "Length of link 2", "m", 1, 3, 0.05,
      "Changes only the picture and the tip height."],
    ["gravity", "Gravity", "m/s²", 9.8, 25, 0.1, "", 0],
    ["friction", "Friction of both joints", "N m s/rad", 0, 1, 0.01, "", 0],
  ],
  others: [
    ["centerOfMass1", "Centre of mass of link 1", "m", 0.5, 2, 0.05, "", 0],
    ["centerOfMass2", "Centre of mass of link 2", "m", 0.5, 2, 0.05, "", 0],
    ["inertia1", "Inertia of link 1", "kg m²", 1, 2, 0.01, "", 0],
    ["inertia2", "Inertia of link 2", "kg m²", 1, 2, 0.01, "", 0],
    ["maxVelocity1", "Bound of θ1′", "rad/s", 4 * Math.PI, 100, 1],
    ["maxVelocity2", "Bound of θ2′", "rad/s", 9 * Math.PI, 100, 1],
  ],
  instruments: [
    ["actionDelay", "Delay of the torque", "steps", 0, 8, 1, "A torque acts so much later.", 0],
    ["motorLag", "Lag of the motor", "s", 0, 0.1, 0.005, "A time constant: it follows slowly.", 0],
    ["noise", "Noise of the motor", "N m", 0, 2, 0.05, "A standard deviation.", 0],
    ["encoderCounts", "Counts of the encoders", "1/turn", 0, 8192, 256, "0: exact.", 0],
    ["encoderZero1", "Zero of encoder 1", "rad", 0, 0.036, 0.002, "What it reads at 0.", -0.036],
    ["encoderZero2", "Zero of encoder 2", "rad", 0, 0.036, 0.002, "", -0.036],
    ["angleNoise", "Noise of the encoders", "rad", 0, 0.01, 0.0005, "A standard deviation.", 0],
  ],
};
export const PARAMETERS = Object.entries(TABLES).flatMap(([place, table]) =>
  table.map(([name, label, unit, value, end, step, hint = "", start = step]) => {
    return { place, name, label, unit, value, end, step, hint, start };
  }));
const valuesOf = (...places) => Object.fromEntries(
  PARAMETERS.filter(({ place }) => places.includes(place)).map(({ name, value }) => [name, value]),
);

/** Instruments without a fault. `estimate` is whether policies get an estimate of the state. */
export const IDEAL = { ...valuesOf("instruments"), estimate: 1 };
/** The planner holds a machine with these faults with the estimate, and not without it. */
export const FAULTY = {
  ...IDEAL, actionDelay: 2, encoderCounts: 1024, encoderZero1: 0.018, encoderZero2: 0.018,
};

const GYMNASIUM = { dynamics: "book", ...valuesOf("params", "others") };
export const DEFAULTS = { ...GYMNASIUM, ...IDEAL };

/** A motor and a time step with which holding upright is easy to watch. */
export const BALANCE = { ...GYMNASIUM, dt: 0.02, torque: 5 };

const UNBOUNDED = { maxVelocity1: Infinity, maxVelocity2: Infinity };
/**
 * Machines by name, without instruments: that of dm_control, and RealAIGym's design C.1 without dry
 * friction.
 */
export const MACHINES = {
  "Gymnasium": GYMNASIUM,
  "Gymnasium, 5 N m": BALANCE,
  "dm_control": {
    ...GYMNASIUM, ...UNBOUNDED, dt: 0.01, torque: 2, gravity: 9.81, friction: 0.05,
    inertia1: 0.09557031, inertia2: 0.09530365,
  },
  "RealAIGym": {
    ...GYMNASIUM, ...UNBOUNDED, dt: 0.01, torque: 6, gravity: 9.81, length1: 0.2, length2: 0.3,
    mass1: 0.52346, mass2: 0.625568, centerOfMass1: 0.2, centerOfMass2: 0.255693,
    inertia1: 0.0109488, inertia2: 0.00997089,
  },
};

export const isSame = (params, others) =>
  Object.entries(others).every(([name, value]) => Object.is(params[name], value));

/** The seed in a text. Throws an `Error` with the reason if the text is not a seed. */
export function parseSeed(text) {
  const digits = text.trim();
  if (/^[0-9]{1,600}$/.test(digits)) return BigInt(digits);
  throw new Error(`seed must have from 1 to 600 decimal digits, got ${JSON.stringify(digits)}`);
}

/** A number as text, which has the sign of a zero. */
export const textOf = (number) => (Object.is(number, -0) ? "-0" : String(number));

/** The number in a text, or NaN if the text is not a number. */
export function parseNumber(text) {
  return text.trim() === "" ? NaN : Number(text);
}

/** The name of the machine with these parameters, or "". */
export const machineOf = (params) =>
  Object.keys(MACHINES).find((name) => isSame(params, MACHINES[name])) ?? "";

const REASONS = {
  torque: "The motor's largest torque is 0 N m, so it moves nothing. Set another one.",
  gravity: "Gravity is 0 m/s². Then the motor cannot stop the whole acrobot once it turns. " +
    "Set another gravity.",
};

/** Why nothing holds the acrobot with a parameter of 0, if one is. */
export const reasonOf = (params) =>
  REASONS[Object.keys(REASONS).find((name) => params[name] === 0)];
