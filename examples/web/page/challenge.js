// Scores to beat: of the game, and of "Growing pulls", which pulls the tip to alternating sides,
// each time harder, until it falls.

import { actionsOf } from "./link.js";
import { DEFAULTS, isSame } from "./settings.js";

/** From one pull to the next, how long one takes, and how long it stands before the first, s. */
const [PERIOD, DURATION, STANDING] = [3, 0.2, 1];
/** How much farther each pull goes than the one before, as a part of both lengths. */
const GROWTH = 0.005;

class Pulls {
  /** How long it has held, s, and the number of pulls. */
  held = 0;
  count = 0;
  #begins = true;

  grip({ upright, params: { length1, length2 } }) {
    if (this.#begins && upright < STANDING) return null;
    this.#begins = false;
    if (this.held % PERIOD >= DURATION) return null;
    this.count = Math.floor(this.held / PERIOD) + 1;
    const side = this.count % 2 === 0 ? -1 : 1;
    const offset = [side * GROWTH * this.count * (length1 + length2), 0];
    return { point: { link: 1, part: 1 }, offset };
  }

  /** Counts a step. Returns whether the tip has fallen below the line. */
  hasFallen({ acrobot: { tipHeight }, params: { dt, length1, length2 } }) {
    if (this.#begins) return false;
    this.held += dt;
    return tipHeight < (length1 + length2) / 2;
  }
}

export class Scores {
  /** What is to beat, of a link or of growing pulls before: `return`, and `held`, s. */
  best = {};
  /** The scores of this run. */
  #own = {};
  pulls = null;
  /** What growing pulls pull in the next step, or null. */
  grip = null;

  begin() {
    [this.pulls, this.grip, this.#own] = [null, null, {}];
  }

  /** Another machine has other scores. */
  change() {
    this.begin();
    delete this.best.held;
  }

  pull() {
    this.pulls = new Pulls();
  }

  aim(game) {
    this.grip = this.pulls?.grip(game) ?? null;
  }

  /** Counts a step. Returns what to say once the acrobot has fallen, or null. */
  step(game) {
    const isWhole = actionsOf(game) !== null && isSame(game.params, DEFAULTS);
    if (game.end === "goal" && isWhole) this.#own = { return: game.return };
    if (!this.pulls?.hasFallen(game)) return null;
    const { held, count } = this.pulls;
    const isRecord = held > (this.best.held ?? 0);
    this.#own = { held: Number(held.toFixed(2)) };
    if (isRecord) this.best = { ...this.best, ...this.#own };
    this.pulls = this.grip = null;
    return `It held for ${held.toFixed(1)} s and fell at pull ${count}.` +
      (isRecord ? " That is the score to beat." : "");
  }

  /** For a link. */
  get all() {
    return { ...this.best, ...this.#own };
  }
}
