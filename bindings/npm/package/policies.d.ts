import type { Action, Params, Seed, State } from "./index.js";

/** What a policy reads: an `Acrobot` has it. */
export interface Readable {
  readonly state: Readonly<State>;
  /** The total energy, J. */
  readonly energy: number;
  readonly params: Readonly<Params>;
}

/** Torque against the velocity of link 1. */
export function bangBang(acrobot: Pick<Readable, "state">): Action;

/** The torque −(E↑ − E) θ̇1, rounded to an action, where E is the energy and E↑ that of standing upright. */
export function energyLaw(acrobot: Readable): Action;

/** The energy of standing upright at rest, J. */
export function uprightEnergy(params: Readonly<Params>): number;

export interface LearnerOptions {
  /** The number of episodes over which the learner takes ever smaller steps, from 1 to 2^32 − 1. The default is 2000. */
  episodes?: number;
  /** The seed of the initial states. The default is random. */
  seed?: Seed;
}

/** Q(λ) with tile coding and replay in 64 KiB: the learner of the native program `swing_up`, with the same bits. */
export class Learner {
  constructor(options?: LearnerOptions);
  /** Learns for one episode of Acrobot-v1, in an environment of its own. Returns the sum of the rewards. */
  train(): number;
  /** The learnt policy's action: that with the highest value. */
  act(acrobot: Pick<Readable, "state">): Action;
  /** The weights, as `swing_up --save` writes them. */
  save(): Uint8Array;
  /** Loads weights. Throws an error with the reason if they are rejected, and changes nothing then. */
  load(weights: Uint8Array): void;
}

/** A perceptron that was trained in Python: `acrobot_rs.policy.save` writes its file. The same bits as on a microcontroller. */
export class Perceptron {
  /** Throws an error with the reason if the file is rejected. It may have layers of up to 256 units. */
  constructor(file: Uint8Array);
  /** The action with the highest score, or of the torque's sign. */
  act(acrobot: { readonly observation: ArrayLike<number> }): Action;
}

/** Like that of `acrobot-rs`, for the module of `Learner` and `Perceptron`. */
export function moduleBytes(): Uint8Array;

/** Like that of `acrobot-rs`, before the first `Learner` or `Perceptron`. */
export function setModule(module: object): void;
