//! The regulator of an equilibrium with a bounded torque, and from which states it holds.

use core::f64::consts::{FRAC_PI_2, PI};
use core::mem::replace;

use super::equilibrium::check_equilibrium;
use super::feedback::Feedback;
use super::region::{Design, Region};
use crate::arithmetic::Arithmetic;
use crate::control::units::Units;
use crate::error::{Error, Range};
use crate::math::Real;
use crate::math::matrix::Matrix;
use crate::math::sealed::Sealed as _;
use crate::physics::{Params, Pendulum, State, plus_scaled, saturate};

/// The regulator has failed beyond these deviations of θ1 and θ2, rad.
const WIDE: [f64; 2] = [FRAC_PI_2, 3.1];
/// The linear model holds for this deviation of θ1, rad, and at rest with dry friction for this
/// part of the velocity from which on friction is constant.
const LINEAR: f64 = 0.3;
const SLOW: f64 = 0.5;
/// The regulator has failed if it has not recovered within the first time. It has recovered when it
/// has stayed in the region for the second one. Dry friction can keep the machine moving for ever,
/// so it has to stay for longer then. Units of the machine.
const TIMES: [f64; 2] = [12.0, 3.0];
const TIMES_DRY: [f64; 2] = [40.0, 20.0];
/// Rounding acts as dry friction does. If the velocities that it loses are more than this part of
/// the region, the regulator does not hold.
const ROUGH: f64 = 1.0;
const ROUGH_DRY: f64 = 0.1;
/// A simulation takes so many steps in a unit of time that the regulator changes its torque by at
/// most the part `CHANGE` in a step, but no fewer and no more than these. They are whole steps of
/// the machine, so there may be twice as many, and fewer if the machine takes fewer.
const FINE: [f64; 2] = [50.0, 1000.0];
const CHANGE: f64 = 0.1;
/// Where these are longer than the machine's, it begins so much farther from the target, because
/// the border of what the regulator holds moves with the steps.
const FARTHER: f64 = 1.02;

/// A linear-quadratic regulator whose torque is bounded, and which knows from which states it
/// holds: its region of attraction.
///
/// ```
/// use acrobot::control::regulator::BoundedRegulator;
/// use acrobot::{Params, Portable, State};
///
/// let params = Params { dt: 0.02, ..Params::DEFAULT };
/// let regulator = BoundedRegulator::<Portable>::new(params, 10.0)?; // N m
/// let leaning = |rad| State { theta1: std::f64::consts::PI - rad, ..State::UPRIGHT };
/// assert!(regulator.holds_from(leaning(0.05)) && !regulator.holds_from(leaning(0.5)));
/// assert_eq!(regulator.torque(leaning(0.05)), -10.0); // N m, its largest
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct BoundedRegulator<A: Arithmetic> {
    /// The machine, without bounds of velocities, in any state.
    pub(in crate::control) machine: Pendulum<A>,
    /// Velocities that may not be reached, rad/s.
    pub(in crate::control) bounds: [A::Scalar; 2],
    pub(in crate::control) feedback: Feedback<A::Scalar>,
    /// The largest torque, N m.
    pub(in crate::control) limit: A::Scalar,
    /// The weights of each deviation and of the torque.
    pub(in crate::control) weights: ([A::Scalar; 4], A::Scalar),
    /// What a deviation at the end of a plan costs: xᵀ P x, which grows slowly from `near` on.
    pub(in crate::control) cost_to_go: Matrix<A::Scalar>,
    pub(in crate::control) near: A::Scalar,
    /// How much farther from the target a simulation begins, its `dt`, s, its most steps, and those
    /// in the region.
    farther: A::Scalar,
    dt: A::Scalar,
    steps: [u32; 2],
}

impl<A: Arithmetic> BoundedRegulator<A> {
    /// The regulator that holds a machine upright, with these parameters, whose `dt` is the time
    /// between two decisions, and a largest torque, N m.
    ///
    /// # Errors
    ///
    /// A parameter is out of range, the torque is not finite and above 0, there is no regulator, or
    /// `dt` is so short that the scalar loses small velocities upright.
    pub fn new(params: Params<A::Scalar>, limit: A::Scalar) -> Result<Self, Error> {
        Self::about(params, limit, State::UPRIGHT, A::Scalar::ZERO)
    }

    /// As [`new`](Self::new), for another equilibrium and the torque that holds it, N m.
    ///
    /// ```
    /// # use acrobot::control::regulator::BoundedRegulator;
    /// # use acrobot::{Params, Portable, State};
    /// let params = Params { dt: 0.02, ..Params::DEFAULT };
    /// let brake = BoundedRegulator::<Portable>::about(params, 10.0, State::HANGING, 0.0)?; // N m
    /// assert!(brake.holds_from(State { theta1: 0.3, ..State::HANGING })); // rad
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The errors of `new`, [`Error::NotInEquilibrium`], and the torque is not below the largest.
    #[inline(never)] // saves flash
    pub fn about(
        mut params: Params<A::Scalar>,
        limit: A::Scalar,
        target: State<A::Scalar>,
        torque: A::Scalar,
    ) -> Result<Self, Error> {
        Range::AboveZero.check("the largest torque", limit.to_f64(), "N m")?;
        let infinity = A::Scalar::from_f64(f64::INFINITY);
        params.validate()?;
        let bounds = [&mut params.max_velocity1, &mut params.max_velocity2];
        let bounds = bounds.map(|bound| replace(bound, infinity));
        let machine = Pendulum::<A>::new(params, target)?;
        let spare = limit - torque.abs();
        Range::AboveZero.check("the largest torque minus the target's", spare.to_f64(), "N m")?;
        check_equilibrium(&machine, torque)?;
        let units = Units::new(&params, spare);
        let none = A::Scalar::ZERO;
        let is_dry = [params.coulomb1, params.coulomb2] != [none; 2];
        (params.coulomb1, params.coulomb2) = (none, none);
        let free = Pendulum::<A>::new(params, target)?;
        let far = f64::INFINITY;
        let design =
            Design::new(&free.linearize_free_step(torque)?, units, [LINEAR, far, far, far])?;
        if design.roughness(PI, params.dt) > if is_dry { ROUGH_DRY } else { ROUGH } {
            let rule = "longer for this scalar, which loses small velocities upright, in";
            let value = params.dt.to_f64();
            return Err(Error::OutOfRange { name: "dt", value, unit: "s", rule });
        }
        let rate = units.time / params.dt.to_f64();
        let [least, most] = FINE;
        let fine = (design.change * rate / CHANGE).max(least).min(most);
        let own = (rate / fine) as u32;
        let dt = params.dt * A::Scalar::from_f64(f64::from(own.max(1)));
        let times = if is_dry { TIMES_DRY } else { TIMES };
        let (moving, reach) = (design.region(), A::Scalar::ZERO);
        let mut regulator = Self {
            machine,
            bounds,
            feedback: Feedback { target, torque, moving, resting: Region::NONE, reach },
            limit,
            weights: design.weights(),
            cost_to_go: design.cost_to_go(),
            near: A::Scalar::from_f64(design.safe * design.safe),
            farther: if own > 1 { A::Scalar::from_f64(FARTHER) } else { A::Scalar::ONE },
            dt,
            steps: times.map(|time| (time * units.time / dt.to_f64()) as u32),
        };
        if A::HAS_FRICTION && is_dry {
            regulator.rest(units);
        }
        Ok(regulator)
    }

    /// Adds the gain for a machine at rest, if there is one.
    #[inline(never)]
    fn rest(&mut self, units: Units) {
        let Feedback { target, torque, moving, .. } = self.feedback;
        let Ok(model) = self.machine.linearize_free_step(torque) else { return };
        let width = self.machine.model().constants.inverse_width.to_f64();
        let slow = SLOW * units.time / width;
        let Ok(design) = Design::new(&model, units, [LINEAR, f64::INFINITY, slow, slow]) else {
            return;
        };
        self.feedback.resting = design.region();
        self.feedback.reach = A::Scalar::ONE;
        // In motion friction keeps the other regulator moving. If that takes it too far away, this
        // one also brakes, as far as its torque lasts.
        let theta1 = target.theta1 + A::Scalar::HALF * moving.lean();
        let infinity = A::Scalar::from_f64(f64::INFINITY);
        if !self.succeeds(State { theta1, ..target }, [infinity; 2]) {
            let part = design.widest / design.safe;
            self.feedback.reach = A::Scalar::from_f64(part * part);
            self.cost_to_go = design.cost_to_go();
            self.near = A::Scalar::from_f64(design.widest * design.widest);
        }
    }

    /// The regulator of a simulation that clamps velocities at the bounds of its parameters, as
    /// Gymnasium's does: reaching one is no failure.
    ///
    /// ```
    /// # use acrobot::control::regulator::BoundedRegulator;
    /// # use acrobot::{Params, Portable, State};
    /// let params = Params { dt: 0.02, max_velocity2: 0.5, ..Params::DEFAULT }; // rad/s
    /// let regulator = BoundedRegulator::<Portable>::new(params, 10.0)?; // N m
    /// let leaning = State { theta1: 3.1, ..State::UPRIGHT }; // rad
    /// assert!(!regulator.holds_from(leaning)); // link 2 would turn faster
    /// assert!(regulator.with_velocity_clamp().holds_from(leaning));
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    #[must_use]
    pub fn with_velocity_clamp(mut self) -> Self {
        let infinity = A::Scalar::from_f64(f64::INFINITY);
        let [bound1, bound2] = replace(&mut self.bounds, [infinity; 2]);
        let mut params = *self.machine.params();
        // The second time there are no bounds to take over.
        let least = |x, y| if x < y { x } else { y };
        params.max_velocity1 = least(params.max_velocity1, bound1);
        params.max_velocity2 = least(params.max_velocity2, bound2);
        self.machine = Pendulum::new_unchecked(params, self.feedback.target);
        self
    }

    /// The regulator as plain data.
    #[must_use]
    pub fn feedback(&self) -> &Feedback<A::Scalar> {
        &self.feedback
    }

    /// The torque at a state, N m, at most the largest. From an extreme state it can be NaN.
    #[must_use]
    pub fn torque(&self, state: State<A::Scalar>) -> A::Scalar {
        saturate(self.feedback.torque(state), self.limit)
    }

    /// Whether the regulator takes the machine from a state to the target, without a velocity at
    /// its bound. It simulates the machine. With dry friction the machine may keep moving about the
    /// target.
    #[must_use]
    pub fn holds_from(&self, state: State<A::Scalar>) -> bool {
        self.succeeds(state, self.bounds)
    }

    /// A plan can end in the region where the linear model does not hold, and leave it. So a
    /// simulation has to stay there for some time.
    #[inline(never)] // saves flash
    fn succeeds(&self, state: State<A::Scalar>, bounds: [A::Scalar; 2]) -> bool {
        let params = Params { dt: self.dt, ..*self.machine.params() };
        let Self { feedback, limit, .. } = self;
        let start = plus_scaled(feedback.target.into(), self.farther, feedback.deviation(state));
        let Ok(mut model) = Pendulum::<A>::new(params, start.into()) else { return false };
        let ([longest, enough], mut inside) = (self.steps, 0);
        for _ in 0..longest {
            let x = feedback.deviation(model.state());
            if !(is_near(x) && is_below(model.state(), bounds)) {
                return false;
            }
            let rests =
                feedback.reach > A::Scalar::ZERO && feedback.resting.square(x) < A::Scalar::ONE;
            let is_inside = rests || feedback.moving.square(x) < A::Scalar::ONE;
            inside = if is_inside { inside + 1 } else { 0 };
            if inside > enough {
                return true;
            }
            if step(&mut model, saturate(feedback.torque_of(x), *limit)).is_err() {
                return false;
            }
        }
        false
    }
}

/// Whether the regulator has not failed.
pub(in crate::control) fn is_near<S: Real>([theta1, theta2, ..]: [S; 4]) -> bool {
    let [most1, most2] = WIDE;
    theta1.to_f64().abs() < most1 && theta2.to_f64().abs() < most2
}

/// Whether both velocities are below their bounds.
pub(in crate::control) fn is_below<S: Real>(state: State<S>, [bound1, bound2]: [S; 2]) -> bool {
    state.dtheta1.abs() < bound1 && state.dtheta2.abs() < bound2
}

/// A step out of line, which saves flash.
#[inline(never)]
pub(in crate::control) fn step<A: Arithmetic>(
    machine: &mut Pendulum<A>,
    torque: A::Scalar,
) -> Result<(), Error> {
    machine.step(torque)
}
