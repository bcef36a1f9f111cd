//! The steps of a plan, and why there is none.

use core::fmt;

use acrobot::arithmetic::Real;
use acrobot::control::{ControlError, difference};
use acrobot::physics::State;

use crate::dot;

/// A step of a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<S> {
    /// The state before the step.
    pub state: State<S>,
    /// The torque, N m.
    pub torque: S,
    /// What to add to the torque for each deviation from the state, N m per rad and per rad/s: that
    /// of a linear-quadratic regulator along the plan.
    pub gain: [S; 4],
    /// What the last iteration adds to the torque, N m.
    pub(crate) change: S,
}

impl<S: Real> Step<S> {
    /// A step without a torque: for the memory of plans.
    pub const EMPTY: Self = Self::open(S::ZERO);

    /// A step with a torque, N m, and no feedback: for plans to [improve](Planner::improve).
    #[must_use]
    pub const fn open(torque: S) -> Self {
        Self { state: State::HANGING, torque, gain: [S::ZERO; 4], change: S::ZERO }
    }

    /// The torque that follows the plan from a measured state, N m. `saturate` limits it to that of
    /// a motor, which needs more torque than the plan to correct deviations. From an extreme state
    /// it can be infinite or NaN.
    #[must_use]
    pub fn follow(&self, state: State<S>) -> S {
        self.torque + dot(self.gain, difference(state, self.state))
    }
}

/// Why there is no plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoPlan {
    /// An argument was rejected.
    Invalid(ControlError),
    /// No try ended in a state from which the regulator holds.
    NotFound {
        /// The tries.
        tries: u32,
    },
}

impl fmt::Display for NoPlan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(error) => error.fmt(f),
            Self::NotFound { tries } => {
                write!(f, "found no plan that ends upright in {tries} tries")
            }
        }
    }
}

impl core::error::Error for NoPlan {}

impl<E: Into<ControlError>> From<E> for NoPlan {
    fn from(error: E) -> Self {
        Self::Invalid(error.into())
    }
}
