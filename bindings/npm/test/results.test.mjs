// Calls and their results, which Rust has written: tests/data/results.jsonl.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import * as control from "../dist/control.js";
import { Acrobot, Batch } from "../dist/index.js";
import { Batch as Measured } from "../dist/instruments.js";
import { STRUCTS, TASKS } from "../package/layout.js";

function rowsOf(numbers, width) {
  const starts = Array.from({ length: numbers.length / width }, (_, i) => width * i);
  return starts.map((start) => numbers.slice(start, start + width));
}
const matrix = (numbers) => rowsOf(numbers, 4);
const named = (struct, numbers) =>
  Object.fromEntries(
    Object.entries(STRUCTS[struct])
      .filter(([, [first]]) => first < numbers.length)
      .map(([name, [first, words]]) =>
        [name, words === 1 ? numbers[first] : numbers.slice(first, first + words)]),
  );
const machine = (numbers) => named("acrobot_params_t", numbers);
const stateOf = (numbers) => named("acrobot_state_t", numbers);
const numbersOf = (object) =>
  Object.values(object).flat().filter((each) => typeof each === "number");
const HANGING = stateOf([0, 0, 0, 0]);
const UPRIGHT = stateOf([Math.PI, 0, 0, 0]);

/** Draws, by their kind. */
const drawsOf = (rows) =>
  rowsOf(rows, 5).map(([kind, low, high, mean, std]) =>
    ["fixed", [low, high], { logUniform: [low, high] }, { normal: [mean, std, low, high] }][kind]);

const seedOf = ([low, high = 0]) => BigInt(low) + (BigInt(high) << 32n);
/** The numbers in arrays of arrays. */
const flat = (...parts) => parts.flatMap((part) => (part.length ? flat(...part) : [part]));
const gains = ({ gain, costToGo }) => flat(gain, costToGo);
const knots = ({ states, torques, gains: rows }) =>
  [...torques].flatMap((torque, i) =>
    [...states.slice(4 * i, 4 * i + 4), torque, ...rows.slice(4 * i, 4 * i + 4)]);

const regulatorOf = (call) => ({ params, state, torque, q, r: [r] }) => {
  const [of, target] = [machine(params), stateOf(state)];
  return call({ of, target, torque, q: matrix(q), r });
};
const modelOf = (call) => ({ params, state, torque, ...others }) =>
  call(stateOf(state), torque, machine(params), others);

const CALLS = {
  episode({ task, seed, draws, torques, snapshot }) {
    const options = { task: TASKS[task], draws: machine(drawsOf(draws)) };
    const acrobot = new Acrobot({ ...options, seed: seedOf(seed) });
    const steps = torques.flatMap((torque) => {
      const { observation, reward } = acrobot.stepTorque(torque);
      return [...observation, reward];
    });
    assert.deepEqual([...acrobot.snapshot()], snapshot);
    return [...numbersOf(acrobot.params), ...steps];
  },
  batch({ task, seed, draws, count, max_steps: maxSteps, torques, snapshot }) {
    const options = { task: TASKS[task], draws: machine(drawsOf(draws)), seed: seedOf(seed) };
    const batch = new Batch({ ...options, count, maxSteps, autoreset: "SameStep" });
    const steps = rowsOf(torques, count).flatMap((each) => {
      const { rewards, observations } = batch.stepTorque(each);
      return [...rewards, ...observations];
    });
    assert.deepEqual([...batch.snapshot()], snapshot);
    return steps;
  },
  instruments({ seed, draws, zeros, count, torques, snapshot }) {
    const instrumentDraws = named("acrobot_instruments_t", drawsOf(draws));
    const batch = new Measured({ task: "balance", count, instrumentDraws });
    zeros.forEach((encoderZero2, i) => batch.setInstrumentsOf(i, { encoderZero2 }));
    batch.reset(seedOf(seed));
    const steps = rowsOf(torques, count).flatMap((each) => {
      const { rewards, observations } = batch.stepTorque(each);
      return [...rewards, ...observations];
    });
    assert.deepEqual([...batch.snapshot()], snapshot);
    const restored = Measured.restore(Uint8Array.from(snapshot));
    restored.setInstrumentDraws({ actionDelay: "fixed" }); // Nothing changes until a reset.
    return [...steps, ...zeros.flatMap((_, i) => numbersOf(restored.instrumentsOf(i)))];
  },
  derivative: modelOf((...given) => numbersOf(control.derivative(...given))),
  mass_matrix: modelOf((state, _, params) => flat(control.massMatrix(state, params))),
  inverse_dynamics: modelOf((state, _, params, { accelerations }) =>
    [...control.inverseDynamics(state, ...accelerations, params).torques]),
  energy: modelOf((state, _, params) => {
    const acrobot = new Acrobot({ params });
    acrobot.state = state;
    return [acrobot.energy];
  }),
  linearize: modelOf((...given) => flat(...Object.values(control.linearize(...given)))),
  linearize_step: modelOf((...given) => flat(...Object.values(control.linearizeStep(...given)))),
  deviation: modelOf((state, _, params, { target }) =>
    numbersOf(control.deviationFrom(state, stateOf(target)))),
  regulator: regulatorOf(({ of, target, torque, q, r }) =>
    gains(control.regulator(of, q, r, target, torque))),
  lqr: regulatorOf(({ of, target, torque, q, r }) =>
    gains(control.lqr(control.linearize(target, torque, of), q, r))),
  dlqr: regulatorOf(({ of, target, torque, q, r }) =>
    gains(control.dlqr(control.linearizeStep(target, torque, of), q, r))),
  dlqe: modelOf((state, torque, params, { w, s }) => {
    const model = control.linearizeStep(state, torque, params);
    const { gain, priorCovariance } = control.dlqe(model, matrix(w), s);
    return flat(gain, priorCovariance);
  }),
  tvlqr: regulatorOf(({ of, target, torque, q, r }) => {
    const model = control.linearizeStep(target, torque, of);
    const along = control.tvlqr([model, model, model], q, r, q);
    return flat(along.gains, along.costToGo);
  }),
  plan({ params, limit, elbow, steps, tries, seed, start, iterations, length }) {
    const planner = new control.Planner(machine(params), limit, {}, elbow);
    const plan = planner.plan(HANGING, { steps, tries, seed: seed[0] });
    assert.equal(plan.torques.length, length);
    const first = knots(plan);
    const cost = planner.improve(stateOf(start), iterations, plan);
    const torques = [[0, stateOf(start)], [2, UPRIGHT], [steps, UPRIGHT]].map((at) =>
      control.planTorque(plan, ...at));
    return [...first, cost, ...knots(plan), ...torques];
  },
  swing_up({ params, limit, states }) {
    const swingUp = new control.SwingUp(machine(params), limit);
    return rowsOf(states, 4).map((state) => swingUp.torque(stateOf(state)));
  },
  estimate({ params, angle_std: angleStd, torque_std: torqueStd, angles, torques, ...std }) {
    const doubt = {
      mass2: std.mass2_std, coulomb2: std.coulomb2_std, zero1: std.zero1_std,
      torqueFactor: std.torque_factor_std,
    };
    const noise = { angleStd, torqueStd };
    const estimator = new control.ParameterEstimator(machine(params), doubt, noise);
    torques.forEach((torque, i) => {
      estimator.correct(...angles.slice(2 * i, 2 * i + 2));
      estimator.predict(torque);
    });
    const { state, stateStd, params: found, zeros, torqueFactor } = estimator;
    return [...[state, stateStd, found].flatMap(numbersOf), ...zeros, torqueFactor];
  },
  identify({ params, angles, torques, first, half, window, fit, calibrated }) {
    const [drawn, regression] = [machine(params), new control.Regression()];
    const found = control.identify({ angles, torques }, drawn);
    for (const [from, to] of [[0, first], [first, torques.length]]) {
      const part = { angles: angles.slice(2 * from, 2 * to), torques: torques.slice(from, to) };
      regression.add(part, drawn.dt, drawn.gravity, half, window);
    }
    const { rankDeficiency, ...arrays } = regression.fit();
    assert.deepEqual([flat(...Object.values(arrays)), rankDeficiency], [fit, 0]);
    const calibration = control.calibrate({ angles, torques }, drawn);
    const { zeros, delay, predictionError, angleNoise } = calibration;
    const { rankDeficiency: _, ...own } = calibration.fit;
    const numbers = flat([...zeros, delay, predictionError, angleNoise], ...Object.values(own));
    assert.deepEqual(numbers, calibrated);
    const all = [found, control.fitParams(regression.fit(), drawn), calibration.params];
    return all.flatMap(numbersOf);
  },
  control({ params, limit, per_turn: counts, delay, plan_timeout: planTimeout, every, ...row }) {
    const settings = { params: machine(params), limit, counts, delay, planTimeout };
    const controller = new control.Controller(settings);
    const replanner = new control.Replanner(settings);
    const torques = rowsOf(row.counts, 2).map((each, tick) => {
      const torque = controller.tick(...each);
      if (tick % every === 0) {
        replanner.exchange(controller);
        replanner.work();
      }
      return torque;
    });
    return [...torques, ...numbersOf(controller.report)];
  },
};

const path = new URL("../../../tests/data/results.jsonl", import.meta.url);
for (const line of readFileSync(path, "utf8").trim().split("\n")) {
  const { call, arithmetic, result, ...given } = JSON.parse(line);
  if (arithmetic === "portable") continue; // Python's
  test(`${call} is as in Rust`, () => {
    assert.deepEqual(CALLS[call](given), result.map(Math.fround));
  });
}
