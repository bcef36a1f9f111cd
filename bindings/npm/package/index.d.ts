/// <reference lib="es2015.symbol" />

// What `using` needs. TypeScript's own esnext.disposable does not compile with old targets.
declare global {
  interface SymbolConstructor {
    readonly dispose: unique symbol;
  }
  interface Disposable {
    [Symbol.dispose](): void;
  }
}

// Without this line, everything here would be exported.
export {};

/** Torques of −1, 0 and 1 N m between the links, or `Params.torques`. */
export type Action = 0 | 1 | 2;

/** A number from 0 to 2^53 − 1, or a BigInt from 0 to 2^2048 − 1. */
export type Seed = number | bigint;

/** Angles and velocities, in single precision. */
export interface State {
  /** Angle of link 1, rad; 0 is hanging straight down, counter-clockwise is positive. */
  theta1: number;
  /** Angle of link 2 relative to link 1, rad; 0 is in line with it. */
  theta2: number;
  /** Angular velocity of link 1, rad/s. */
  dtheta1: number;
  /** Angular velocity of link 2 relative to link 1, rad/s. */
  dtheta2: number;
}

/**
 * The parameters, rounded to single precision. The lengths, masses, torque noise and `dynamics` of
 * a swing-up have the defaults below, the others those of dm_control. The task "balance" has
 * other defaults for `dt`, 0.02, and `torques`, [-10, 0, 10]. Friction and `rotor` are 0 by
 * default.
 */
export interface Params {
  /** Length of link 1, m; above 0. Default 1. */
  length1: number;
  /** Length of link 2, m; above 0. Only the tip's height and drawings depend on it. Default 1. */
  length2: number;
  /** Mass of link 1, kg; above 0. Default 1. */
  mass1: number;
  /** Mass of link 2, kg; above 0. Default 1. */
  mass2: number;
  /** Distance of link 1's centre of mass from its joint, m; 0 or more. Default 0.5. */
  centerOfMass1: number;
  /** Distance of link 2's centre of mass from its joint, m; 0 or more. Default 0.5. */
  centerOfMass2: number;
  /**
   * Moment of inertia of link 1 about its centre of mass, kg m²; 0 or more, and above 0 if the
   * centre of mass is on the joint. Default 1.
   */
  inertia1: number;
  /** Moment of inertia of link 2 about its centre of mass, kg m²; as `inertia1`. Default 1. */
  inertia2: number;
  /** Acceleration of gravity, m/s², downwards; finite, 0 for none. Default 9.8. */
  gravity: number;
  /** Duration of one step, s; above 0. Default 0.2. */
  dt: number;
  /**
   * Bound of |θ̇1| after a step, rad/s; at least 1.2e-38. Infinity, for none, is stored as 3.4e38,
   * the largest number in single precision, which observations have. Default 4 π.
   */
  maxVelocity1: number;
  /** Bound of |θ̇2| after a step, rad/s; as `maxVelocity1`. Default 9 π. */
  maxVelocity2: number;
  /**
   * Torques of the three actions, N m, in the order of their numbers; finite. Default [−1, 0, 1].
   */
  torques: readonly [number, number, number];
  /**
   * Torque noise, N m; 0 or more. Each step adds a uniform draw from [−noise, noise) to the torque;
   * 0 draws nothing. Default 0.
   */
  torqueNoise: number;
  /**
   * Viscous friction of the fixed joint, which resists θ̇1 with a torque in proportion to it,
   * N m s/rad; 0 or more. Default 0.
   */
  damping1: number;
  /** Viscous friction of the elbow, which resists θ̇2; as `damping1`. Default 0. */
  damping2: number;
  /**
   * Coulomb friction of the fixed joint: its torque as soon as the joint turns, N m; 0 or more.
   * Default 0.
   */
  coulomb1: number;
  /** Coulomb friction of the elbow; as `coulomb1`. Default 0. */
  coulomb2: number;
  /**
   * What a geared rotor in the elbow takes from the coupling of the links, kg m²; finite, and so
   * small that the mass matrix is positive definite. A rotor of moment of inertia J behind a gear g
   * adds (g + 1)² J to `inertia1`, g² J to `inertia2`, and (g + 1) g J here. Default 0.
   */
  rotor: number;
  /**
   * The equations of motion: of Sutton and Barto's book, or of the paper of 1996 (NIPS 8). Default
   * "book".
   */
  dynamics: "book" | "nips";
}

/**
 * How a reset draws a number, in the parameter's unit: uniformly from [low, high], with its
 * logarithm uniform, with a low above 0, or from a normal distribution that is truncated at the
 * bounds, by [mean, standard deviation, low, high]. Equal bounds draw nothing.
 */
export type Draw =
  | readonly [low: number, high: number]
  | { readonly uniform: readonly [low: number, high: number] }
  | { readonly logUniform: readonly [low: number, high: number] }
  | { readonly normal: readonly [mean: number, std: number, low: number, high: number] }
  | "fixed";

/** What a reset draws of the parameters, in their order. Others, and "fixed" ones, stay. */
export type Draws = {
  readonly [Name in Exclude<keyof Params, "torques" | "dynamics">]?: Draw;
} & { readonly torques?: readonly [Draw, Draw, Draw] };

// derive.py writes the tasks.
/**
 * A task, by its name:
 *
 * - "gymnasium": Gymnasium's `Acrobot-v1`: swing the tip above a height within 500 steps of 0.2 s.
 * - "swingup": dm_control's `acrobot-swingup`, with friction: from rest anywhere to upright within
 *   1,000 steps of 0.01 s. The reward is from 0 to 1. The observation has the sines of both links'
 *   angles from upright, their cosines, and the velocities.
 * - "balance": Stay upright for 500 steps of 0.02 s with a motor of 10 N m, from within ±0.05 of
 *   upright. The reward is 1 upright and 0 hanging.
 */
export type Task = "gymnasium" | "swingup" | "balance";
// The end of the tasks.

export interface Options {
  /** The seed of the first initial state and all later random numbers. Default: random. */
  seed?: Seed;
  /** Parameters that differ from the default. */
  params?: Readonly<Partial<Params>>;
  /** The number of steps that truncates an episode, from 1 to 2^32 − 1. Default: 500. */
  maxSteps?: number;
  /** Default: "gymnasium". */
  task?: Task;
  /** As `setDraws`. Default: none. */
  draws?: Draws;
}

export interface Step {
  /**
   * A new array: [cos θ1, sin θ1, cos θ2, sin θ2, θ̇1, θ̇2], velocities in rad/s. In a swing-up the
   * first four are the sines of both links' angles from upright, then their cosines.
   */
  observation: Float32Array;
  /** −1, or 0 if `terminated`. In other tasks from 0 to 1. */
  reward: number;
  /** Whether the goal is reached: −cos θ1 − cos(θ1 + θ2) > 1. Never in other tasks. */
  terminated: boolean;
  /** Whether the episode has reached `maxSteps`. */
  truncated: boolean;
}

/** A 2D context of a canvas or an `OffscreenCanvas`, or that of a package for Node.js. */
export interface Context {
  readonly canvas: { readonly width: number; readonly height: number };
  arc(x: number, y: number, radius: number, startAngle: number, endAngle: number): void;
}

export interface DrawOptions {
  /** The side of the square from (0, 0), pixels; 0 or more. Default: the canvas's shorter side. */
  size?: number;
  /** CSS colours. Default: Gymnasium's, with red for the torque. */
  colors?: Partial<Record<"background" | "target" | "link" | "joint" | "torque", string>>;
}

/** What acrobots and batches share. After `free()` methods throw an `Error`. */
declare abstract class Kept {
  /** The parameters: a frozen copy. */
  get params(): Readonly<Params>;
  /** Changes some parameters for the next steps, or throws if one is outside its range. */
  setParams(changes: Readonly<Partial<Params>>): void;
  /**
   * From now on each reset draws these parameters after the initial state, from the same random
   * numbers: a batch draws for each acrobot, and needs `ownParams`. `{}` ends it. Throws if a draw
   * could be outside the parameter's range.
   */
  setDraws(draws: Draws): void;
  /** Frees the memory in WebAssembly now, and not when the garbage collector does. */
  free(): void;
  /** Calls `free()`: for `using`. */
  [Symbol.dispose](): void;
}

/** One acrobot. Invalid arguments throw a `RangeError` or `TypeError`, and change nothing. */
export class Acrobot extends Kept {
  constructor(options?: Options);
  /**
   * A new acrobot that continues from a snapshot with the same bits, and draws no parameters until
   * `setDraws`. Throws if the snapshot is damaged or of another version.
   */
  static restore(snapshot: Uint8Array): Acrobot;
  /** Begins an episode, without a seed from the next random numbers. Returns the observation. */
  reset(seed?: Seed): Float32Array;
  /** Applies an action for one dt. Steps after the end of an episode continue it. */
  step(action: Action): Step;
  /** As `step`, with any finite torque, N m. */
  stepTorque(torque: number): Step;
  /** A random action, from other random numbers than `reset`: Gymnasium's `action_space`. */
  sample(seed?: Seed): Action;
  get task(): Task;
  get observation(): Float32Array;
  /** The state: a frozen copy. Setting it, to finite numbers, continues the episode. */
  get state(): Readonly<State>;
  set state(state: Readonly<State>);
  /** The total energy, J; 0 at rest at the height of the fixed joint. Can be infinite or NaN. */
  get energy(): number;
  /** The height of the tip above the fixed joint, m. */
  get tipHeight(): number;
  /** The number of steps since the last reset. */
  get elapsedSteps(): number;
  get maxSteps(): number;
  /**
   * About 160 bytes, without draws: Rust's `TimeLimit<Acrobot<Damped<Fast>, AnyTask>>` in postcard
   * with CRC-32.
   */
  snapshot(): Uint8Array;
  /** Draws the acrobot, with an arrow for the torque of the last step. */
  draw(context: Context, options?: DrawOptions): void;
}

export interface BatchOptions extends Options {
  /** The number of acrobots, from 1 to as many as fit into 4 GiB. */
  count: number;
  /** When an ended acrobot is reset: Gymnasium's `AutoresetMode`. Default: "NextStep". */
  autoreset?: "NextStep" | "SameStep" | "Disabled";
  /** Whether each acrobot has its own parameters, for `setParamsOf`. Default: for `draws`. */
  ownParams?: boolean;
}

/**
 * Arrays with an element, or a row of six numbers, for each acrobot. The next step overwrites them,
 * or makes new ones if these were transferred to another thread.
 */
export interface BatchStep {
  observations: Float32Array;
  /** −1, or 0 if the acrobot terminated or was only reset. In other tasks from 0 to 1. */
  rewards: Float32Array;
  /** 1 at the goal, otherwise 0. */
  terminated: Uint8Array;
  /** 1 after `maxSteps` steps, otherwise 0. */
  truncated: Uint8Array;
  /** 1 if either is; with "Disabled", until the step after the reset. For `resetMasked`. */
  done: Uint8Array;
  /** With "SameStep": the last observation of each episode that this step ended. */
  finalObservations?: Float32Array;
}

/**
 * Many acrobots, stepped with SIMD. Acrobot `i` has the random numbers of the seed's `i`-th child:
 * above 0 it is bit-identical to `new Acrobot({ seed: seed + (BigInt(i) << 128n) })`, for a BigInt
 * `seed` below 2^128.
 */
export class Batch extends Kept {
  constructor(options: BatchOptions);
  /** As `Acrobot.restore`. */
  static restore(snapshot: Uint8Array): Batch;
  get count(): number;
  get settings(): Readonly<Required<Omit<BatchOptions, "seed" | "params" | "draws">>>;
  /** The array that steps and resets overwrite, as does reading it after `setStateOf`. */
  get observations(): Float32Array;
  /** Begins an episode of each acrobot. Returns `observations`. */
  reset(seed?: Seed): Float32Array;
  /** As `reset`, for the acrobots whose element is true or 1. The others do not change. */
  resetMasked(mask: ArrayLike<number | boolean>, seed?: Seed): Float32Array;
  /**
   * Applies an action to each acrobot, fastest from a `Uint8Array`. With "Disabled" an ended
   * episode continues: −1 a step, 0 at the goal.
   */
  step(actions: ArrayLike<number>): BatchStep;
  /** As `step`, with any finite torques, N m, fastest from a `Float32Array`. */
  stepTorque(torques: ArrayLike<number>): BatchStep;
  /** As `Acrobot.sample`, for each acrobot: a new array. */
  sample(seed?: Seed): Uint8Array;
  /** The states, a row of four numbers for each acrobot: a new array. */
  get states(): Float32Array;
  /** As `setStateOf`, for all: rows as in `states`. */
  setStates(states: ArrayLike<number>): void;
  /** The state of an acrobot: a frozen copy. */
  stateOf(index: number): Readonly<State>;
  /** As `Acrobot.state`. With "NextStep", the next step still resets an ended acrobot. */
  setStateOf(index: number, state: Readonly<State>): void;
  /** The number of steps since an acrobot's last reset. */
  elapsedStepsOf(index: number): number;
  /** The parameters of an acrobot. `params` has those of the first. */
  paramsOf(index: number): Readonly<Params>;
  /** Changes parameters of one acrobot, if the batch has `ownParams`. `setParams` changes all. */
  setParamsOf(index: number, changes: Readonly<Partial<Params>>): void;
  /**
   * About 150 bytes for each acrobot, and 60 to 400 for the settings and draws: Rust's
   * `VecBatch<Damped<Fast>, AnyTask>` in postcard with CRC-32.
   */
  snapshot(): Uint8Array;
  /** As `Acrobot.draw`. */
  draw(context: Context, index: number, options?: DrawOptions): void;
}

/** The WebAssembly module inside this file, to compile it elsewhere. */
export function moduleBytes(): Uint8Array;

/** Takes the compiled `WebAssembly.Module` before the first acrobot, where code may not compile. */
export function setModule(module: object): void;
