// One episode: its start, parameters, inputs and states.

import { Acrobot } from "./acrobot-rs/index.js";
import { IDEAL, LIMIT } from "./settings.js";

/** The largest level of the motor, which has 12 bits, so that a link is short. */
export const FULL = 2047;
/** A number of the normal distribution with a standard deviation of 1. */
export const normal = () =>
  Math.sqrt(-2 * Math.log(1 - Math.random())) * Math.cos(2 * Math.PI * Math.random());

/** An acrobot with friction. Without it, steps have the bits of Gymnasium's task. */
export const newAcrobot = () => new Acrobot({ task: "balance" });
/** This reward is at Gymnasium's line. */
const GOAL = 0.75;

/** The units of a push in a rad/s. */
export const UNITS = 4096;
/** How long states are kept, s, and how many at most. */
const [MEMORY, MOST] = [60, 6000];
/** In shorter steps, s, a display shows no state between two of them. */
const FRAME = 0.025;

const wholeUpTo = (most) => (x) => Number.isInteger(x) && x >= 0 && x <= most;
/** What the package does not check: names, which values are valid, and the rule in words. */
const RULES = [
  ["torque motorLag noise angleNoise", (x) => x >= 0 && x < Infinity, "finite and at least 0"],
  ["actionDelay", wholeUpTo(8), "a whole number of steps from 0 to 8"],
  ["encoderCounts", wholeUpTo(2 ** 22), "a whole number a turn from 0 to 4194304"],
  ["encoderZero1 encoderZero2", (x) => Math.abs(x) <= Math.PI, "within ±π rad"],
  ["estimate", wholeUpTo(1), "0 or 1"],
];

/** Whether a state is upright: within 0.1 rad and 0.5 rad/s. */
export const isUpright = ({ theta1, theta2, ...velocities }) =>
  Math.min(-Math.cos(theta1), Math.cos(theta2)) > Math.cos(0.1) &&
  Object.values(velocities).every((velocity) => Math.abs(velocity) < 0.5);

/** The motor's torque at a level from −FULL to FULL, N m. */
export const torqueOf = (level, limit) => (level / FULL) * limit;

/** The level that is closest to a torque. A motor of 0 N m has only 0. */
export function levelOf(torque, limit) {
  const level = Math.round((FULL * torque) / limit);
  return Math.max(-FULL, Math.min(FULL, level)) || 0;
}

export class Game {
  #gymnasium = new Acrobot();
  acrobot = newAcrobot();
  #shown = newAcrobot();
  seed;
  params;
  /** The state in which the inputs begin, or null for the seed's initial state. */
  start = null;
  /** The last inputs: the level of each step, and its change of both velocities, or null. */
  levels = [];
  pushes = [];
  /** What makes `seen` of the state; null until it has been loaded. */
  instruments = null;
  /** Whether the game goes on at the goal and at the limit of steps. */
  free = false;
  /**
   * The last states: `numbers` are the state, its energy, the tip's height, and the torque that
   * led to it. `upright` is how long it has been upright, s.
   */
  #rows = [];
  /** The step of the first row, and the row that is shown and from which the next step goes on. */
  #first = 0;
  #at = 0;
  #end = null;

  constructor(seed, params) {
    this.begin(seed, params);
  }

  /** Begins an episode, or throws if the package rejects the parameters. */
  begin(seed, params = this.params, start = null) {
    this.#set(params);
    this.#gymnasium.reset(seed);
    this.acrobot.reset(seed);
    this.acrobot.state = start ?? this.#gymnasium.state;
    Object.assign(this, { seed, start, levels: [], pushes: [] });
    [this.#rows, this.#first, this.#at, this.#end] = [[], 0, 0, null];
    this.#rows.push(this.#row(0, null, { sent: 0, drive: 0 }));
  }

  /** Changes the parameters for the next steps. The inputs then begin with the next step. */
  change(params) {
    this.cut();
    this.#set(params);
    Object.assign(this, { start: this.acrobot.state, levels: [], pushes: [] });
  }

  #set(params) {
    for (const [names, isValid, rule] of RULES) {
      for (const name of names.split(" ")) {
        if (!isValid(params[name])) throw new Error(`${name} must be ${rule}, got ${params[name]}`);
      }
    }
    const { torque, friction, ...others } = params;
    for (const name of Object.keys(IDEAL)) delete others[name];
    const torques = [-torque, 0, torque];
    this.acrobot.setParams({ ...others, torques, damping1: friction, damping2: friction });
    this.params = params;
  }

  /**
   * The motor's torques in the next steps, N m, without noise: after the levels on their way, and
   * those that follow.
   */
  drivesOf(next) {
    const { torque, dt, motorLag, actionDelay } = this.params;
    const first = this.#at + 1 - actionDelay;
    const late = Array.from({ length: actionDelay }, (_, i) => this.#rows[first + i]?.sent ?? 0);
    let { drive } = this.motor;
    return [...late, ...next].map((level) => {
      drive += (dt / (dt + motorLag)) * (torqueOf(level, torque) - drive);
      return drive;
    });
  }

  /** Steps with a level that is sent to the motor, which acts late, slowly and with noise. */
  send(sent, push = null) {
    const { torque, noise, motorLag, actionDelay } = this.params;
    this.cut();
    const [drive] = this.drivesOf([sent]);
    const level = motorLag + actionDelay === 0 ? sent : levelOf(drive, torque);
    const noisy = () => levelOf(torqueOf(level, torque) + noise * normal(), torque);
    this.step(noise === 0 ? level : noisy(), push, { sent, drive });
  }

  /** Steps with a level that acts, and a push in its units or null. */
  step(level, push = null, motor = null) {
    if (this.end !== null) return;
    this.cut();
    const torque = torqueOf(level, this.params.torque);
    const { reward } = apply(this.acrobot, torque, push);
    this.levels.push(level);
    this.pushes.push(push);
    this.#rows.push(this.#row(torque, push, motor ?? { sent: level, drive: torque }));
    this.#at++;
    this.#forget();
    this.instruments?.look(this);
    if (this.free) return;
    if (reward > GOAL) this.#end = "goal";
    else if (this.steps === LIMIT) this.#end = "limit";
  }

  /** Shows the state after another of the last steps. The next step goes on from there. */
  seek(step) {
    this.#at = Math.max(0, Math.min(step - this.#first, this.#rows.length - 1));
    const { numbers, params } = this.#rows[this.#at];
    if (params !== this.params) this.#set(params);
    this.acrobot.state = stateOf(numbers);
  }

  /** Forgets the steps after the one that is shown. */
  cut() {
    const cut = this.#rows.length - 1 - this.#at;
    if (cut === 0) return;
    this.#rows.length = this.#at + 1;
    this.#end = null;
    const left = this.levels.length - cut;
    if (left < 0) this.start = this.acrobot.state;
    // New arrays, because it is another run.
    for (const name of ["levels", "pushes"]) this[name] = this[name].slice(0, Math.max(left, 0));
  }

  /** Goes on without an end. */
  release() {
    [this.free, this.#end] = [true, null];
  }

  #forget() {
    const kept = Math.max(LIMIT, Math.min(Math.ceil(MEMORY / this.params.dt), MOST));
    if (this.#rows.length > kept + 1) {
      this.#rows.shift();
      this.#first++;
      this.#at--;
    }
    if (this.levels.length <= LIMIT) return;
    this.levels.shift();
    this.pushes.shift();
    this.start = stateOf(this.#rows.at(-1 - LIMIT).numbers);
  }

  #row(torque, push, motor) {
    const { state, energy, tipHeight } = this.acrobot;
    const numbers = Float32Array.of(...Object.values(state), energy, tipHeight, torque);
    const before = this.#rows[this.#at]?.upright ?? 0;
    const upright = isUpright(state) ? before + this.params.dt : 0;
    return { numbers, push, upright, params: this.params, ...motor };
  }

  get steps() {
    return this.#first + this.#at;
  }

  /** The first and the last step that it remembers. */
  get span() {
    return [this.#first, this.#first + this.#rows.length - 1];
  }

  /** The rows to plot, with the step of the first one: the last ones, or those from `steps` on. */
  get window() {
    const from = Math.max(0, Math.min(this.#at, this.#rows.length - 1 - LIMIT));
    return [this.#first + from, this.#rows.slice(from, from + LIMIT + 1)];
  }

  get rows() {
    return this.#rows;
  }

  /** `"goal"` or `"limit"` once the episode has ended. */
  get end() {
    return this.#at === this.#rows.length - 1 ? this.#end : null;
  }

  /** The motor's last level that was sent, and its last torque without noise, N m. */
  get motor() {
    return this.#rows[this.#at];
  }

  /** The state that a policy sees. */
  get seen() {
    return this.instruments?.look(this) ?? this.acrobot.state;
  }

  /** How long it has been upright, s. */
  get upright() {
    return this.#rows[this.#at].upright;
  }

  /** −1 for each step except the one that reaches the goal. */
  get return() {
    return (this.end === "goal" ? 1 : 0) - this.steps;
  }

  /** The four numbers of the state, the energy, the height of the tip, and the last torque. */
  get numbers() {
    return this.#rows[this.#at].numbers;
  }

  /**
   * The acrobot at a part of its last step, from 0 to 1, because a display shows more frames than
   * the physics takes steps.
   */
  between(part) {
    const before = this.#rows[this.#at - 1]?.numbers;
    const dt = Math.fround(part * this.params.dt);
    const isShort = this.params.dt < FRAME;
    if (part === 1 || dt === 0 || isShort || before === undefined) return this.acrobot;
    this.#shown.setParams({ ...this.acrobot.params, dt });
    this.#shown.state = stateOf(before);
    apply(this.#shown, this.numbers[6], this.#rows[this.#at].push);
    return this.#shown;
  }
}

const stateOf = ([theta1, theta2, dtheta1, dtheta2]) => ({ theta1, theta2, dtheta1, dtheta2 });

/** Steps an acrobot with a torque. A push changes the velocities before the step. */
function apply(acrobot, torque, push) {
  if (push !== null) {
    const { theta1, theta2, dtheta1, dtheta2 } = acrobot.state;
    const [more1, more2] = push.map((units) => units / UNITS);
    acrobot.state = { theta1, theta2, dtheta1: dtheta1 + more1, dtheta2: dtheta2 + more2 };
  }
  return acrobot.stepTorque(torque);
}
