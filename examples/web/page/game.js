// One episode: its seed, parameters, actions and states.

import { Acrobot } from "./acrobot-rs/index.js";

export class Game {
  acrobot = new Acrobot();
  seed;
  params;
  actions = [];
  /** Six numbers of each state: the initial one, and after each step. */
  #rows = [];
  /** `"goal"` or `"limit"` once the episode has ended. */
  end = null;

  constructor(seed, params) {
    this.begin(seed, params);
  }

  /** Begins an episode, or throws if the package rejects the parameters. */
  begin(seed, params = this.params) {
    this.acrobot.setParams(params);
    this.acrobot.reset(seed);
    Object.assign(this, { seed, params, actions: [], end: null });
    this.#rows = [this.#row()];
  }

  step(action) {
    if (this.end !== null) return;
    const { terminated, truncated } = this.acrobot.step(action);
    this.actions.push(action);
    this.#rows.push(this.#row());
    if (terminated) this.end = "goal";
    else if (truncated) this.end = "limit";
  }

  #row() {
    const { state, energy, tipHeight } = this.acrobot;
    return Float32Array.of(...Object.values(state), energy, tipHeight);
  }

  get steps() {
    return this.actions.length;
  }

  /** −1 for each step except the one that reaches the goal. */
  get return() {
    return (this.end === "goal" ? 1 : 0) - this.steps;
  }

  /** The four numbers of the state, the energy and the height of the tip. */
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
    const angle = (i) =>
      angleBetween(before[i], after[i], before[i + 2] * dt, after[i + 2] * dt, part);
    return { theta1: angle(0), theta2: angle(1) };
  }

  /** One of the six numbers, of the initial state and after each step. */
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
