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
//! use acrobot::arithmetic::Damped;
//! use acrobot::Portable;
//! use mpc::{Controller, Machine, Replanner, Settings};
//!
//! let mut machine = Machine::<Damped<Portable>>::new(1)?; // stands for encoders and motor
//! let params = machine.params().cast();
//! let settings = Settings { params, limit: 6.0, counts: [4096, 4096], ticks: 5 };
//! let mut controller = Controller::<100>::new(settings)?; // plans of 100 decisions
//! let mut replanner = Replanner::new(settings)?;
//! for tick in 0..2000 {
//!     let torque = controller.tick(machine.counts())?;
//!     machine.step(torque)?;
//!     if tick % 10 == 0 {
//!         replanner.exchange(&mut controller);
//!         replanner.work();
//!     }
//! }
//! assert!(machine.lean() < 0.1);
//! # Ok::<(), acrobot::control::ControlError>(())
//! ```
#![no_std]
#![forbid(unsafe_code)]

mod controller;
mod machine;
mod replanner;

pub use controller::{Controller, Settings};
pub use machine::Machine;
pub use replanner::Replanner;
