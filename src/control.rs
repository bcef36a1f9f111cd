//! Control: linear models, inverse dynamics, linear-quadratic regulators, and plans that swing up.
//!
//! A result is finite, or a [`ControlError`] that names what overflows with extreme parameters. The
//! [guide](crate::guide::control) has a regulator on a machine, and the costs of a plan.

mod cost;
mod deviation;
mod double;
mod error;
mod estimator;
mod evidence;
mod identify;
mod inverse_dynamics;
mod linearize;
mod linearize_step;
mod lqr;
mod matrix;
mod noise;
mod passes;
mod plan;
mod planner;
mod recovery;
mod region;
mod regulator;
mod tries;
mod units;

pub use cost::Cost;
pub use deviation::difference;
pub use error::ControlError;
pub use estimator::Estimator;
pub use evidence::{Evidence, Identified, Sample};
pub use identify::{identify, prediction_error};
pub use inverse_dynamics::{Forces, inverse_dynamics, velocities};
pub use linearize::{LinearModel, linearize};
pub use linearize_step::linearize_step;
pub use lqr::{Lqr, lqr};
pub use noise::Noise;
pub use plan::{Knot, NoPlan};
pub use planner::Planner;
pub use regulator::regulator;
