//! What is to be planned.

use super::cost::Cost;
use crate::error::Error;
use crate::physics::{Modeled, Params, State};

/// A machine, where it is to go, and what the way there costs.
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
    /// Those of [`Cost::new`].
    pub fn swing_up(params: Params<S>, limit: S) -> Result<Self, Error> {
        let cost = Cost::new(&params, limit)?;
        Ok(Self { params, limit, target: State::UPRIGHT, torque: S::ZERO, cost })
    }

    /// To balance with a bent elbow: θ2, rad. The centre of mass is above the fixed joint, and the
    /// motor holds link 2. The height of the cost is that of the tip.
    ///
    /// ```
    /// use acrobot::Params;
    /// use acrobot::control::plan::Problem;
    ///
    /// let problem = Problem::balance(Params::<f64>::DEFAULT, 10.0, 1.0)?;
    /// assert!((problem.target.theta1 - 2.899).abs() < 1e-3); // rad
    /// assert!((problem.torque + 3.363).abs() < 1e-3); // N m
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`Cost::new`], and the angle is not finite.
    pub fn balance(params: Params<S>, limit: S, elbow: S) -> Result<Self, Error> {
        let problem = Self::swing_up(params, limit)?;
        State { theta2: elbow, ..State::HANGING }.validate()?;
        let Params { mass1, mass2, length1, length2, gravity, .. } = params.cast::<f64>();
        let Params { center_of_mass1, center_of_mass2, .. } = params.cast::<f64>();
        let elbow = elbow.to_f64();
        let [moment1, moment2] =
            [mass1 * center_of_mass1 + mass2 * length1, mass2 * center_of_mass2];
        let (sin, cos) = (libm::sin(elbow), libm::cos(elbow));
        let theta1 = libm::atan2(moment2 * sin, -(moment1 + moment2 * cos));
        let torque = moment2 * gravity * libm::sin(theta1 + elbow);
        let height = -length1 * libm::cos(theta1) - length2 * libm::cos(theta1 + elbow);
        let [theta1, torque, height] = [theta1, torque, height].map(S::from_f64);
        Ok(Self {
            target: State { theta1, theta2: S::from_f64(elbow), ..State::HANGING },
            torque,
            cost: Cost { height, ..problem.cost },
            ..problem
        })
    }
}
