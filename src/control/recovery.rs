//! The regulator of the upright position with a bounded torque, and from which states it recovers.
//!
//! A linear-quadratic regulator stabilizes with half of its gain, too. So as long as it wants at
//! most twice the largest torque u, xᵀ P x falls. The largest ellipsoid of such x is xᵀ P x ≤
//! 4 u² / (K P⁻¹ Kᵀ). A simulation that stays in half of it, near enough to upright for the linear
//! model to hold, has recovered.

use core::array;
use core::f64::consts::{FRAC_PI_2, SQRT_2};

use super::deviation::difference;
use super::error::ControlError;
use super::linearize::LinearModel;
use super::linearize_step::linearize_step;
use super::lqr::{Lqr, lqr};
use super::matrix::{dot, identity};
use crate::arithmetic::Arithmetic;
use crate::error::Range;
use crate::math::Real;
use crate::physics::{Params, Pendulum, State, plus_scaled, saturate};

/// The regulator has failed beyond these deviations of θ1 and θ2, rad.
const WIDE: [f64; 2] = [FRAC_PI_2, 3.1];
/// The linear model holds for this deviation of θ1, rad.
const LINEAR: f64 = 0.3;
/// The regulator has failed after this time, s.
const LONGEST: f64 = 4.0;

/// A regulator whose torque is bounded.
#[derive(Clone, Debug)]
pub(super) struct Recovery<S> {
    pub(super) regulator: Lqr<S>,
    /// The largest torque, N m.
    pub(super) limit: S,
    /// F: where |F x| is below 1, the regulator succeeds.
    factor: [[S; 4]; 4],
    /// xᵀ P x at the end of a plan, from which on `arrival` grows slowly.
    near: S,
    /// The steps of `LONGEST`.
    steps: u32,
}

impl<S: Real> Recovery<S> {
    /// See [`Planner::new`](super::planner::Planner::new).
    pub(super) fn new<A: Arithmetic<Scalar = S>>(
        params: Params<S>,
        limit: S,
    ) -> Result<Self, ControlError> {
        Range::AboveZero.check("the largest torque", limit.to_f64(), "N m")?;
        let machine = Pendulum::<A>::new(params, State::UPRIGHT)?;
        let LinearModel { a, b } = linearize_step(&machine, S::ZERO)?;
        let model = LinearModel { a: a.map(|row| row.map(S::to_f64)), b: b.map(S::to_f64) };
        // In f64, because the rounding of P to f32 can be larger than its smallest eigenvalue.
        let exact = lqr(&model, &identity(), 1.0)?;
        let regulator = Lqr {
            gain: exact.gain.map(S::from_f64),
            cost_to_go: exact.cost_to_go.map(|row| row.map(S::from_f64)),
        };
        let factor = cholesky(exact.cost_to_go);
        let most = limit.to_f64() / largest(&factor, exact.gain);
        let safe = (most * SQRT_2).min(LINEAR / largest(&factor, [1.0, 0.0, 0.0, 0.0]));
        let factor = factor.map(|row| row.map(|x| S::from_f64(x / safe)));
        let near = S::from_f64(safe * safe);
        let steps = (LONGEST / params.dt.to_f64()) as u32;
        Ok(Self { regulator, limit, factor, near, steps })
    }

    /// Whether the regulator succeeds from the model's state, without a velocity at its bound.
    /// Simulates at most so many steps.
    ///
    /// A plan can end inside the ellipsoid where the linear model does not hold, and leave it. So
    /// the simulation has to stay inside for a sixteenth of the longest time.
    #[inline(never)] // saves flash
    pub(super) fn succeeds<A: Arithmetic<Scalar = S>>(
        &self,
        mut model: Pendulum<A>,
        bounds: [S; 2],
        most: u32,
    ) -> bool {
        let mut inside = 0;
        for _ in 0..most.min(self.steps) {
            let x = difference(model.state(), State::UPRIGHT);
            if !(is_near(x) && is_below(model.state(), bounds)) {
                return false;
            }
            let torque = self.torque(x);
            let x = self.factor.map(|row| dot(row, x));
            inside = if dot(x, x) < S::from_f64(1.0) { inside + 1 } else { 0 };
            if inside > self.steps / 16 {
                return true;
            }
            if model.step(torque).is_err() {
                return false;
            }
        }
        false
    }

    /// The torque for a deviation, N m.
    pub(super) fn torque(&self, x: [S; 4]) -> S {
        saturate(self.regulator.torque(x), self.limit)
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
        let [p1, p2, p3, p4] = self.regulator.cost_to_go;
        let ([_, p22, p23, p24], [_, _, p33, p34], [.., p44], o) = (p2, p3, p4, S::ZERO);
        let [p11, p12, p13, p14] = p1;
        let slopes =
            [s1, s2, s3, s4, p11, p12, p13, p14, p22, p23, p24, p33, p34, p44, o, o, o, o, o, o];
        slopes.map(|x| x * weight)
    }

    /// P x.
    #[inline(always)]
    fn apply(&self, x: [S; 4]) -> [S; 4] {
        self.regulator.cost_to_go.map(|row| dot(row, x))
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
