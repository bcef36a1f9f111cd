//! The regulator of the upright position with a bounded torque, and from which states it recovers.
//!
//! With dry friction there are two regulators. At rest dry friction acts like strong viscous
//! friction, in motion hardly at all, and the gains for both have opposite signs.

use core::f64::consts::{FRAC_PI_2, PI};

use super::deviation::difference;
use super::error::ControlError;
use super::linearize_step::linearize_step;
use super::matrix::{Matrix, dot};
use super::region::{Design, Region};
use super::units::Units;
use crate::arithmetic::Arithmetic;
use crate::error::{Error, Range};
use crate::math::Real;
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
/// Where these are longer than the machine's, it begins so much farther from upright, because the
/// border of what the regulator holds moves with the steps.
const FARTHER: f64 = 1.02;

/// A regulator whose torque is bounded.
#[derive(Clone, Debug)]
pub(super) struct Recovery<S> {
    /// What a deviation at the end of a plan costs: xᵀ P x, which grows slowly from `near` on.
    pub(super) cost_to_go: Matrix<S>,
    near: S,
    /// The largest torque, N m.
    pub(super) limit: S,
    /// The weights of each deviation and of the torque.
    pub(super) weights: ([S; 4], S),
    moving: Region<S>,
    resting: Option<Region<S>>,
    /// The gain at rest is used where |F x|² of its region is below this.
    reach: S,
    /// How much farther from upright a simulation begins, its `dt`, s, its most steps, and those in
    /// the region.
    farther: S,
    dt: S,
    steps: [u32; 2],
}

impl<S: Real> Recovery<S> {
    /// See [`Planner::new`](super::planner::Planner::new).
    pub(super) fn new<A: Arithmetic<Scalar = S>>(
        mut params: Params<S>,
        limit: S,
    ) -> Result<Self, ControlError> {
        Range::AboveZero.check("the largest torque", limit.to_f64(), "N m")?;
        let machine = Pendulum::<A>::new(params, State::UPRIGHT)?;
        let units = Units::new(&params, limit);
        let is_dry = [params.coulomb1, params.coulomb2] != [S::ZERO; 2];
        (params.coulomb1, params.coulomb2) = (S::ZERO, S::ZERO);
        let free = Pendulum::<A>::new(params, State::UPRIGHT)?;
        let far = f64::INFINITY;
        let design = Design::new(&linearize_step(&free, S::ZERO)?, units, [LINEAR, far, far, far])?;
        if design.roughness(PI, params.dt) > if is_dry { ROUGH_DRY } else { ROUGH } {
            let rule = "longer for this scalar, which loses small velocities upright, in";
            let value = params.dt.to_f64();
            return Err(Error::OutOfRange { name: "dt", value, unit: "s", rule }.into());
        }
        let rate = units.time / params.dt.to_f64();
        let [least, most] = FINE;
        let fine = (design.change * rate / CHANGE).max(least).min(most);
        let own = (rate / fine) as u32;
        let dt = params.dt * S::from_f64(f64::from(own.max(1)));
        let times = if is_dry { TIMES_DRY } else { TIMES };
        let mut recovery = Self {
            cost_to_go: design.cost_to_go(),
            near: S::from_f64(design.safe * design.safe),
            limit,
            weights: design.weights(),
            moving: design.region(),
            resting: None,
            reach: S::ONE,
            farther: if own > 1 { S::from_f64(FARTHER) } else { S::ONE },
            dt,
            steps: times.map(|time| (time * units.time / dt.to_f64()) as u32),
        };
        if A::HAS_FRICTION && is_dry {
            recovery.rest(&machine, units);
        }
        Ok(recovery)
    }

    /// Adds the regulator for a machine at rest, if there is one.
    #[inline(never)]
    fn rest<A: Arithmetic<Scalar = S>>(&mut self, machine: &Pendulum<A>, units: Units) {
        let Ok(model) = linearize_step(machine, S::ZERO) else { return };
        let slow = SLOW * units.time / machine.model().constants.inverse_width.to_f64();
        let Ok(design) = Design::new(&model, units, [LINEAR, f64::INFINITY, slow, slow]) else {
            return;
        };
        self.resting = Some(design.region());
        // In motion friction keeps the other regulator moving. If that takes it too far away, this
        // one also brakes, as far as its torque lasts.
        let theta1 = State::<S>::UPRIGHT.theta1 + S::HALF * self.moving.lean();
        let infinity = S::from_f64(f64::INFINITY);
        let leaning = State { theta1, ..State::UPRIGHT };
        if !self.succeeds::<A>(machine.params(), leaning, [infinity; 2]) {
            let part = design.widest / design.safe;
            self.reach = S::from_f64(part * part);
            self.cost_to_go = design.cost_to_go();
            self.near = S::from_f64(design.widest * design.widest);
        }
    }

    /// Whether the regulator of a machine succeeds from a state, without a velocity at its bound.
    ///
    /// A plan can end in the region where the linear model does not hold, and leave it. So a
    /// simulation has to stay there for some time.
    #[inline(never)] // saves flash
    pub(super) fn succeeds<A: Arithmetic<Scalar = S>>(
        &self,
        params: &Params<S>,
        state: State<S>,
        bounds: [S; 2],
    ) -> bool {
        let params = Params { dt: self.dt, ..*params };
        let upright = State::UPRIGHT.into();
        let start = plus_scaled(upright, self.farther, deviation(state));
        let Ok(mut model) = Pendulum::<A>::new(params, start.into()) else { return false };
        let ([longest, enough], mut inside) = (self.steps, 0);
        for _ in 0..longest {
            let x = deviation(model.state());
            if !(is_near(x) && is_below(model.state(), bounds)) {
                return false;
            }
            let rests = self.resting.as_ref().is_some_and(|region| region.square(x) < S::ONE);
            inside = if rests || self.moving.square(x) < S::ONE { inside + 1 } else { 0 };
            if inside > enough {
                return true;
            }
            if model.step(saturate(self.torque(x), self.limit)).is_err() {
                return false;
            }
        }
        false
    }

    /// The torque for a deviation, N m, which can be beyond the largest.
    #[inline(never)]
    pub(super) fn torque(&self, x: [S; 4]) -> S {
        match &self.resting {
            Some(region) if region.square(x) < self.reach => region.torque(x),
            _ => self.moving.torque(x),
        }
    }

    /// What the state after a plan costs, with a weight.
    pub(super) fn arrival(&self, weight: S, end: [S; 4]) -> S {
        let x = deviation(end.into());
        let excess = dot(self.apply(x), x) / self.near;
        weight * S::from_f64(libm::log1p(excess.to_f64()))
    }

    /// The slopes of [`arrival`](Self::arrival), the upper triangle of its curvature, and zeros for
    /// the torque before. Where the logarithm is concave, the curvature is that without it.
    #[inline(never)]
    pub(super) fn arrival_slopes(&self, weight: S, end: [S; 4]) -> [S; 20] {
        let x = deviation(end.into());
        let [s1, s2, s3, s4] = self.apply(x);
        let weight = (weight + weight) / (dot([s1, s2, s3, s4], x) + self.near);
        let [p1, p2, p3, p4] = self.cost_to_go;
        let ([_, p22, p23, p24], [_, _, p33, p34], [.., p44], o) = (p2, p3, p4, S::ZERO);
        let [p11, p12, p13, p14] = p1;
        let slopes =
            [s1, s2, s3, s4, p11, p12, p13, p14, p22, p23, p24, p33, p34, p44, o, o, o, o, o, o];
        slopes.map(|x| x * weight)
    }

    /// P x.
    #[inline(always)]
    fn apply(&self, x: [S; 4]) -> [S; 4] {
        self.cost_to_go.map(|row| dot(row, x))
    }
}

/// The deviation from upright.
#[inline(never)] // saves flash
fn deviation<S: Real>(state: State<S>) -> [S; 4] {
    difference(state, State::UPRIGHT)
}

/// Whether the regulator has not failed.
pub(super) fn is_near<S: Real>([theta1, theta2, ..]: [S; 4]) -> bool {
    let [most1, most2] = WIDE;
    theta1.to_f64().abs() < most1 && theta2.to_f64().abs() < most2
}

/// Whether both velocities are below their bounds.
pub(super) fn is_below<S: Real>(state: State<S>, [bound1, bound2]: [S; 2]) -> bool {
    state.dtheta1.abs() < bound1 && state.dtheta2.abs() < bound2
}
