//! What is to be planned.

use super::cost::Cost;
use crate::error::{Error, Range};
use crate::physics::{Modeled, Params, State};

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
        Ok(Self { params, limit, target: State::UPRIGHT, torque: S::from_f64(0.0), cost })
    }

    /// To balance with a bent elbow: θ2, rad. The centre of mass is above the fixed joint, and the
    /// motor holds link 2. The height of the cost is that of the tip.
    ///
    /// ```
    /// use acrobot::Params;
    /// use acrobot::control::plan::Problem;
    ///
    /// let problem = Problem::balance(Params::<f64>::DEFAULT, 10.0, 1.0)?;
    /// assert!((problem.target.theta1 - 2.908).abs() < 1e-3); // rad
    /// assert!((problem.torque + 3.399).abs() < 1e-3); // N m
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The errors of [`Cost::new`], and the angle is not finite.
    #[inline(never)] // saves flash
    pub fn balance(params: Params<S>, limit: S, elbow: S) -> Result<Self, Error> {
        let mut cost = Cost::new(&params, limit)?;
        Range::Finite.check("elbow", elbow.to_f64(), "rad")?;
        let wide: Params<f64> = params.cast();
        let [moment1, moment2] = wide.moments();
        let (sin, cos) = (libm::sin(elbow.to_f64()), libm::cos(elbow.to_f64()));
        // The centre of mass relative to link 1: along it, and across.
        let (along, across) = (moment1 + moment2 * cos, moment2 * sin);
        let distance = libm::hypot(along, across);
        let (cos1, cos_sum) = (-along / distance, -(moment1 * cos + moment2) / distance);
        cost.height = S::from_f64(-wide.length1 * cos1 - wide.length2 * cos_sum);
        let target = State {
            theta1: S::from_f64(libm::atan2(across, -along)),
            theta2: elbow,
            ..State::HANGING
        };
        let torque = S::from_f64(-wide.gravity * moment2 * moment1 * sin / distance);
        Ok(Self { params, limit, target, torque, cost })
    }
}
