// What a policy sees of a machine that is not perfect: readings of the encoders, or an estimate.

import { ParameterEstimator } from "./acrobot-rs/control.js";
import { newAcrobot, normal } from "./game.js";

/** For the estimator, standard deviations of zeros, rad, and of a torque, in largest torques. */
const STD = { zero1: 0.0175, zero2: 0.0175 };
const TORQUE = 0.01;
/** The same of a reading in counts, and the least ones of a reading, rad, and of a torque, N m. */
const [COUNT, LEAST, LEAST_TORQUE] = [0.29, 1e-4, 1e-3];
/** The most steps of a lag, so that a tiny time step does not take minutes. */
const STEPS = 100;

const wrapped = (angle) => Math.atan2(Math.sin(angle), Math.cos(angle));

export class Instruments {
  /** The last look: the run and the step, both readings, and the state that policies see. */
  #levels = null;
  #steps = 0;
  #angles = null;
  #seen = null;
  #isIdeal = true;
  #estimator = null;
  #model = newAcrobot();

  /** The state that policies see in this step of a game. */
  look(game) {
    const { levels, steps, params, acrobot } = game;
    const isSameRun = levels === this.#levels;
    if (isSameRun && steps === this.#steps) return this.#seen;
    const goesOn = isSameRun && steps === this.#steps + 1;
    // If it throws, the next look begins again.
    this.#levels = null;
    const { encoderCounts, encoderZero1, encoderZero2, angleNoise, estimate } = params;
    const isExact = [encoderCounts, encoderZero1, encoderZero2, angleNoise].every((x) => x === 0);
    this.#seen = isExact ? acrobot.state : this.#read(game, goesOn);
    this.#isIdeal = isExact && params.actionDelay + params.motorLag === 0;
    if (estimate === 1 && !this.#isIdeal) this.#seen = this.#ahead(game);
    [this.#levels, this.#steps] = [levels, steps];
    return this.#seen;
  }

  /** What policies see of the state that is shown, or null if it is that state. */
  ghostOf({ levels, steps }) {
    const isShown = levels === this.#levels && steps === this.#steps;
    return isShown && !this.#isIdeal ? this.#seen : null;
  }

  /** The estimated state, or without the estimator the readings and their differences. */
  #read({ params, acrobot, motor }, goesOn) {
    const { encoderCounts, encoderZero1, encoderZero2, angleNoise, estimate, dt } = params;
    const count = encoderCounts === 0 ? 0 : (2 * Math.PI) / encoderCounts;
    const { theta1, theta2 } = acrobot.state;
    const angles = [theta1 + encoderZero1, theta2 + encoderZero2]
      .map((angle) => angle + angleNoise * normal())
      .map((angle) => (count === 0 ? angle : count * Math.round(angle / count)));
    const before = goesOn ? this.#angles : angles;
    this.#angles = angles;
    if (estimate === 0) {
      const [dtheta1, dtheta2] = angles.map((angle, i) => wrapped(angle - before[i]) / dt);
      return { theta1: angles[0], theta2: angles[1], dtheta1, dtheta2 };
    }
    if (goesOn) this.#predict(motor.drive);
    else this.#begin(params, acrobot, count);
    this.#estimator.correct(...angles);
    return this.#estimator.state;
  }

  #begin({ torque, noise, angleNoise }, { params }, count) {
    this.#estimator?.free();
    this.#estimator = null;
    const angleStd = Math.min(Math.max(LEAST, Math.hypot(angleNoise, COUNT * count)), 2);
    const torqueStd = Math.max(LEAST_TORQUE, TORQUE * torque + noise);
    this.#estimator = new ParameterEstimator(params, STD, { angleStd, torqueStd });
  }

  #predict(torque) {
    try {
      this.#estimator.predict(torque);
    } catch {
      // A joint turns by more than half a turn. The next reading begins again.
    }
  }

  /** The state in which the next torque acts: after levels on their way, and the lag. */
  #ahead(game) {
    const { motorLag, dt } = game.params;
    const lag = Math.min(Math.round(motorLag / dt), STEPS);
    this.#model.setParams(game.acrobot.params);
    this.#model.state = this.#seen;
    for (const torque of game.drivesOf(Array(lag).fill(game.motor.sent))) {
      this.#model.stepTorque(torque);
    }
    return this.#model.state;
  }
}
