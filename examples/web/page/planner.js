// The policy "Planner". A worker plans while the acrobot goes on, so a plan begins in a state that
// is predicted. All steps to come are predicted in a model: the picture shows where the tip will
// be, and a state that differs shows that somebody has pushed or that a parameter has changed.

import { energyLaw } from "./acrobot-rs/policies.js";
import { levelOf, newAcrobot, normal, torqueOf } from "./game.js";
import { placesOf } from "./push.js";

/** The part of the motor's torque for plans. The rest is for corrections. */
const PLANNED = 0.9;
/** How long a plan may take, s: at first, and at most, after plans that came late. */
const [LEAD, LONGEST] = [0.16, 5];
/** How long the regulator needs after a plan to show that it holds, s. */
const SETTLED = 2;
/** The largest deviations that are upright, rad and rad/s. */
const UPRIGHT = [0.1, 0.1, 0.5, 0.5];
/**
 * A state that differs by so much from the prediction, rad and rad/s, needs another one: with a
 * plan, and before.
 */
const [PLANNED_ERROR, ERROR] = [0.05, 0.3];
/** The parts of an angle's error that correct an estimated angle and, for each step, a velocity. */
const [ANGLE, VELOCITY] = [0.2, 0.02];
/** The most steps of a prediction, so that a tiny time step does not take minutes. */
const STEPS = 3000;

/** An angle's difference from another, from −π to π. */
const turn = (angle) => angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));

/** The deviation of a state from another, both as arrays. */
const deviation = (state, [theta1, theta2, dtheta1, dtheta2]) =>
  [turn(state[0] - theta1), turn(state[1] - theta2), state[2] - dtheta1, state[3] - dtheta2];

export const isUpright = (state) =>
  deviation(state, [Math.PI, 0, 0, 0]).every((x, i) => Math.abs(x) < UPRIGHT[i]);

const stateOf = (acrobot) => Object.values(acrobot.state);

const setState = (acrobot, [theta1, theta2, dtheta1, dtheta2]) =>
  (acrobot.state = { theta1, theta2, dtheta1, dtheta2 });

export class PlannerPolicy {
  thinks = false;
  /** About the last plan, as a sentence. */
  message = "";
  #error = null;
  /** The steps to come, { state, level, tip }. The model is after the last one. */
  #ahead = [];
  #model = newAcrobot();
  /** The acrobot as it was estimated, and the level since then. */
  #estimate = newAcrobot();
  #level = 0;
  #params = null;
  #plan = null;
  #gain;
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
    const isNew = params !== this.#params;
    if (isNew) this.#take(game);
    const state = this.#look(game);
    const expected = this.#ahead[0]?.state ?? [];
    const most = this.#plan === null ? ERROR : PLANNED_ERROR;
    const isExpected = deviation(state, expected).every((x) => Math.abs(x) < most);
    if (isNew || !isExpected || (this.#wasPulled && !isPulled)) this.#replan(state, isPulled);
    else if (!this.thinks) this.#predict(1);
    else if (this.#ahead.length === 1) {
      this.#lead = Math.min(2 * this.#lead, LONGEST);
      this.#think();
    }
    this.#wasPulled = isPulled;
    const step = this.#step - this.#ahead.length;
    const { level } = this.#ahead.shift();
    const isFollowed = this.#plan !== null;
    this.#level = isFollowed ? levelOf(this.#torque(state, step), params.torque) : level;
    return this.#level;
  }

  /** The game's state, or an estimate of it if the encoders are noisy. */
  #look({ numbers, params: { encoders, dt, torque } }) {
    if (encoders === 0) return numbers.slice(0, 4);
    this.#estimate.stepTorque(torqueOf(this.#level, torque));
    const predicted = stateOf(this.#estimate);
    const errors = [0, 1].map((i) => turn(numbers[i] + encoders * normal() - predicted[i]));
    const corrections = [ANGLE, ANGLE, VELOCITY / dt, VELOCITY / dt];
    setState(this.#estimate, predicted.map((x, i) => x + corrections[i] * errors[i % 2]));
    return stateOf(this.#estimate);
  }

  /** The tip's places to come, m. */
  get path() {
    return this.#plan === null ? [] : this.#ahead.map(({ tip }) => tip);
  }

  #check() {
    if (this.#error === null) return;
    const message = this.#error;
    Object.assign(this, { thinks: false, message: "" });
    this.#error = this.#params = null;
    throw new Error(message);
  }

  #take({ params, acrobot }) {
    this.#params = params;
    for (const model of [this.#model, this.#estimate]) model.setParams(acrobot.params);
    this.#estimate.state = acrobot.state;
    this.#plan = null;
  }

  /** Keeps the plan if it still ends upright. Otherwise asks for another one. */
  #replan(state, isPulled) {
    const done = Math.max(this.#step - this.#ahead.length, 0);
    this.thinks = false;
    this.#id++;
    this.#from(state, done);
    if (isPulled) return this.#predict(1);
    if (this.#plan !== null) {
      const left = Math.max(this.#plan.torques.length - done, 0);
      this.#predict(left + this.#stepsOf(SETTLED));
      if (isUpright(stateOf(this.#model))) return;
      this.#plan = null;
      this.#from(state, 0);
    }
    this.#lead = LEAD;
    this.#think();
  }

  #from(state, step) {
    setState(this.#model, state);
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

  #receive({ plan, gain, duration, error }) {
    if (error) this.#error = error;
    else if (plan === null) this.message = "No plan yet. It pumps energy and tries again.";
    else {
      const seconds = (plan.torques.length * this.#params.dt).toFixed(1);
      this.message = `Plan of ${seconds} s, found in ${Math.round(duration)} ms.`;
      this.thinks = false;
      [this.#plan, this.#gain, this.#step] = [plan, gain, 0];
      this.#predict(plan.torques.length);
    }
  }

  /** Takes steps of the model. */
  #predict(count) {
    const { length } = this.#ahead;
    while (this.#ahead.length < length + count) {
      const state = stateOf(this.#model);
      const { torque } = this.#params;
      const level = levelOf(this.#torque(state, this.#step), torque);
      this.#model.stepTorque(torqueOf(level, torque));
      this.#ahead.push({ state, level, tip: placesOf(this.#model.state, this.#params)[1] });
      this.#step++;
    }
  }

  /** The torque at a state: of the plan, then of the regulator, and without both of energy. */
  #torque(state, step) {
    if (this.#plan === null) return (energyLaw(this.#model) - 1) * this.#params.torque;
    const { torques, states, gains } = this.#plan;
    const at = 4 * step;
    const isPlanned = step < torques.length;
    const target = isPlanned ? states.subarray(at, at + 4) : [Math.PI, 0, 0, 0];
    const gain = isPlanned ? gains.subarray(at, at + 4) : this.#gain;
    const torque = isPlanned ? torques[step] : 0;
    return deviation(state, target).reduce((sum, x, i) => sum - gain[i] * x, torque);
  }
}
