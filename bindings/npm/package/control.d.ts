import type { Params, Seed, State } from "./index.js";

/** Numbers by rows: `matrix[i][j]`. */
export type Matrix = ArrayLike<ArrayLike<number>>;

/**
 * A model in continuous time, ẋ = A x + B u: x is the deviation from a state [θ1, θ2, θ̇1, θ̇2],
 * rad and rad/s, and u that from a torque, N m.
 */
export interface LinearModel {
  /** A by rows: the derivatives of the rates by the state. */
  a: Float32Array[];
  /** B: the derivatives of the rates by the torque. */
  b: Float32Array;
}

/** A model of one step, x′ = A x + B u, of the same deviations. */
export interface StepModel {
  /** A by rows: the derivatives of the state after the step by that before. */
  a: Float32Array[];
  /** B: the derivatives of the state after the step by the torque. */
  b: Float32Array;
}

export interface Regulator {
  /** K in u = −K x, N m per rad and per rad/s. */
  gain: Float32Array;
  /** P by rows: xᵀ P x is the cost of all steps from x on. */
  costToGo: Float32Array[];
}

// Parameters that are not given are Gymnasium's, with friction of 0. An invalid argument throws a
// `RangeError` or `TypeError`, and changes nothing.

/** The deviation of a state from a target, with angles wrapped to ±π. */
export function deviationFrom(state: Readonly<State>, target: Readonly<State>): Readonly<State>;

/** Angular velocities, rad/s, and accelerations, rad/s². */
export interface Rates {
  dtheta1: number;
  dtheta2: number;
  ddtheta1: number;
  ddtheta2: number;
}

/** How fast a state changes under a torque, N m. */
export function derivative(
  state: Readonly<State>, torque: number, params: Readonly<Partial<Params>>,
): Readonly<Rates>;

/** The mass matrix M by rows, kg m²: the kinetic energy is half of vᵀ M v for the velocities v. */
export function massMatrix(
  state: Readonly<State>, params: Readonly<Partial<Params>>,
): Float32Array[];

/** The torques and forces of a motion. */
export interface Forces {
  /** On θ1, 0 for an acrobot, and on θ2, that of the motor, N m. */
  torques: readonly [number, number];
  /** Of the fixed joint on link 1, to the right and up, N. */
  reaction: readonly [number, number];
  /** The same of link 1 on link 2. */
  elbow: readonly [number, number];
}

/** What accelerations, rad/s², need in a state: the inverse of `derivative`. */
export function inverseDynamics(
  state: Readonly<State>, ddtheta1: number, ddtheta2: number, params: Readonly<Partial<Params>>,
): Readonly<Forces>;

/** The equations of motion about a state and a torque, N m: ẋ = A x + B u. */
export function linearize(
  state: Readonly<State>, torque: number, params: Readonly<Partial<Params>>,
): LinearModel;

/** One step of `dt` about a state and a torque, N m: x′ = A x + B u. */
export function linearizeStep(
  state: Readonly<State>, torque: number, params: Readonly<Partial<Params>>,
): StepModel;

/**
 * The regulator with the least sum of xᵀ Q x + R u² over all steps, about an equilibrium: by
 * default upright, with a torque of 0. Throws if the target is none, or if there is no such
 * regulator.
 */
export function regulator(
  params: Readonly<Partial<Params>>, q: Matrix, r: number, target?: Readonly<State>,
  torque?: number,
): Regulator;

/** The regulator of a model in continuous time: the least integral of xᵀ Q x + R u². */
export function lqr(model: Readonly<LinearModel>, q: Matrix, r: number): Regulator;

/** The regulator of a model of steps: the least sum of xᵀ Q x + R u². */
export function dlqr(model: Readonly<StepModel>, q: Matrix, r: number): Regulator;

/**
 * The regulator along a trajectory with a model for each step, and with P of xᵀ P x, the cost after
 * it. Returns K for each step, and P before the first.
 */
export function tvlqr(
  models: ArrayLike<Readonly<StepModel>>, q: Matrix, r: number, costToGo: Matrix,
): { gains: Float32Array[]; costToGo: Float32Array[] };

/** A steady-state Kalman filter. */
export interface Filtering {
  /** L by rows, of two: the correction of x by L (y − [x1, x2]) for the measured angles y. */
  gain: Float32Array[];
  /** P by rows: the covariance of the errors before the correction. */
  priorCovariance: Float32Array[];
}

/**
 * The Kalman filter of a model of steps whose angles are measured: the least variances of its
 * errors after many steps. `w` is the covariance of the noise that each step adds to x, and `s` are
 * the variances of both measurements, rad².
 */
export function dlqe(
  model: Readonly<StepModel>, w: Matrix, s: readonly [number, number],
): Filtering;

/**
 * What a plan costs. A larger weight, of at least 0, makes its term smaller. Defaults follow from
 * the machine: T² is the inertia of the straight machine about the fixed joint, divided by the sum
 * of the torque of gravity when it is level and the largest torque u.
 */
export interface Cost {
  /**
   * Q of xᵀ Q x, for the deviation x from the target, by rows: 1/(rad² s), 1/rad² and s/rad²;
   * symmetric and positive semidefinite. Default 0.
   */
  q: Matrix;
  /** The same of the state after the plan: 1/rad², s/rad² and s²/rad². Default 0. */
  qf: Matrix;
  /**
   * Of 2 − 2 cos x, for the deviation x of each angle from the target, 1/s: of x² where it is
   * small. Default 0.
   */
  angles: readonly [number, number];
  /**
   * R: of the square of the torque's difference from that which holds the target, 1/((N m)² s).
   * Default 0.1 / (T u²).
   */
  torque: number;
  /** Of the square of the torque's change from one step to the next, 1/(N m)². Default 0. */
  torqueChange: number;
  /** Of the absolute value of the motor's power, 1/J. Default 0. */
  power: number;
  /** Of the time that the tip is below `height`, 1/s. Default 0.4 / T. */
  below: number;
  /**
   * The height of the tip above the fixed joint, m, from which on `below` costs nothing. Default
   * that of the target.
   */
  height: number;
  /**
   * `below` costs half where the tip is so far below `height`, m; above 0. Default a tenth of both
   * lengths.
   */
  margin: number;
  /**
   * Of ln(1 + e) for the state after the plan, where e is 1 at the border of the region in which
   * the regulator holds. Default 20.
   */
  arrival: number;
}

/** A plan: `torques` has a number for each step, the others have rows of four. */
export interface Plan {
  /** The states before the steps. */
  states: Float32Array;
  /** N m. */
  torques: Float32Array;
  /** K of torque − K x for the deviation x from the state, N m per rad and per rad/s. */
  gains: Float32Array;
  /** Two numbers for each step, for `improve`. */
  workspace: Float32Array;
  /** What holds the target after the steps: the numbers of Rust's `Feedback`. */
  after: Float32Array;
}

/** The torque that follows a plan at a step, and after it holds the target, N m: unlimited. */
export function planTorque(plan: Plan, step: number, state: Readonly<State>): number;

export interface PlanOptions {
  /** The most steps of a plan, from 1 to 65,535. */
  steps: number;
  /** The most tries, from 1 to 2^32 − 1. Default: 64. */
  tries?: number;
  /** The seed of the first guesses, below 2^64. Default: random. */
  seed?: Seed;
}

/** What has memory in WebAssembly. After `free()` methods throw an `Error`. */
declare abstract class Kept {
  /** Frees the memory in WebAssembly now, and not when the garbage collector does. */
  free(): void;
  /** Calls `free()`: for `using`. */
  [Symbol.dispose](): void;
}

/** Plans motions to a target: bit-identical to Rust's `Planner<Damped<Fast>>`. */
export class Planner extends Kept {
  /**
   * For a largest torque, N m, and parameters whose `dt` is the time between two decisions. The
   * target is upright, or balanced with an `elbow` angle, rad. No plan reaches the bounds of the
   * velocities.
   */
  constructor(
    params: Readonly<Partial<Params>>, limit: number, cost?: Readonly<Partial<Cost>>,
    elbow?: number,
  );
  /** A plan from a state to the target, or `null` if no try has found one. May take seconds. */
  plan(start: Readonly<State>, options: PlanOptions): Plan | null;
  /**
   * Improves a plan in place, which then begins in the state `start`, by 1 to 2^32 − 1 iterations
   * at most. Returns its cost: the lower, the better. If it throws, the plan is unchanged.
   */
  improve(start: Readonly<State>, iterations: number, plan: Plan): number;
  /**
   * Plans for a simulation that clamps velocities at the bounds of its parameters, as Gymnasium's
   * does. Plans may use that as a brake. Returns the planner.
   */
  withVelocityClamp(): this;
  /** Whether what holds after a plan takes the machine from this state to the target. */
  holdsFrom(state: Readonly<State>): boolean;
}

/** Swings up without a plan: pumps energy, and then holds. Bit-identical to Rust's `SwingUp`. */
export class SwingUp extends Kept {
  /** For a largest torque, N m, and parameters whose `dt` is the time between two decisions. */
  constructor(params: Readonly<Partial<Params>>, limit: number);
  /** The torque at a state, N m, up to the largest. */
  torque(state: Readonly<State>): number;
}

/** The noise of a machine. */
export interface Noise {
  /**
   * The standard deviation of a measured angle, rad; above 0 and at most 2. An encoder with n
   * counts for a turn has 1.8 / n.
   */
  angleStd: number;
  /** The standard deviation of the torque that acts, N m; above 0. */
  torqueStd: number;
}

declare abstract class Filter extends Kept {
  /** Corrects the estimate by measured angles, rad. The first ones are taken as they are. */
  correct(theta1: number, theta2: number): void;
  /**
   * Takes a step of `dt` with a torque, N m. If it throws because a joint turns by more than half a
   * turn or a number overflows, the next measurement begins again.
   */
  predict(torque: number): void;
  /** The estimated state. */
  get state(): Readonly<State>;
  /** The standard deviations of the state; Infinity before a measurement. */
  get stateStd(): Readonly<State>;
}

/** Estimates the state of a machine from its angles: correct, decide and predict in each `dt`. */
export class Estimator extends Filter {
  constructor(params: Readonly<Partial<Params>>, noise: Readonly<Noise>);
}

/** The standard deviations of parameters, each in its unit. Default 0, for one that is known. */
export interface ParameterStd {
  /** Of the mass of link 1, kg. */
  mass1: number;
  /** Of the mass of link 2, kg. */
  mass2: number;
  /** Of the length of link 1, m. */
  length1: number;
  /** Of the moment of inertia of link 1, kg m². */
  inertia1: number;
  /** Of the moment of inertia of link 2, kg m². */
  inertia2: number;
  /** Of the viscous friction of joint 1, N m s/rad. */
  damping1: number;
  /** Of the viscous friction of joint 2, N m s/rad. */
  damping2: number;
  /** Of the Coulomb friction of joint 1, N m. */
  coulomb1: number;
  /** Of the Coulomb friction of joint 2, N m. */
  coulomb2: number;
  /** Of the rotor, kg m². */
  rotor: number;
  /** Of what the first encoder says where θ1 is 0, rad. It is given as 0. */
  zero1: number;
  /** Of what the second encoder says where θ2 is 0, rad. It is given as 0. */
  zero2: number;
  /** Of the torque that acts, divided by the one that is sent. It is given as 1. */
  torqueFactor: number;
}

/** As `Estimator`, and estimates the parameters that have a standard deviation above 0. */
export class ParameterEstimator extends Filter {
  constructor(
    params: Readonly<Partial<Params>>, std: Readonly<Partial<ParameterStd>>,
    noise: Readonly<Noise>,
  );
  /** The estimated parameters, and those that are known. */
  get params(): Readonly<Params>;
  /** What the encoders are estimated to say where the angles are 0, rad. */
  get zeros(): [number, number];
  /** The torque that is estimated to act, divided by the one of `predict`. */
  get torqueFactor(): number;
}

/** What a machine did, with a sample in each `dt`. */
export interface Recording {
  /** θ1 and θ2 of each sample, rad, without jumps by whole turns. */
  angles: ArrayLike<number>;
  /** The motor's torque from each sample to the next, N m. */
  torques: ArrayLike<number>;
}

/** What fits recordings. */
export interface Fit {
  /**
   * The elements of the mass matrix where θ2 is ±π/2, [1, 1], [1, 2] and [2, 2], kg m²; the moments
   * m1 lc1 + m2 l1 and m2 lc2, kg m; the coupling m2 l1 lc2, kg m²; viscous friction of both
   * joints, N m s/rad; their Coulomb friction, N m.
   */
  values: Float64Array;
  /** Their standard errors; Infinity for a number that the recordings do not determine. */
  stdErrors: Float64Array;
  /** The combination that they determine least: the part of each number. */
  weakest: Float64Array;
  /** How many combinations they do not determine. */
  rankDeficiency: number;
}

/** A regression of recordings, which it does not keep. */
export class Regression extends Kept {
  /** No recording. */
  constructor();
  /**
   * Adds a recording with a sample in each `dt`, s, of a machine under `gravity`, m/s². A velocity
   * is that of a parabola through 2 `half` + 1 angles, and a window has so many samples; the next
   * one begins in its middle. A recording that is too short adds nothing.
   */
  add(
    recording: Readonly<Recording>, dt: number, gravity: number, half: number, window: number,
  ): void;
  /** The numbers that fit the recordings best. */
  fit(): Fit;
}

/**
 * The parameters of a fit: the given ones with the length of link 1, masses, inertias, rotor and
 * friction that move as the machine does. Throws if no machine has these numbers, or the recordings
 * do not determine one that is not a friction.
 */
export function fitParams(
  fit: Readonly<Fit>, params: Readonly<Partial<Params>>,
): Readonly<Params>;

/**
 * The parameters of a machine whose lengths and `dt` are given. Believes the recording: `calibrate`
 * finds or names wrong signs, zeros, a delay and lost samples.
 */
export function identify(
  recording: Readonly<Recording>, params: Readonly<Partial<Params>>,
): Readonly<Params>;

/** What `calibrate` finds. */
export interface Calibration {
  params: Readonly<Params>;
  /** The numbers that they follow from. */
  fit: Fit;
  /** The recorded angles where those of the machine are 0, rad. */
  zeros: [number, number];
  /** From a torque until it acts, with the time constant of the motor, s. */
  delay: number;
  /**
   * The root of the mean square of the errors of angles, rad, if parameters of the first two thirds
   * of the recording predict the last third, √((length1 + centerOfMass2) / gravity) ahead.
   */
  predictionError: number;
  /** The standard deviation of the noise of the angles, rad, which encoders add by counting. */
  angleNoise: number;
}

/**
 * The zeros of both encoders, the delay and the parameters of a machine whose lengths and `dt` are
 * given. Throws if the recording has a wrong sign, lost samples or torques in another unit, or does
 * not determine them.
 */
export function calibrate(
  recording: Readonly<Recording>, params: Readonly<Partial<Params>>,
): Calibration;

/**
 * The root of the mean square of the errors of angles, rad, if they are predicted `horizon` steps
 * ahead; 0 for a recording that is too short.
 */
export function predictionError(
  params: Readonly<Partial<Params>>, recording: Readonly<Recording>, horizon: number,
): number;

/** A machine with encoders. */
export interface Settings {
  /** `dt` is the time from a tick to the next. */
  params: Readonly<Partial<Params>>;
  /** The motor's largest torque, N m. */
  limit: number;
  /** The counts of each encoder for a turn, above 0. */
  counts: readonly [number, number];
  /**
   * The time from a torque of `tick` until it acts, s, with the time constant of the motor. Default
   * 0: at once.
   */
  delay?: number;
  /** The torque is 0 while the plan is older than this, s, such as 1. Default `Infinity`: never. */
  planTimeout?: number;
}

/** What a controller knows beside the state and the parameters. */
export interface Report {
  /** What the encoders are estimated to say where the angles are 0, rad. */
  zeros: [number, number];
  /** The torque that is estimated to act, divided by the one that is sent. */
  torqueFactor: number;
  /**
   * How many of the last hundred ticks have angles that no motion of the machine explains: a few
   * after a push. And 4 for each radian that a joint has turned since the other one's encoder
   * counted. Above 8 a tick is rejected.
   */
  misses: number;
  /** The time since the last plan, s. It is 0 before the first one. */
  planAge: number;
}

/** From encoder counts to torques: estimates the state, and follows a plan of 100 decisions. */
export class Controller extends Kept {
  /** Without a plan its torque is 0. */
  constructor(settings: Readonly<Settings>);
  /**
   * The torque until the next tick, N m, from what both encoders count. If it throws, switch the
   * motor off: a number is not finite, or no motion of the machine explains what they count.
   */
  tick(count1: number, count2: number): number;
  /** The estimated state. */
  get state(): Readonly<State>;
  /** The estimated parameters. */
  get params(): Readonly<Params>;
  get report(): Readonly<Report>;
}

/** Plans for a controller while the machine moves. */
export class Replanner extends Kept {
  constructor(settings: Readonly<Settings>);
  /** Gives the controller the plan once it is due, and takes its estimates. It is short. */
  exchange(controller: Controller): void;
  /** Plans for some milliseconds to tens of them: once after each `exchange`. */
  work(): void;
}

// For the module of this file.
export { moduleBytes, setModule } from "./index.js";
