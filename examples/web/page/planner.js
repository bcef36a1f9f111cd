// The policy "Planner", and pulls: what needs the package's module for control. A worker plans
// while the acrobot goes on, so a plan begins in a state that is predicted. All steps to come are
// predicted in a model: the picture shows where the tip will be, and a state that differs shows
// that somebody has pushed or that a parameter has changed.

import { deviationFrom, planTorque } from "./acrobot-rs/control.js";
import { energyLaw } from "./acrobot-rs/policies.js";
import { isUpright, levelOf, newAcrobot, torqueOf } from "./game.js";
import { placesOf } from "./places.js";
import { reasonOf } from "./settings.js";

export { Instruments } from "./instruments.js";
export { pull } from "./push.js";

/** The part of the motor's torque for plans. The rest is for corrections. */
const PLANNED = 0.9;
/** How long a plan may take, s: at first, and at most, after plans that came late. */
const [LEAD, LONGEST] = [0.16, 5];
/** How long what holds after a plan needs to show it, s. */
const SETTLED = 2;
/**
 * A state that differs by so much from the prediction, rad and rad/s, needs another one: with a
 * plan, and before.
 */
const [PLANNED_ERROR, ERROR] = [0.05, 0.3];
/** The most steps of a prediction, so that a tiny time step does not take minutes. */
const STEPS = 3000;

export class PlannerPolicy {
  thinks = false;
  /** About the last plan, as a sentence. */
  message = "";
  #error = null;
  /** The steps to come, { state, step, level, tip }. The model is after the last one. */
  #ahead = [];
  #model = newAcrobot();
  #params = null;
  #plan = null;
  /** The step of the plan in the model's state. */
  #step = 0;
  #lead = LEAD;
  #worker = null;
  #id = 0;
  #wasPulled = false;

  /** The motor's level for a game's state. While somebody pulls, it does not plan. */
  act(game, isPulled) {
    this.#check();
    const { params } = game;
    if (params !== this.#params) this.#take(game);
    const state = game.seen;
    const most = this.#plan === null ? ERROR : PLANNED_ERROR;
    const [next] = this.#ahead;
    const errors = next && Object.values(deviationFrom(state, next.state));
    const isExpected = errors?.every((error) => Math.abs(error) < most);
    if (!isExpected || (this.#wasPulled && !isPulled)) this.#replan(state, isPulled);
    else if (!this.thinks) this.#predict(1);
    else if (this.#ahead.length === 1) {
      this.#lead = Math.min(2 * this.#lead, LONGEST);
      this.#think();
    }
    this.#wasPulled = isPulled;
    const { step, level } = this.#ahead.shift();
    const isFollowed = this.#plan !== null;
    return isFollowed ? levelOf(this.#torque(state, step), params.torque) : level;
  }

  /** The tip's places to come, m. */
  get path() {
    return this.#plan === null ? [] : this.#ahead.map(({ tip }) => tip);
  }

  #check() {
    if (this.#error === null) return;
    const message = (this.#params && reasonOf(this.#params)) ?? this.#error;
    Object.assign(this, { thinks: false, message: "" });
    this.#error = this.#params = null;
    throw new Error(message);
  }

  #take({ params, acrobot }) {
    this.#model.setParams(acrobot.params);
    [this.#params, this.#plan, this.#ahead] = [params, null, []];
  }

  /** Keeps the plan if it still ends upright. Otherwise asks for another one. */
  #replan(state, isPulled) {
    const done = this.#ahead[0]?.step ?? this.#step;
    this.thinks = false;
    this.#id++;
    this.#from(state, done);
    if (isPulled) return this.#predict(1);
    if (this.#plan !== null) {
      const left = Math.max(this.#plan.torques.length - done, 0);
      this.#predict(left + this.#stepsOf(SETTLED));
      if (isUpright(this.#model.state)) return;
      this.#plan = null;
      this.#from(state, 0);
    }
    this.#lead = LEAD;
    this.#think();
  }

  #from(state, step) {
    this.#model.state = state;
    [this.#ahead, this.#step] = [[], step];
  }

  #stepsOf(seconds) {
    return Math.min(Math.ceil(seconds / this.#params.dt), STEPS);
  }

  /** Asks for a plan that begins when the time to plan is over. */
  #think() {
    this.thinks = true;
    this.#predict(this.#stepsOf(this.#lead));
    const { params, state } = this.#model;
    const id = ++this.#id;
    const limit = PLANNED * this.#params.torque;
    this.#started().postMessage({ id, params, limit, start: state, seed: id });
  }

  #started() {
    if (this.#worker !== null) return this.#worker;
    this.#worker = new Worker(new URL("planning.js", import.meta.url), { type: "module" });
    this.#worker.onerror = ({ message }) => (this.#error = `the planner failed: ${message}`);
    this.#worker.onmessage = ({ data }) => data.id === this.#id && this.#receive(data);
    return this.#worker;
  }

  #receive({ plan, duration, error }) {
    if (error) this.#error = error;
    else if (plan === null) this.message = "No plan yet. It pumps energy and tries again.";
    else {
      const seconds = (plan.torques.length * this.#params.dt).toFixed(1);
      this.message = `Plan of ${seconds} s, found in ${Math.round(duration)} ms.`;
      this.thinks = false;
      [this.#plan, this.#step] = [plan, 0];
      this.#predict(plan.torques.length);
    }
  }

  /** Takes steps of the model. */
  #predict(count) {
    const { torque } = this.#params;
    for (let i = 0; i < count; i++) {
      const [{ state }, step] = [this.#model, this.#step++];
      const level = levelOf(this.#torque(state, step), torque);
      this.#model.stepTorque(torqueOf(level, torque));
      const [, tip] = placesOf(this.#model.state, this.#params);
      this.#ahead.push({ state, step, level, tip });
    }
  }

  /** The torque at a state: that of the plan, or without one that of energy in the model. */
  #torque(state, step) {
    if (this.#plan === null) return (energyLaw(this.#model) - 1) * this.#params.torque;
    return planTorque(this.#plan, step, state);
  }
}
