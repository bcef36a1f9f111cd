//! What a controller needs of the model: linearization, inverse dynamics, velocities and a linear-quadratic regulator.
//!
//! No function needs a heap or panics. A result is finite, or a [`ControlError`] that names what overflows with extreme
//! parameters. All functions work in `f32` and `f64`, and with both [`Dynamics`](super::Dynamics).
//!
//! | function | result |
//! |---|---|
//! | [`linearize`] | A and B of ẋ = A x + B u, at any state and torque |
//! | [`discretize`] | A and B of one step of `dt`, as the pendulum takes it |
//! | [`lqr`] | the gain of the linear-quadratic regulator for such a step |
//! | [`inverse_dynamics`] | torques and joint forces that given accelerations need |
//! | [`velocities`] | velocities of elbow and tip; [`Pendulum::positions`](super::Pendulum::positions) has the positions |
//! | [`Pendulum::deviation`](super::Pendulum::deviation), [`difference`] | the state's deviation from a target, across ±π |
//!
//! The guide holds the acrobot upright with [a regulator](crate::guide::control).

mod discretize;
mod error;
mod inverse_dynamics;
mod linearize;
mod lqr;
mod matrix;

pub use discretize::{DiscreteModel, discretize};
pub use error::ControlError;
pub use inverse_dynamics::{Forces, inverse_dynamics, velocities};
pub use linearize::{ContinuousModel, linearize};
pub use lqr::{Lqr, difference, lqr};
