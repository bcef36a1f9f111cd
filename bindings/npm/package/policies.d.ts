import type { Acrobot, Action, Params, Seed, State } from "./index.js";

/** What a policy reads: an `Acrobot` has it. */
export interface Readable {
  readonly state: Readonly<State>;
  /** The total energy, J. */
  readonly energy: number;
  readonly params: Readonly<Params>;
}

/** Torque against the velocity of link 1. */
export function bangBang(acrobot: Pick<Readable, "state">): Action;

/** The torque −(E↑ − E) θ̇1, rounded to an action: E is the energy, E↑ that of standing upright. */
export function energyLaw(acrobot: Readable): Action;

/** The energy of standing upright at rest, J. */
export function uprightEnergy(params: Readonly<Params>): number;

export interface LearnerOptions {
  /** The episodes over which its steps get smaller, from 1 to 2^32 − 1. Default: 2000. */
  episodes?: number;
  /** The seed of the initial states. Default: random. */
  seed?: Seed;
  /** An acrobot with the parameters to learn with, without friction. Default: Gymnasium's. */
  acrobot?: Acrobot;
}

/** Q(λ) with tile coding and replay in 64 KiB: bit-identical to the native program `swing_up`. */
export class Learner {
  constructor(options?: LearnerOptions);
  /** Learns for one episode of Acrobot-v1, in its own environment. Returns the rewards' sum. */
  train(): number;
  /** The learnt policy's action: that with the highest value. */
  act(acrobot: Pick<Readable, "state">): Action;
  /** The weights, as `swing_up --save` writes them. */
  save(): Uint8Array;
  /** Loads weights, or throws an error with the reason for which they are rejected. */
  load(weights: Uint8Array): void;
}

/** A perceptron from Python's `acrobot_rs.policy.save`, bit-identical to a microcontroller's. */
export class Perceptron {
  /** Throws an error with the reason if the file is rejected. Layers may have up to 256 units. */
  constructor(file: Uint8Array);
  /**
   * The action with the highest score, or of the torque's sign. If the outputs are not all finite,
   * because sums overflow, it is 1, no torque.
   */
  act(acrobot: { readonly observation: ArrayLike<number> }): Action;
}

// For the module of this file.
export { moduleBytes, setModule } from "./index.js";
