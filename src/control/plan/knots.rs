//! A plan and its knots, as plain data.

use crate::control::regulator::Feedback;
use crate::math::matrix::dot;
use crate::math::{Numbers, Real};
use crate::physics::State;

/// A plan: its knots, one for each step, and the feedback that holds its target after them. `K` is
/// an array, a slice or a `Vec` of [`Knot`]s. It is plain data, so a `const` can be one, and what
/// follows it needs no planner: [an example](crate::guide::control#a-plan-in-firmware).
///
/// ```
/// use acrobot::control::plan::{Knot, Plan};
/// use acrobot::control::regulator::BoundedRegulator;
/// use acrobot::{Fast, Params, State};
///
/// let after = *BoundedRegulator::<Fast>::new(Params::DEFAULT, 10.0)?.feedback();
/// let plan = Plan { knots: [Knot::open(1.0), Knot::open(-2.0)], after };
/// assert_eq!(plan.torque(1, State::HANGING), -2.0); // N m, of a knot
/// assert_eq!(plan.torque(2, State::UPRIGHT), 0.0); // holds
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Plan<S, K> {
    /// The steps.
    pub knots: K,
    /// What holds the target after the last step.
    pub after: Feedback<S>,
}

impl<S: Real, K: AsRef<[Knot<S>]>> Plan<S, K> {
    /// The torque that follows the plan from a measured state, N m: in step `step`, counted from 0,
    /// or after the plan. [`saturate`](crate::physics::saturate) limits it to that of a motor,
    /// which needs more torque than the plan to correct deviations. From an extreme state it can be
    /// infinite or NaN.
    #[must_use]
    pub fn torque(&self, step: usize, state: State<S>) -> S {
        match self.knots.as_ref().get(step) {
            Some(knot) => knot.follow(state),
            None => self.after.torque(state),
        }
    }
}

/// A step of a plan.
///
/// ```
/// use acrobot::{State, control::plan::Knot};
///
/// let knot = Knot::new([0.0; 4], 1.0, [-10.0, 0.0, 0.0, 0.0]); // N m, and N m per rad
/// assert_eq!(knot.follow(State::HANGING), 1.0); // N m
/// assert_eq!(knot.follow(State { theta1: 0.25, ..State::HANGING }), 3.5);
/// assert_eq!(Knot::open(1.0).follow(State::UPRIGHT), 1.0); // without feedback
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)] // for bindings/abi
pub struct Knot<S> {
    /// The state before the step.
    pub state: State<S>,
    /// The torque, N m.
    pub torque: S,
    /// K in u = torque − K x for the deviation x from the state, N m per rad and per rad/s: the
    /// gain of a linear-quadratic regulator along the plan.
    pub gain: [S; 4],
    /// What the last iteration adds to the torque, N m, and what it adds for each N m that the
    /// torque before was changed.
    pub(in crate::control) change: S,
    pub(in crate::control) smooth: S,
}

impl<S: Real> Knot<S> {
    /// A knot without a torque: for the memory of plans.
    pub const EMPTY: Self = Self::open(S::ZERO);

    /// A knot of a plan that is written down: a state, a torque, N m, and a gain.
    #[must_use]
    pub const fn new(state: [S; 4], torque: S, gain: [S; 4]) -> Self {
        let [theta1, theta2, dtheta1, dtheta2] = state;
        let state = State { theta1, theta2, dtheta1, dtheta2 };
        Self { state, gain, ..Self::open(torque) }
    }

    /// A knot with a torque, N m, and no feedback: for plans to
    /// [improve](super::Planner::improve).
    #[must_use]
    pub const fn open(torque: S) -> Self {
        Self { state: State::HANGING, torque, gain: [S::ZERO; 4], change: S::ZERO, smooth: S::ZERO }
    }

    /// The torque that follows the plan from a measured state, N m: see [`Plan::torque`].
    #[must_use]
    pub fn follow(&self, state: State<S>) -> S {
        self.torque - dot(self.gain, state.deviation_from(self.state))
    }
}

impl<V> Knot<V> {
    /// Lane `i` of many.
    #[inline(always)]
    pub(in crate::control) fn lane<S: Real>(&self, i: usize) -> Knot<S>
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
    pub(in crate::control) fn set_lane<S: Real>(&mut self, i: usize, knot: Knot<S>)
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
