//! Control: a walk from a model to a machine that stands up, a room for each step.
//!
//! 1. [`model`] linearizes a [`Pendulum`](crate::physics::Pendulum), in continuous time or for one
//!    step, and has its inverse dynamics.
//! 2. [`regulator`] holds an equilibrium: linear-quadratic regulators, along a trajectory, too, and
//!    with a bounded torque, which holds from a region of attraction.
//! 3. [`plan`] finds a motion to an equilibrium, such as a swing-up, and the feedback along it.
//! 4. [`estimate`] finds the state of a machine from its angles alone, and its parameters.
//! 5. [`identify`] finds the parameters from recordings.
//! 6. [`mpc`] puts these together: from encoder counts to torques, on a microcontroller.
//!
//! A room uses only those before it. A result is finite, or an [`Error`](crate::Error) that names
//! what overflows with extreme parameters. The [guide](crate::guide::control) has a regulator on a
//! machine, and the costs of a plan.

pub mod estimate;
pub mod identify;
pub mod model;
pub mod mpc;
pub mod plan;
pub mod regulator;
mod units;
