//! Model-predictive control of a real acrobot: from encoder counts to torques, without a heap.
//!
//! [`Controller::tick`] estimates the state and follows a plan. It is short: call it in a timer's
//! interrupt. [`Replanner::work`] improves a plan that begins a little later, for the estimated
//! machine. It is long: call it in the main loop, where the interrupt may stop it anywhere. Between
//! two slices of work [`Replanner::exchange`] copies plans and estimates.
//!
//! Dry friction acts as much viscous friction at rest and as little in motion, and the gains of
//! regulators for these have opposite signs, so no fixed regulator holds for long. The plans that
//! swing up also hold: each is improved for its next second, upright, too.
//!
//! ```
//! use std::f64::consts::TAU;
//!
//! use acrobot::arithmetic::Damped;
//! use acrobot::control::mpc::{Controller, Replanner, Settings};
//! use acrobot::physics::Pendulum;
//! use acrobot::{Params, Portable, State};
//!
//! // RealAIGym's acrobot stands for encoders and motor.
//! let params = Params {
//!     length1: 0.2,
//!     length2: 0.3,
//!     mass1: 0.523,
//!     mass2: 0.626,
//!     center_of_mass1: 0.2,
//!     center_of_mass2: 0.256,
//!     coulomb1: 0.16,
//!     coulomb2: 0.12,
//!     dt: 0.002,
//!     ..Params::DEFAULT
//! };
//! let params = params.with_inertias_about_joints([0.0319, 0.0509]);
//! let start = State { theta1: 0.05, ..State::HANGING };
//! let mut machine = Pendulum::<Damped<Portable>>::new(params, start)?;
//! let (params, counts) = (params.cast(), [4096, 4096]);
//! let settings = Settings { params, limit: 6.0, counts, delay: 0.0, plan_timeout: 1.0 };
//! let mut controller = Controller::<100>::new(settings)?; // plans of 100 decisions
//! let mut replanner = Replanner::new(settings)?;
//! for tick in 0..2000 {
//!     let State { theta1, theta2, .. } = machine.state();
//!     let counts = [theta1, theta2].map(|angle| (angle / TAU * 4096.0).round() as i32);
//!     let torque = controller.tick(counts)?;
//!     machine.step(torque.into())?;
//!     if tick % 10 == 0 {
//!         replanner.exchange(&mut controller);
//!         replanner.work();
//!     }
//! }
//! let [theta1, ..] = machine.state().deviation_from(State::UPRIGHT);
//! assert!(theta1.abs() < 0.1, "{theta1}"); // rad
//! # Ok::<(), acrobot::Error>(())
//! ```

mod controller;
mod delay;
mod replanner;

pub use controller::{Controller, Report, Settings};
pub use replanner::Replanner;
