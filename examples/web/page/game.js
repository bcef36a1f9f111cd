// One episode: its start, parameters, inputs and states.

import { Acrobot } from "./acrobot-rs/index.js";
import { LIMIT } from "./settings.js";

/** The largest level of the motor, which has 12 bits, so that a link is short. */
export const FULL = 2047;
/** A number of the normal distribution with a standard deviation of 1. */
export const normal = () =>
  Math.sqrt(-2 * Math.log(1 - Math.random())) * Math.cos(2 * Math.PI * Math.random());

/** The level that a noisy motor makes of another. */
export const noisy = (level, { noise, torque }) =>
  noise === 0 ? level : levelOf(torqueOf(level, torque) + noise * normal(), torque);

/** An acrobot with friction. Without it, steps have the bits of Gymnasium's task. */
export const newAcrobot = () => new Acrobot({ task: "balance" });
/** This reward is at Gymnasium's line. */
const GOAL = 0.75;

/** The units of a push in a rad/s. */
export const UNITS = 4096;
/** In shorter steps, s, a display shows no state between two of them. */
const FRAME = 0.025;

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
  steps = 0;
  /** Whether the game goes on at the goal and at the limit of steps. */
  free = false;
  /** The last states, each with its energy, the tip's height, and the torque that led to it. */
  #rows = [];
  /** `"goal"` or `"limit"` once the episode has ended. */
  end = null;

  constructor(seed, params) {
    this.begin(seed, params);
  }

  /** Begins an episode, or throws if the package rejects the parameters. */
  begin(seed, params = this.params, start = null) {
    this.#set(params);
    this.#gymnasium.reset(seed);
    this.acrobot.reset(seed);
    this.acrobot.state = start ?? this.#gymnasium.state;
    Object.assign(this, { seed, start, levels: [], pushes: [], steps: 0, end: null });
    this.#rows = [this.#row(0)];
  }

  /** Changes the parameters for the next steps. The inputs then begin with the next step. */
  change(params) {
    this.#set(params);
    Object.assign(this, { start: this.acrobot.state, levels: [], pushes: [] });
  }

  #set(params) {
    const { torque, friction, noise, encoders, ...others } = params;
    for (const [name, value] of Object.entries({ torque, noise, encoders })) {
      if (!(value >= 0 && value < Infinity)) {
        throw new Error(`${name} must be finite and at least 0, got ${value}`);
      }
    }
    const torques = [-torque, 0, torque];
    this.acrobot.setParams({ ...others, torques, damping1: friction, damping2: friction });
    this.params = params;
  }

  /** Steps with a level of the motor, and a push in its units or null. */
  step(level, push = null) {
    if (this.end !== null) return;
    const torque = torqueOf(level, this.params.torque);
    const { reward } = apply(this.acrobot, torque, push);
    this.levels.push(level);
    this.pushes.push(push);
    this.#rows.push(this.#row(torque));
    this.steps++;
    this.#forget();
    if (this.free) return;
    if (reward > GOAL) this.end = "goal";
    else if (this.steps === LIMIT) this.end = "limit";
  }

  /** Goes on without an end. */
  release() {
    Object.assign(this, { free: true, end: null });
  }

  #forget() {
    if (this.#rows.length > LIMIT + 1) this.#rows.shift();
    if (this.levels.length <= LIMIT) return;
    this.levels.shift();
    this.pushes.shift();
    const [theta1, theta2, dtheta1, dtheta2] = this.#rows[0];
    this.start = { theta1, theta2, dtheta1, dtheta2 };
  }

  #row(torque) {
    const { state, energy, tipHeight } = this.acrobot;
    return Float32Array.of(...Object.values(state), energy, tipHeight, torque);
  }

  /** The step of the first of the last states. */
  get first() {
    return this.steps - this.#rows.length + 1;
  }

  /** −1 for each step except the one that reaches the goal. */
  get return() {
    return (this.end === "goal" ? 1 : 0) - this.steps;
  }

  /** The four numbers of the state, the energy, the height of the tip, and the last torque. */
  get numbers() {
    return this.#rows.at(-1);
  }

  /**
   * The acrobot at a part of its last step, from 0 to 1, because a display shows more frames than
   * the physics takes steps.
   */
  between(part) {
    const before = this.#rows.at(-2);
    const dt = Math.fround(part * this.params.dt);
    const isShort = this.params.dt < FRAME;
    if (part === 1 || dt === 0 || isShort || before === undefined) return this.acrobot;
    const [theta1, theta2, dtheta1, dtheta2] = before;
    this.#shown.setParams({ ...this.acrobot.params, dt });
    this.#shown.state = { theta1, theta2, dtheta1, dtheta2 };
    apply(this.#shown, this.numbers[6], this.pushes.at(-1) ?? null);
    return this.#shown;
  }

  column(index) {
    return Array.from(this.#rows, (row) => row[index]);
  }
}

/** Steps an acrobot with a torque. A push changes the velocities before the step. */
function apply(acrobot, torque, push) {
  if (push !== null) {
    const { theta1, theta2, dtheta1, dtheta2 } = acrobot.state;
    const [more1, more2] = push.map((units) => units / UNITS);
    acrobot.state = { theta1, theta2, dtheta1: dtheta1 + more1, dtheta2: dtheta2 + more2 };
  }
  return acrobot.stepTorque(torque);
}
