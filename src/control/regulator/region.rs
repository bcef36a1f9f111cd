//! A linear-quadratic regulator of an equilibrium, and the region in which its torque lasts.
//!
//! In steps, a regulator stabilizes with any part of its gain from κ to 1, also if the part changes
//! from step to step: κ = 1 / (1 + √(R / (R + Bᵀ P B))) is a half for short steps, and nearly 1
//! where the torque costs little. So while it wants at most 1/κ times the largest torque u, xᵀ P x
//! falls. The largest ellipsoid of such x is xᵀ P x ≤ (u/κ)² / (K P⁻¹ Kᵀ). A state in half of it,
//! near enough to the equilibrium for the linear model to hold, is in the region.

use core::array;
use core::f64::consts::SQRT_2;

use super::dlqr::{Lqr, dlqr};
use crate::control::model::StepModel;
use crate::control::units::Units;
use crate::error::Error;
use crate::math::Real;
use crate::math::matrix::{
    Matrix, add_scaled, apply, congruence, dot, identity, inner, product, scale, spread,
};

/// The weight of the square of the torque, in units of the machine. That of each angle and of each
/// velocity is 1.
const TORQUE: f64 = 1.0;

/// A regulator and the factor of its cost, in units of the machine: the cost is |U x|².
pub(super) struct Design {
    lqr: Lqr,
    factor: Matrix,
    /// |U x| in half of the ellipsoid in which the torque lasts, and in the region.
    pub(super) widest: f64,
    pub(super) safe: f64,
    /// The part of a torque by which the regulator changes it in a step.
    pub(super) change: f64,
    units: Units,
}

impl Design {
    /// For deviations below some in which the model of a step holds, in units of the machine.
    #[inline(never)] // saves flash, and so do products of matrices, which are out of line
    pub(super) fn new<S: Real>(
        model: &StepModel<S>,
        units: Units,
        holds: [f64; 4],
    ) -> Result<Self, Error> {
        let Units { time, torque, .. } = units;
        let a = model.a.map(|row| row.map(S::to_f64));
        let a = product(&with_velocities(time), &product(&a, &with_velocities(1.0 / time)));
        let b = apply(&with_velocities(time), &model.b.map(|x| x.to_f64() * torque));
        // In f64, because the rounding of P to f32 can be larger than its smallest eigenvalue.
        let lqr = dlqr(&StepModel { a, b }, &identity(), TORQUE)?;
        let b_p_b = inner(&b, &apply(&lqr.cost_to_go, &b));
        let part = 1.0 / (1.0 + Real::sqrt(TORQUE / (TORQUE + b_p_b)));
        let factor = cholesky(lqr.cost_to_go);
        let widest = 1.0 / (SQRT_2 * part * farthest(&factor, lqr.gain));
        let mut safe = widest;
        for (row, most) in identity().into_iter().zip(holds) {
            safe = safe.min(most / farthest(&factor, row));
        }
        Ok(Self { lqr, factor, widest, safe, change: inner(&lqr.gain, &b), units })
    }

    /// The weights of each deviation, 1/rad² and s²/rad², and of the torque, 1/(N m)².
    pub(super) fn weights<S: Real>(&self) -> ([S; 4], S) {
        let Units { time, torque, .. } = self.units;
        let weights = [1.0, 1.0, time * time, time * time].map(S::from_f64);
        (weights, S::from_f64(TORQUE / (torque * torque)))
    }

    /// P: xᵀ P x is |U x|² of a deviation x, rad and rad/s.
    pub(super) fn cost_to_go<S: Real>(&self) -> Matrix<S> {
        narrow(&congruence(&self.lqr.cost_to_go, &with_velocities(self.units.time)))
    }

    /// |U x| where θ̇1 is the smallest velocity that an angle near `theta`, rad, notices in a step
    /// of `dt`, s: as a part of that in the region.
    pub(super) fn roughness<S: Real>(&self, theta: f64, dt: S) -> f64 {
        let column = self.factor.map(|[.., x, _]| x);
        let lost = S::EPSILON.to_f64() * theta / dt.to_f64() * self.units.time;
        lost * Real::sqrt(inner(&column, &column)) / self.safe
    }

    pub(super) fn region<S: Real>(&self) -> Region<S> {
        let Units { time, torque, .. } = self.units;
        let mut factor = product(&self.factor, &with_velocities(time));
        scale(&mut factor, 1.0 / self.safe);
        let gain = apply(&with_velocities(time), &self.lqr.gain);
        Region { gain: gain.map(|x| S::from_f64(x * torque)), factor: narrow(&factor) }
    }
}

#[inline(never)]
fn narrow<S: Real>(m: &Matrix) -> Matrix<S> {
    m.map(|row| row.map(S::from_f64))
}

/// The matrix that multiplies both velocities.
#[inline(never)]
fn with_velocities(by: f64) -> Matrix {
    spread([1.0, 1.0, by, by])
}

/// A gain and the region in which its torque lasts.
///
/// ```
/// use acrobot::control::regulator::{BoundedRegulator, Region};
/// use acrobot::{Params, Portable};
///
/// let params = Params { dt: 0.02, ..Params::DEFAULT };
/// let regulator = BoundedRegulator::<Portable>::new(params, 10.0)?; // N m
/// let Region { factor: [[f, ..], ..], .. } = regulator.feedback().moving;
/// assert!((1.0 / f - 0.0108).abs() < 1e-4); // rad: the largest lean of link 1 in the region
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)] // for bindings/abi
pub struct Region<S = f64> {
    /// K in u = −K x, N m per rad and per rad/s.
    pub gain: [S; 4],
    /// F, by rows: a deviation x is in the region if |F x| is below 1.
    pub factor: [[S; 4]; 4],
}

impl<S: Real> Region<S> {
    /// No gain, for a [`Feedback`](super::Feedback) with a `reach` of 0.
    pub const NONE: Self = Self { gain: [S::ZERO; 4], factor: [[S::ZERO; 4]; 4] };

    /// The torque for a deviation, N m.
    pub(super) fn torque(&self, x: [S; 4]) -> S {
        -dot(self.gain, x)
    }

    /// |F x|².
    #[inline(never)] // saves flash
    pub(super) fn square(&self, x: [S; 4]) -> S {
        let y = self.factor.map(|row| dot(row, x));
        dot(y, y)
    }

    /// How far θ1 may be from the equilibrium in the region, rad, with all else at 0.
    pub(super) fn lean(&self) -> S {
        let [[f, ..], ..] = self.factor; // the only element of its column
        S::ONE / f
    }
}

/// U with P = Uᵀ U for a symmetric, positive definite P.
fn cholesky(mut p: Matrix) -> Matrix {
    /// Row `i`, which is subtracted from P.
    #[expect(clippy::indexing_slicing, reason = "the index is 0 to 3")]
    #[inline(never)] // saves flash
    fn row(p: &mut Matrix, i: usize) -> [f64; 4] {
        let i = i % 4; // without it, a Cortex-M0 checks bounds
        let root = Real::sqrt(p[i][i]);
        let row = p[i].map(|x| x / root);
        for (other, x) in p.iter_mut().zip(row) {
            add_scaled(other, -x, &row);
        }
        row
    }

    array::from_fn(|i| row(&mut p, i))
}

/// The largest k x where |U x| ≤ 1: |y| for Uᵀ y = k.
#[expect(clippy::indexing_slicing, reason = "the indices are 0 to 3")]
#[inline(never)]
fn farthest(u: &Matrix, mut k: [f64; 4]) -> f64 {
    let y = array::from_fn(|i| {
        let y = k[i] / u[i][i];
        add_scaled(&mut k, -y, &u[i]);
        y
    });
    Real::sqrt(dot(y, y))
}
