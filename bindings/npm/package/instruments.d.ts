import {
  Batch as Ideal, BatchOptions as IdealOptions, Draw, moduleBytes, setModule,
} from "./index.js";

export { moduleBytes, setModule };

/**
 * The motor and the sensors of an acrobot, rounded to single precision. 0 is ideal: a torque acts
 * at once, and the observation is that of the true state. Delays are at most 8 steps.
 */
export interface Instruments {
  /** How many steps later a torque acts: a whole number, each equally likely. */
  actionDelay: number;
  /** How many steps later an agent sees a reading: a whole number, each equally likely. */
  observationDelay: number;
  /** The time constant of the motor, s, from 0 to 1000: the torque approaches the chosen one. */
  motorLag: number;
  /** The relative error of the motor's torque, from −1 to 1000: with 0.1 it is 10 % too large. */
  torqueError: number;
  /** The standard deviation of a reading of an angle, rad, from 0 to 10. */
  angleNoise: number;
  /** What encoder 1 reads where θ1 is 0, rad, from −π to π. */
  encoderZero1: number;
  /** What encoder 2 reads where θ2 is 0, rad, from −π to π. */
  encoderZero2: number;
  /** The counts of the encoders for a turn, from 1 to 2²²: readings are whole counts. */
  encoderCounts: number;
  /**
   * The time constant of a low-pass filter, s, from 0 to 1000. The agent sees filtered differences
   * of readings as velocities, and not the true ones.
   */
  velocityFilter: number;
}

/**
 * What a reset draws of the instruments: delays uniformly from whole numbers. Others, and "fixed"
 * ones, stay.
 */
export type InstrumentDraws = { readonly [Name in keyof Instruments]?: Draw };

export interface BatchOptions extends IdealOptions {
  /** As `setInstruments`. Default: ideal. */
  instruments?: Readonly<Partial<Instruments>>;
  /** As `setInstrumentDraws`. Default: none. */
  instrumentDraws?: InstrumentDraws;
}

/**
 * Acrobots whose torques come later and wrong, and whose observations do, too. Rewards and ends use
 * the true states, which `states` has. Snapshots are those of Rust's
 * `VecBatch<Damped<Fast>, Measured<AnyTask, 8>>`.
 */
export class Batch extends Ideal {
  constructor(options: BatchOptions);
  static restore(snapshot: Uint8Array): Batch;
  /** The instruments of an acrobot: those that the last reset drew, or that were set. */
  instrumentsOf(index: number): Readonly<Instruments>;
  /**
   * Sets the instruments of an acrobot, until a reset draws them. All acrobots of a batch have the
   * kinds of instruments that one has, so with a `velocityFilter` all see differences of readings,
   * which are not filtered where it is 0.
   */
  setInstrumentsOf(index: number, instruments: Readonly<Partial<Instruments>>): void;
  /**
   * As `setInstrumentsOf`, for all acrobots. Where a number is 0 and resets draw none, all are
   * ideal.
   */
  setInstruments(instruments: Readonly<Partial<Instruments>>): void;
  /**
   * From now on each reset draws these instruments of each acrobot, after the initial state and
   * from the same random numbers.
   */
  setInstrumentDraws(draws: InstrumentDraws): void;
}
