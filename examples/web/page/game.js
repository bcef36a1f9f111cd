// One episode: its start, parameters, inputs and states.

import { Acrobot } from "./acrobot-rs/index.js";
import { LIMIT } from "./settings.js";

/** The largest level of the motor, which has 12 bits, so that a link is short. */
export const FULL = 2047;
/** The units of a push in a rad/s. */
export const UNITS = 4096;

/** The motor's torque at a level from −FULL to FULL, N m. */
export const torqueOf = (level, limit) => (level / FULL) * limit;

/** The level that is closest to a torque. A motor of 0 N m has only 0. */
export function levelOf(torque, limit) {
  const level = Math.round((FULL * torque) / limit);
  return Math.max(-FULL, Math.min(FULL, level)) || 0;
}

export class Game {
  acrobot = new Acrobot();
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
    this.acrobot.reset(seed);
    if (start !== null) this.acrobot.state = start;
    Object.assign(this, { seed, start, levels: [], pushes: [], steps: 0, end: null });
    this.#rows = [this.#row(0)];
  }

  /** Changes the parameters for the next steps. The inputs then begin with the next step. */
  change(params) {
    this.#set(params);
    Object.assign(this, { start: this.acrobot.state, levels: [], pushes: [] });
  }

  #set(params) {
    const { torque, ...others } = params;
    if (!(torque >= 0)) throw new Error(`torque must be at least 0 N m, got ${torque}`);
    this.acrobot.setParams({ ...others, torques: [-torque, 0, torque] });
    this.params = params;
  }

  /** Steps with a level of the motor. A push changes the velocities before the step. */
  step(level, push = null) {
    if (this.end !== null) return;
    const { acrobot } = this;
    if (push !== null) {
      const { theta1, theta2, dtheta1, dtheta2 } = acrobot.state;
      const [more1, more2] = push.map((units) => units / UNITS);
      acrobot.state = { theta1, theta2, dtheta1: dtheta1 + more1, dtheta2: dtheta2 + more2 };
    }
    const torque = torqueOf(level, this.params.torque);
    const { terminated, truncated } = acrobot.stepTorque(torque);
    this.levels.push(level);
    this.pushes.push(push);
    this.#rows.push(this.#row(torque));
    this.steps++;
    this.#forget();
    if (this.free) return;
    if (terminated) this.end = "goal";
    else if (truncated) this.end = "limit";
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
   * Draws the acrobot at a part of its last step, from 0 to 1, because a display shows more frames
   * than the physics takes steps.
   */
  draw(context, part, colors) {
    const { state } = this.acrobot;
    const { theta1, theta2 } = this.between(part);
    this.acrobot.state = { ...state, theta1, theta2 };
    this.acrobot.draw(context, { colors });
    this.acrobot.state = state;
  }

  /** The angles at a part of the last step. */
  between(part) {
    const after = this.numbers;
    const before = this.#rows.at(-2) ?? after;
    const { dt } = this.params;
    const push = this.pushes.at(-1) ?? [0, 0];
    const angle = (i) => {
      const velocity = before[i + 2] + push[i] / UNITS;
      return angleBetween(before[i], after[i], velocity * dt, after[i + 2] * dt, part);
    };
    return { theta1: angle(0), theta2: angle(1) };
  }

  /** One of these numbers, of each of the last states. */
  column(index) {
    return Array.from(this.#rows, (row) => row[index]);
  }
}

/**
 * Interpolates between the angles `a` and `b` by a cubic Hermite polynomial, with the velocities at
 * the start and at the end of a step in radians a step.
 */
function angleBetween(a, b, start, end, part) {
  const mean = (start + end) / 2;
  // Angles are modulo 2π: take the turns closest to those at the mean velocity.
  const turned = b - a + 2 * Math.PI * Math.round((mean - (b - a)) / (2 * Math.PI));
  const [part2, part3] = [part ** 2, part ** 3];
  const bend = start * (part3 - 2 * part2 + part) + end * (part3 - part2);
  const angle = a + turned * (3 * part2 - 2 * part3) + bend;
  // With a huge dt there are too many turns to show.
  return Math.abs(angle) < 1e6 ? angle : b;
}
