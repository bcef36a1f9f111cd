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
// `RangeError` or `TypeError`.

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
 * default upright, with a torque of 0. Throws if the state is none, or if there is no such
 * regulator.
 */
export function regulator(
  params: Readonly<Partial<Params>>, q: Matrix, r: number, state?: Readonly<State>, torque?: number,
): Regulator;

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
  /** What holds the target after the steps: the numbers of Rust's `Feedback`. */
  after: Float32Array;
}

/** The torque that follows a plan at a step, and after it holds the target, N m: unlimited. */
export function planTorque(plan: Plan, step: number, state: Readonly<State>): number;

export interface PlanOptions {
  /** The most steps of a plan, from 1. */
  steps: number;
  /** The most tries, from 1 to 2^32 − 1. Default: 64. */
  tries?: number;
  /** The seed of the first guesses. Default: random. */
  seed?: Seed;
}

/** Plans motions to a target: bit-identical to Rust's `Planner<Damped<Fast>>`. */
export class Planner {
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
   * Improves a plan in place, which then begins in the state `start`. Returns its cost: the lower,
   * the better.
   */
  improve(start: Readonly<State>, iterations: number, plan: Plan): number;
  /** As that of an acrobot. */
  free(): void;
  /** Calls `free()`: for `using`. */
  [Symbol.dispose](): void;
}

/** Swings up without a plan: pumps energy, and then holds. Bit-identical to Rust's `SwingUp`. */
export class SwingUp {
  /** For a largest torque, N m, and parameters whose `dt` is the time between two decisions. */
  constructor(params: Readonly<Partial<Params>>, limit: number);
  /** The torque at a state, N m, up to the largest. */
  torque(state: Readonly<State>): number;
  /** As that of an acrobot. */
  free(): void;
  /** Calls `free()`: for `using`. */
  [Symbol.dispose](): void;
}

// For the module of this file.
export { moduleBytes, setModule } from "./index.js";
