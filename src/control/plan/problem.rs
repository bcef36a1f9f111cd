//! What is to be planned.

use super::cost::Cost;
use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::physics::{Modeled, Params, Pendulum, State, directions};

/// A machine, where it is to go, and what the way there costs.
///
/// ```
/// use acrobot::control::plan::{Planner, Problem};
/// use acrobot::{Fast, Params, State};
///
/// let problem = Problem::swing_up(Params { dt: 0.02, ..Params::DEFAULT }, 5.0)?; // N m
/// assert_eq!(problem.target, State::UPRIGHT);
/// let brake = Problem { target: State::HANGING, ..problem };
/// assert!(Planner::<Fast>::new(&brake)?.regulator().holds_from(State::HANGING));
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Problem<S = f64> {
    /// The parameters of the machine, whose `dt` is the time between two decisions.
    pub params: Params<S>,
    /// The largest torque, N m; above 0.
    pub limit: S,
    /// The equilibrium in which a plan ends.
    pub target: State<S>,
    /// The torque that holds it, N m.
    pub torque: S,
    /// What a plan costs.
    pub cost: Cost<S>,
}

impl<S: Modeled> Problem<S> {
    /// To stand upright, with [weights](Cost::new) with which most tries succeed.
    ///
    /// # Errors
    ///
    /// The errors of [`Cost::new`].
    pub fn swing_up(params: Params<S>, limit: S) -> Result<Self, Error> {
        let cost = Cost::new(&params, limit)?;
        Ok(Self { params, limit, target: State::UPRIGHT, torque: S::ZERO, cost })
    }

    /// To balance with a bent elbow: θ2, rad. The centre of mass is above the fixed joint, and the
    /// motor holds link 2. The height of the cost is that of the tip. `A` computes the sines.
    ///
    /// ```
    /// use acrobot::control::plan::Problem;
    /// use acrobot::{Params, Portable};
    ///
    /// let problem = Problem::balance::<Portable>(Params::DEFAULT, 10.0, 1.0)?;
    /// assert!((problem.target.theta1 - 2.908).abs() < 1e-3); // rad
    /// assert!((problem.torque + 3.399).abs() < 1e-3); // N m
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The errors of [`Cost::new`] and [`Pendulum::new`], and the angle is not finite.
    #[inline(never)] // saves flash
    pub fn balance<A: Arithmetic<Scalar = S>>(
        params: Params<S>,
        limit: S,
        elbow: S,
    ) -> Result<Self, Error> {
        let mut problem = Self::swing_up(params, limit)?;
        problem.target.theta2 = elbow;
        let mut pendulum = Pendulum::<A>::new(params, problem.target)?;
        let [moment1, moment2] = S::moments(&params);
        let [_, (sin, cos)] = pendulum.sin_cos();
        // The centre of mass relative to link 1: along it, and across.
        let (along, across) = (moment1 + moment2 * cos, moment2 * sin);
        let distance = S::sqrt(along * along + across * across);
        if along < S::ZERO {
            problem.target.theta1 = S::ZERO;
        }
        // An angle x of the centre of mass from upright becomes x − sin x: no more than rounding.
        for _ in 0..6 {
            pendulum.set_state(problem.target)?;
            let [(sin1, _), (sin_sum, _)] = directions(pendulum.sin_cos());
            let lever = moment1 * sin1 + moment2 * sin_sum;
            problem.target.theta1 = problem.target.theta1 + lever / distance;
        }
        pendulum.set_state(problem.target)?;
        problem.cost.height = pendulum.tip_height();
        problem.torque = -(params.gravity * moment2 * moment1 * sin / distance);
        Ok(problem)
    }
}
