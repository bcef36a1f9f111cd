// Control of a machine: its state and its parameters, from its angles, and its controller.

import {
  Kept, call, checkNumber, elements, empty, fields, hold, pack, paramsOf, readAll, readChanges,
  unpack,
} from "./kept.js";
import { SIZES, STRUCTS } from "./layout.js";
import { checked, invalid, positive } from "./wasm.js";

const {
  acrobot_calibration_t: CALIBRATION, acrobot_fit_t: FIT, acrobot_noise_t: NOISE,
  acrobot_params_t: PARAMS, acrobot_parameter_std_t: STD, acrobot_report_t: REPORT,
  acrobot_settings_t: SETTINGS, acrobot_state_t: STATE,
} = STRUCTS;

/** The words of Gymnasium's parameters with changes. */
export const machine = (changes) => pack(paramsOf("acrobot_task_params", 0), changes, PARAMS);

/** What an `_init` function makes. */
export class Made extends Kept {
  constructor(size, given, name, ...args) {
    super();
    hold(this, size, () => call(given, name, this, ...args));
  }
}

/** The state that a function writes. */
function stateOf(name, kept) {
  const words = empty(STATE);
  call({}, name, kept, words);
  return unpack(words, STATE);
}

/** What both estimators do. */
class Filter extends Made {
  static kind = "estimator";
  #prefix;

  constructor(size, prefix, params, std, noise) {
    const [changes, [own, words]] = [readChanges(params), readAll("noise", noise, NOISE)];
    const deviations = std ? [pack(empty(STD), std, STD)] : [];
    const given = { ...changes, ...std, ...own };
    super(size, given, `${prefix}_init`, machine(changes), ...deviations, words);
    this.#prefix = prefix;
  }

  correct(theta1, theta2) {
    const given = { theta1, theta2 };
    for (const [name, angle] of Object.entries(given)) checkNumber(name, angle);
    call(given, `${this.#prefix}_correct`, this, theta1, theta2);
  }

  predict(torque) {
    checkNumber("torque", torque);
    call({ torque }, `${this.#prefix}_predict`, this, torque);
  }

  get state() {
    return stateOf(`${this.#prefix}_state`, this);
  }

  get stateStd() {
    return stateOf(`${this.#prefix}_state_std`, this);
  }
}

export class Estimator extends Filter {
  constructor(params, noise) {
    super(SIZES.estimator, "acrobot_estimator", params, undefined, noise);
  }
}

export class ParameterEstimator extends Filter {
  constructor(params, std, noise) {
    const given = fields("std", std, STD);
    super(SIZES.parameterEstimator, "acrobot_parameter_estimator", params, given, noise);
  }

  get params() {
    return unpack(paramsOf("acrobot_parameter_estimator_params", this), PARAMS);
  }

  #errors() {
    const errors = new Float32Array(3);
    call({}, "acrobot_parameter_estimator_errors", this, errors);
    return Array.from(errors);
  }

  get zeros() {
    return this.#errors().slice(0, 2);
  }

  get torqueFactor() {
    return this.#errors()[2];
  }
}

/** A copy of a recording, and its samples. */
function readRecording(recording) {
  const { angles, torques } = checked("recording", recording, ["angles", "torques"]);
  const given = { torques: elements("recording.torques", torques) };
  const count = given.torques.length;
  given.angles = elements("recording.angles", angles, 2 * count);
  const samples = given.torques.flatMap((torque, i) => [
    given.angles[2 * i], given.angles[2 * i + 1], 0, torque,
  ]);
  return [given, Float64Array.from(samples), count];
}

/** What words of a fit contain. Its arrays have doubles. */
function fitOf({ buffer }) {
  const { rankDeficiency: [last], ...arrays } = FIT;
  const entries = Object.entries(arrays).map(([name, [at, count]]) => [
    name, new Float64Array(buffer, 4 * at, count / 2),
  ]);
  return { ...Object.fromEntries(entries), rankDeficiency: new Uint32Array(buffer)[last] };
}

export class Regression extends Made {
  static kind = "regression";

  constructor() {
    super(SIZES.regression, {}, "acrobot_regression_init");
  }

  add(recording, dt, gravity, half, window) {
    const [given, samples, count] = readRecording(recording);
    checkNumber("dt", dt);
    checkNumber("gravity", gravity);
    positive("half", half);
    positive("window", window);
    const numbers = [samples, count, dt, gravity, half, window];
    call({ ...given, dt, gravity }, "acrobot_regression_add", this, ...numbers);
  }

  fit() {
    const words = empty(FIT);
    call({}, "acrobot_regression_fit", this, words);
    return fitOf(words);
  }
}

export function fitParams(fit, params) {
  const [changes, own, words] = [readChanges(params), empty(FIT), empty(PARAMS)];
  const given = checked("fit", fit, Object.keys(FIT));
  const { values, stdErrors } = fitOf(own);
  values.set(elements("fit.values", given.values, values.length));
  stdErrors.set(elements("fit.stdErrors", given.stdErrors, stdErrors.length));
  call(changes, "acrobot_fit_params", own, machine(changes), words);
  return unpack(words, PARAMS);
}

export function identify(recording, params) {
  const changes = readChanges(params);
  const [given, samples, count] = readRecording(recording);
  const all = { ...changes, ...given };
  const words = empty(PARAMS);
  call(all, "acrobot_identify", samples, count, machine(changes), words);
  return unpack(words, PARAMS);
}

export function calibrate(recording, params) {
  const changes = readChanges(params);
  const [given, samples, count] = readRecording(recording);
  const words = empty(CALIBRATION);
  call({ ...changes, ...given }, "acrobot_calibrate", samples, count, machine(changes), words);
  const part = ([at, length]) => words.slice(at, at + length);
  const [zero1, zero2, delay, predictionError, angleNoise] = new Float64Array(words.buffer);
  const [fit, found] = [fitOf(part(CALIBRATION.fit)), unpack(part(CALIBRATION.params), PARAMS)];
  return { params: found, fit, zeros: [zero1, zero2], delay, predictionError, angleNoise };
}

export function predictionError(params, recording, horizon) {
  const changes = readChanges(params);
  const [given, samples, count] = readRecording(recording);
  positive("horizon", horizon);
  const [all, error] = [{ ...changes, ...given }, new Float64Array(1)];
  call(all, "acrobot_prediction_error", machine(changes), samples, count, horizon, error);
  return error[0];
}

const isInt32 = (number) => number === (number | 0);

/** A copy of a machine with encoders, and its words. */
function readSettings(settings) {
  const given = checked("settings", settings, Object.keys(SETTINGS));
  const { params, limit, counts, delay = 0, planTimeout = Infinity } = given;
  const changes = readChanges(params);
  const numbers = { limit, delay, planTimeout };
  for (const [name, value] of Object.entries(numbers)) checkNumber(name, value);
  const integers = elements("counts", counts, 2, isInt32, "must be an integer of 32 bits");
  const words = pack(empty(SETTINGS), numbers, SETTINGS);
  words.set(machine(changes));
  new Int32Array(words.buffer).set(integers, SETTINGS.counts[0]);
  return [{ ...changes, ...numbers, counts: integers }, words];
}

export class Controller extends Made {
  static kind = "controller";

  constructor(settings) {
    const [given, words] = readSettings(settings);
    super(SIZES.controller, given, "acrobot_controller_init", words);
  }

  tick(count1, count2) {
    const given = { count1, count2 };
    for (const [name, count] of Object.entries(given)) {
      if (!isInt32(count)) throw invalid(`${name} must be an integer of 32 bits`, count);
    }
    const torque = new Float32Array(1);
    call(given, "acrobot_controller_tick", this, count1, count2, torque);
    return torque[0];
  }

  get state() {
    return stateOf("acrobot_controller_state", this);
  }

  get params() {
    return unpack(paramsOf("acrobot_controller_params", this), PARAMS);
  }

  get report() {
    const words = empty(REPORT);
    call({}, "acrobot_controller_report", this, words);
    return unpack(words, REPORT);
  }
}

export class Replanner extends Made {
  static kind = "replanner";

  constructor(settings) {
    const [given, words] = readSettings(settings);
    super(SIZES.replanner, given, "acrobot_replanner_init", words);
  }

  exchange(controller) {
    if (!(controller instanceof Controller)) {
      throw invalid("controller must be a Controller", controller, []);
    }
    call({}, "acrobot_replanner_exchange", this, controller);
  }

  work() {
    call({}, "acrobot_replanner_work", this);
  }
}
