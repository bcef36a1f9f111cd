//! The regulator of the upright position with a bounded torque, and from which states it recovers.
//!
//! A linear-quadratic regulator of a discrete model stabilizes with the part κ = 1 / (1 + √(R / (R +
//! Bᵀ P B))) of its gain, too: about a half for short steps, and nearly 1 where the torque costs
//! little. So as long as it wants at most 1/κ of the largest torque u, xᵀ P x falls. The largest
//! ellipsoid of such x is xᵀ P x ≤ (u/κ)² / (K P⁻¹ Kᵀ). A simulation that stays in half of it, near
//! enough to upright for the linear model to hold, has recovered.

use core::array;
use core::f64::consts::{FRAC_PI_2, PI, SQRT_2};

use super::deviation::difference;
use super::error::ControlError;
use super::linearize::LinearModel;
use super::linearize_step::linearize_step;
use super::lqr::{Lqr, lqr};
use super::matrix::{dot, identity};
use super::units::Units;
use crate::arithmetic::Arithmetic;
use crate::error::Range;
use crate::math::Real;
use crate::physics::{Joints, Params, Pendulum, State, plus_scaled, saturate};

/// The regulator has failed beyond these deviations of θ1 and θ2, rad.
const WIDE: [f64; 2] = [FRAC_PI_2, 3.1];
/// The linear model holds for this deviation of θ1, rad.
const LINEAR: f64 = 0.3;
/// The weight of the square of the torque, in units of the machine. That of each angle is 1.
const TORQUE: f64 = 1.0;
/// The regulator has failed after this time, and succeeded if it stays inside for that one, in units
/// of the machine. What it does not know can keep the machine moving for ever: dry friction, and the
/// rounding of angles where velocities are lost that are this part of the way out. Then it has to
/// stay for longer.
const LONGEST: f64 = 12.0;
const INSIDE: f64 = 0.75;
const LONGEST_ROUGH: f64 = 40.0;
const INSIDE_ROUGH: f64 = 20.0;
const ROUGH: f64 = 0.003;
/// Dry friction acts as at rest below this part of the velocity from which on it is constant.
const SLOW: f64 = 0.5;
/// The most steps of a simulation.
const MOST: f64 = 1e6;

/// A regulator whose torque is bounded.
#[derive(Clone, Debug)]
pub(super) struct Recovery<S> {
    pub(super) cost_to_go: [[S; 4]; 4],
    /// The largest torque, N m.
    pub(super) limit: S,
    /// The weights of the deviation, on the diagonal, and of the torque, 1/(N m)².
    pub(super) weights: [S; 4],
    pub(super) torque_weight: S,
    /// In motion, and with dry friction at rest.
    moving: Design<S>,
    resting: Option<Design<S>>,
    /// Where |F x| of the design at rest is below this, its gain is used.
    reach: S,
    /// xᵀ P x at the end of a plan, from which on `arrival` grows slowly.
    near: S,
    /// The longest time of a simulation, those inside for both designs, s.
    longest: f64,
    inside: f64,
    at_rest: f64,
    short: (f64, f64),
}

/// A regulator, and F: where |F x| is below 1, it succeeds.
#[derive(Clone, Copy, Debug)]
struct Design<S> {
    gain: [S; 4],
    factor: [[S; 4]; 4],
}

impl<S: Real> Design<S> {
    /// |F x|².
    #[inline(always)]
    fn excess(&self, x: [S; 4]) -> S {
        let y = self.factor.map(|row| dot(row, x));
        dot(y, y)
    }
}

/// A regulator in the units of the machine, and the Cholesky factor of its cost. √(xᵀ P x) of half
/// of the ellipsoid from which its torque lasts, and of that where the linear model holds, too.
struct Exact {
    lqr: Lqr,
    factor: [[f64; 4]; 4],
    widest: f64,
    safe: f64,
}

impl Exact {
    /// For deviations below some in which the linear model holds.
    fn new<S: Real>(
        LinearModel { a, b }: LinearModel<S>,
        Units { time, torque, .. }: Units,
        holds: [f64; 4],
    ) -> Result<Self, ControlError> {
        let [
            [a11, a12, a13, a14],
            [a21, a22, a23, a24],
            [a31, a32, a33, a34],
            [a41, a42, a43, a44],
        ] = a.map(|row| row.map(S::to_f64));
        let [b1, b2, b3, b4] = b.map(S::to_f64);
        // Velocities are `time` times as large.
        let model = LinearModel {
            a: [
                [a11, a12, a13 / time, a14 / time],
                [a21, a22, a23 / time, a24 / time],
                [a31 * time, a32 * time, a33, a34],
                [a41 * time, a42 * time, a43, a44],
            ],
            b: [b1 * torque, b2 * torque, b3 * time * torque, b4 * time * torque],
        };
        let weight = TORQUE;
        // In f64, because the rounding of P to f32 can be larger than its smallest eigenvalue.
        let lqr = lqr(&model, &identity(), weight)?;
        // A regulator also stabilizes with this part of its gain, which can change with each step.
        let p_b = lqr.cost_to_go.map(|row| dot(row, model.b));
        let least = 1.0 / (1.0 + Real::sqrt(weight / (weight + dot(model.b, p_b))));
        let factor = cholesky(lqr.cost_to_go);
        let widest = 1.0 / (SQRT_2 * least * largest(&factor, lqr.gain));
        let mut safe = widest;
        for (unit, most) in identity().into_iter().zip(holds) {
            safe = safe.min(most / largest(&factor, unit));
        }
        Ok(Self { lqr, factor, widest, safe })
    }

    /// Whether velocities that are lost by rounding matter, in units of the machine.
    fn is_rough(&self, lost: f64) -> bool {
        let column = self.factor.map(|[_, _, x, _]| x);
        lost * Real::sqrt(dot(column, column)) > ROUGH * self.safe
    }

    fn cost_to_go<S: Real>(&self, time: f64) -> [[S; 4]; 4] {
        let [p1, p2, p3, p4] = self.lqr.cost_to_go;
        let row = |row, by| from_units(row, by, time);
        [row(p1, 1.0), row(p2, 1.0), row(p3, time), row(p4, time)]
    }

    fn design<S: Real>(&self, Units { time, torque, .. }: Units) -> Design<S> {
        Design {
            gain: from_units(self.lqr.gain, torque, time),
            factor: self.factor.map(|row| from_units(row, 1.0 / self.safe, time)),
        }
    }
}

/// A row in SI units, times a number.
fn from_units<S: Real>([x1, x2, x3, x4]: [f64; 4], by: f64, time: f64) -> [S; 4] {
    [x1 * by, x2 * by, x3 * time * by, x4 * time * by].map(S::from_f64)
}

impl<S: Real> Recovery<S> {
    /// See [`Planner::new`](super::planner::Planner::new).
    pub(super) fn new<A: Arithmetic<Scalar = S>>(
        params: Params<S>,
        limit: S,
    ) -> Result<Self, ControlError> {
        Range::AboveZero.check("the largest torque", limit.to_f64(), "N m")?;
        let machine = Pendulum::<A>::new(params, State::UPRIGHT)?;
        let units = Units::new(&params, limit);
        let Units { time, torque, .. } = units;
        let none = Joints { joint1: S::ZERO, joint2: S::ZERO };
        let free = Params { coulomb: none, ..params };
        let model = linearize_step(&Pendulum::<A>::new(free, State::UPRIGHT)?, S::ZERO)?;
        let most = [LINEAR, f64::INFINITY, f64::INFINITY, f64::INFINITY];
        let exact = Exact::new(model, units, most)?;
        let is_dry = params.coulomb != none;
        // Smaller velocities than this are lost, because upright θ1 is π.
        let lost = S::EPSILON.to_f64() * PI * time / params.dt.to_f64();
        let (longest, inside) = match is_dry || exact.is_rough(lost) {
            true => (LONGEST_ROUGH, INSIDE_ROUGH),
            false => (LONGEST, INSIDE),
        };
        let mut recovery = Self {
            cost_to_go: exact.cost_to_go(time),
            limit,
            weights: [1.0, 1.0, time * time, time * time].map(S::from_f64),
            torque_weight: S::from_f64(TORQUE / (torque * torque)),
            moving: exact.design(units),
            resting: None,
            reach: S::ONE,
            near: S::from_f64(exact.safe * exact.safe),
            longest: longest * time,
            inside: inside * time,
            at_rest: INSIDE * time,
            short: (LONGEST * time, INSIDE * time),
        };
        if is_dry {
            recovery.rest(&machine, units, lost);
        }
        Ok(recovery)
    }

    /// Adds the regulator for a machine at rest, where dry friction acts as much viscous friction.
    /// In motion it acts as little, and the gains for both have opposite signs.
    #[inline(never)]
    fn rest<A: Arithmetic<Scalar = S>>(&mut self, machine: &Pendulum<A>, units: Units, lost: f64) {
        let Ok(model) = linearize_step(machine, S::ZERO) else { return };
        let slow = SLOW * units.time / machine.model().constants.inverse_width.to_f64();
        let infinity = f64::INFINITY;
        let Ok(exact) = Exact::new(model, units, [LINEAR, infinity, slow, slow]) else { return };
        self.resting = Some(exact.design(units));
        if exact.is_rough(lost) {
            self.at_rest = self.inside;
        }

        // In motion friction keeps the other regulator moving. If that takes it too far away, this
        // one also brakes, as far as its torque lasts.
        let [[f, ..], ..] = self.moving.factor; // the only element of its column
        let bounds = [S::from_f64(infinity); 2];
        let mut leaning = machine.clone();
        let theta1 = State::<S>::UPRIGHT.theta1 + S::HALF / f;
        let keeps = leaning.set_state(State { theta1, ..State::UPRIGHT }).is_ok()
            && self.succeeds(leaning, bounds, false);
        if !keeps {
            let part = exact.widest / exact.safe;
            self.reach = S::from_f64(part * part);
            self.cost_to_go = exact.cost_to_go(units.time);
            self.near = S::from_f64(exact.widest * exact.widest);
        }
    }

    /// Whether the regulator succeeds from the model's state, without a velocity at its bound.
    ///
    /// A plan can end inside the ellipsoid where the linear model does not hold, and leave it. So
    /// the simulation has to stay inside for some time: for a short one, or for as long as it takes
    /// to be sure.
    #[inline(never)] // saves flash
    pub(super) fn succeeds<A: Arithmetic<Scalar = S>>(
        &self,
        mut model: Pendulum<A>,
        bounds: [S; 2],
        is_short: bool,
    ) -> bool {
        let dt = model.params().dt.to_f64();
        let steps = |time: f64| (time / dt).min(MOST) as u32;
        let (longest, enough, enough_at_rest) = match is_short {
            true => (steps(self.short.0), steps(self.short.1), steps(self.short.1)),
            false => (steps(self.longest), steps(self.inside), steps(self.at_rest)),
        };
        let [mut inside, mut at_rest] = [0; 2];
        for _ in 0..=longest.max(enough) {
            let x = difference(model.state(), State::UPRIGHT);
            if !(is_near(x) && is_below(model.state(), bounds)) {
                return false;
            }
            let torque = self.torque(x);
            let count = |design: &Design<S>, count: u32| match design.excess(x) < S::ONE {
                true => count + 1,
                false => 0,
            };
            inside = count(&self.moving, inside);
            at_rest = self.resting.as_ref().map_or(0, |design| count(design, at_rest));
            if inside > enough || at_rest > enough_at_rest {
                return true;
            }
            if model.step(torque).is_err() {
                return false;
            }
        }
        false
    }

    /// The torque for a deviation, N m, which can be beyond the largest.
    pub(super) fn wanted(&self, x: [S; 4]) -> S {
        let design = match &self.resting {
            Some(design) if design.excess(x) < self.reach => design,
            _ => &self.moving,
        };
        -dot(design.gain, x)
    }

    /// The torque for a deviation, N m.
    pub(super) fn torque(&self, x: [S; 4]) -> S {
        saturate(self.wanted(x), self.limit)
    }

    /// What the state after a plan costs, with a weight.
    pub(super) fn arrival(&self, weight: S, end: [S; 4]) -> S {
        let x = difference(end.into(), State::UPRIGHT);
        let excess = dot(self.apply(x), x) / self.near;
        weight * S::from_f64(libm::log1p(excess.to_f64()))
    }

    /// The slopes of [`arrival`](Self::arrival), the upper triangle of its curvature, and zeros for
    /// the torque before. Where the logarithm is concave, the curvature is that without it.
    #[inline(never)]
    pub(super) fn arrival_slopes(&self, weight: S, end: [S; 4]) -> [S; 20] {
        let x = difference(end.into(), State::UPRIGHT);
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

/// Whether the regulator has not failed.
pub(super) fn is_near<S: Real>([theta1, theta2, ..]: [S; 4]) -> bool {
    let [most1, most2] = WIDE;
    theta1.to_f64().abs() < most1 && theta2.to_f64().abs() < most2
}

/// Whether both velocities are below their bounds.
pub(super) fn is_below<S: Real>(state: State<S>, [bound1, bound2]: [S; 2]) -> bool {
    state.dtheta1.abs() < bound1 && state.dtheta2.abs() < bound2
}

/// U with P = Uᵀ U for a symmetric, positive definite P.
#[expect(clippy::indexing_slicing, reason = "the indices are 0 to 3")]
fn cholesky(mut p: [[f64; 4]; 4]) -> [[f64; 4]; 4] {
    array::from_fn(|i| {
        let i = i % 4; // without it, a Cortex-M0 checks bounds
        let root = Real::sqrt(p[i][i]);
        let row = p[i].map(|x| x / root);
        for (other, x) in p.iter_mut().zip(row) {
            *other = plus_scaled(*other, -x, row);
        }
        row
    })
}

/// The largest k x where |U x| ≤ 1: |y| for Uᵀ y = k.
#[expect(clippy::indexing_slicing, reason = "the indices are 0 to 3")]
fn largest(u: &[[f64; 4]; 4], mut k: [f64; 4]) -> f64 {
    let y = array::from_fn(|i| {
        let y = k[i] / u[i][i];
        k = plus_scaled(k, -y, u[i]);
        y
    });
    Real::sqrt(dot(y, y))
}
