//! Motions to an equilibrium: by a plan, or without one.
//!
//! A [`Problem`] has a machine, a target and a [`Cost`]. A [`Planner`] solves it. A [`Plan`] is
//! plain data, which needs no planner to be followed. [`SwingUp`] gets upright without a plan.

mod cost;
mod guess;
mod knots;
mod passes;
mod planner;
mod problem;
#[cfg(feature = "alloc")]
mod side_by_side;
mod swing_up;
mod tries;

pub use cost::Cost;
pub use knots::{Knot, Plan};
pub use planner::Planner;
pub use problem::Problem;
pub use swing_up::SwingUp;
