//! The knots of a plan, and why there is none.

use core::fmt;

use super::deviation::difference;
use super::error::ControlError;
use super::matrix::dot;
use crate::math::{Numbers, Real};
use crate::physics::State;

/// A step of a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)] // for bindings/c
pub struct Knot<S> {
    /// The state before the step.
    pub state: State<S>,
    /// The torque, N m.
    pub torque: S,
    /// What to add to the torque for each deviation from the state, N m per rad and per rad/s: the
    /// gain of a linear-quadratic regulator along the plan.
    pub gain: [S; 4],
    /// What the last iteration adds to the torque, N m, and what it adds for each N m that the
    /// torque before was changed.
    pub(super) change: S,
    pub(super) smooth: S,
}

impl<S: Real> Knot<S> {
    /// A knot without a torque: for the memory of plans.
    pub const EMPTY: Self = Self::open(S::ZERO);

    /// A knot with a torque, N m, and no feedback: for plans to
    /// [improve](super::Planner::improve).
    #[must_use]
    pub const fn open(torque: S) -> Self {
        Self { state: State::HANGING, torque, gain: [S::ZERO; 4], change: S::ZERO, smooth: S::ZERO }
    }

    /// The torque that follows the plan from a measured state, N m.
    /// [`saturate`](crate::physics::saturate) limits it to that of a motor, which needs more torque
    /// than the plan to correct deviations. From an extreme state it can be infinite or NaN.
    #[must_use]
    pub fn follow(&self, state: State<S>) -> S {
        self.torque + dot(self.gain, difference(state, self.state))
    }
}

impl<V> Knot<V> {
    /// Lane `i` of many.
    #[inline(always)]
    pub(super) fn lane<S: Real>(&self, i: usize) -> Knot<S>
    where
        V: Numbers<S>,
    {
        let State { theta1, theta2, dtheta1, dtheta2 } = &self.state;
        let [k1, k2, k3, k4] = &self.gain;
        Knot {
            state: State::from([theta1.lane(i), theta2.lane(i), dtheta1.lane(i), dtheta2.lane(i)]),
            torque: self.torque.lane(i),
            gain: [k1.lane(i), k2.lane(i), k3.lane(i), k4.lane(i)],
            change: self.change.lane(i),
            smooth: self.smooth.lane(i),
        }
    }

    /// Sets lane `i` of many.
    #[inline(always)]
    pub(super) fn set_lane<S: Real>(&mut self, i: usize, knot: Knot<S>)
    where
        V: Numbers<S>,
    {
        self.state.theta1.set_lane(i, knot.state.theta1);
        self.state.theta2.set_lane(i, knot.state.theta2);
        self.state.dtheta1.set_lane(i, knot.state.dtheta1);
        self.state.dtheta2.set_lane(i, knot.state.dtheta2);
        self.torque.set_lane(i, knot.torque);
        let [k1, k2, k3, k4] = &mut self.gain;
        k1.set_lane(i, knot.gain[0]);
        k2.set_lane(i, knot.gain[1]);
        k3.set_lane(i, knot.gain[2]);
        k4.set_lane(i, knot.gain[3]);
        self.change.set_lane(i, knot.change);
        self.smooth.set_lane(i, knot.smooth);
    }
}

/// Why there is no plan.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
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
