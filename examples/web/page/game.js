// One episode: its seed, parameters, actions and states.

import { LIMIT } from "./module.js";

export class Game {
  #acrobot;
  seed;
  params;
  actions = [];
  /** Six numbers of each state: the initial one, and after each step. */
  #rows = [];
  /** `"goal"` or `"limit"` once the episode has ended. */
  end = null;

  constructor(acrobot, seed, params) {
    this.#acrobot = acrobot;
    this.begin(seed, params);
  }

  /** Begins an episode. Throws if the crate rejects the parameters. Then the current episode continues. */
  begin(seed, params = this.params) {
    this.#acrobot.setParams(params);
    this.#acrobot.reset(seed);
    Object.assign(this, { seed, params, actions: [], end: null });
    this.#rows = [this.#acrobot.numbers()];
  }

  step(action) {
    if (this.end !== null) return;
    const { terminated, truncated } = this.#acrobot.step(action);
    this.actions.push(action);
    this.#rows.push(this.#acrobot.numbers());
    if (terminated) this.end = "goal";
    else if (truncated) this.end = "limit";
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

  /** One of the six numbers, of the initial state and after each step. */
  column(index) {
    return Array.from(this.#rows, (row) => row[index]);
  }

  /** The transitions, with the columns of the crate's CSV. */
  csv() {
    const state = ["theta1 (rad)", "theta2 (rad)", "dtheta1 (rad/s)", "dtheta2 (rad/s)"];
    const next = state.map((name) => `next ${name}`);
    const names = ["step", ...state, "torque (N m)", "reward", ...next, "terminated", "truncated"];
    const lines = this.actions.map((action, i) => {
      const last = i + 1 === this.steps;
      const terminated = last && this.end === "goal";
      const states = [this.#rows[i], this.#rows[i + 1]].map((row) => Array.from(row.subarray(0, 4), shortest));
      const truncated = i + 1 === LIMIT;
      return [i + 1, ...states[0], action - 1, terminated ? 0 : -1, ...states[1], Number(terminated), Number(truncated)];
    });
    return [names, ...lines].map((cells) => `${cells.join(",")}\n`).join("");
  }
}

/** The shortest decimal that rounds to the same number in single precision. */
export function shortest(number) {
  for (let digits = 1; ; digits++) {
    const text = String(Number(number.toPrecision(digits)));
    if (digits === 17 || Math.fround(Number(text)) === number) return text;
  }
}
