//! A linear-quadratic regulator of the upright position, and the region in which its torque lasts.
//!
//! A regulator of a step stabilizes with the part κ = 1 / (1 + √(R / (R + Bᵀ P B))) of its gain,
//! too, also if the part changes with each step: with a half for short steps, and nearly 1 where
//! the torque costs little. So as long as it wants at most 1/κ of the largest torque u, xᵀ P x
//! falls. The largest ellipsoid of such x is xᵀ P x ≤ (u/κ)² / (K P⁻¹ Kᵀ). A state in half of it,
//! near enough to upright for the linear model to hold, is in the region.

use core::array;
use core::f64::consts::SQRT_2;

use super::error::ControlError;
use super::linearize::LinearModel;
use super::lqr::{Lqr, lqr};
use super::matrix::{self, Matrix, dot, identity};
use super::units::Units;
use crate::math::Real;
use crate::physics::plus_scaled;

/// The weight of the square of the torque, in units of the machine. That of each angle and of each
/// velocity is 1.
const TORQUE: f64 = 1.0;

/// A regulator and the factor of its cost, in units of the machine: the cost is |U x|².
pub(super) struct Design {
    b: [f64; 4],
    lqr: Lqr,
    factor: Matrix,
    /// |U x| in half of the ellipsoid in which the torque lasts, and in the region.
    pub(super) widest: f64,
    pub(super) safe: f64,
    /// The units of angles and velocities, rad and rad/s, and of the torque, N m.
    units: [f64; 4],
    torque: f64,
}

impl Design {
    /// For deviations, rad and rad/s, below some in which the model of a step holds.
    #[inline(never)]
    pub(super) fn new<S: Real>(
        model: LinearModel<S>,
        Units { time, torque, .. }: Units,
        holds: [f64; 4],
    ) -> Result<Self, ControlError> {
        let units = [1.0, 1.0, 1.0 / time, 1.0 / time];
        let mut a = model.a.map(|row| row.map(S::to_f64));
        let mut b = model.b.map(|x| x.to_f64() * torque);
        for ((row, b), own) in a.iter_mut().zip(&mut b).zip(units) {
            row.iter_mut().zip(units).for_each(|(x, unit)| *x *= unit / own);
            *b /= own;
        }
        // In f64, because the rounding of P to f32 can be larger than its smallest eigenvalue.
        let lqr = lqr(&LinearModel { a, b }, &identity(), TORQUE)?;
        let b_p_b = dot(b, lqr.cost_to_go.map(|row| dot(row, b)));
        let part = 1.0 / (1.0 + Real::sqrt(TORQUE / (TORQUE + b_p_b)));
        let factor = cholesky(lqr.cost_to_go);
        let widest = 1.0 / (SQRT_2 * part * largest(&factor, lqr.gain));
        let mut safe = widest;
        for ((row, most), unit) in identity().into_iter().zip(holds).zip(units) {
            safe = safe.min(most / unit / largest(&factor, row));
        }
        Ok(Self { b, lqr, factor, widest, safe, units, torque })
    }

    /// The weights of each deviation, 1/rad² and s²/rad², and of the torque, 1/(N m)².
    pub(super) fn weights<S: Real>(&self) -> ([S; 4], S) {
        let weights = self.units.map(|unit| S::from_f64(1.0 / (unit * unit)));
        (weights, S::from_f64(TORQUE / (self.torque * self.torque)))
    }

    /// P: xᵀ P x is |U x|² of a deviation x, rad and rad/s.
    pub(super) fn cost_to_go<S: Real>(&self) -> Matrix<S> {
        let mut units = self.units.into_iter();
        self.lqr.cost_to_go.map(|row| self.of_si(row, 1.0 / units.next().unwrap_or(1.0)))
    }

    /// The most that the motor changes a velocity in a step, in units of the machine.
    pub(super) fn largest_change(&self) -> f64 {
        matrix::largest(&self.b)
    }

    /// |U x| where θ̇1 is the smallest velocity that an angle near `theta`, rad, notices in a step of
    /// `dt`, s: as a part of that in the region.
    pub(super) fn roughness<S: Real>(&self, theta: f64, dt: S) -> f64 {
        let [.., unit, _] = self.units;
        let column = self.factor.map(|[.., x, _]| x);
        let lost = S::EPSILON.to_f64() * theta / dt.to_f64() / unit;
        lost * Real::sqrt(dot(column, column)) / self.safe
    }

    pub(super) fn region<S: Real>(&self) -> Region<S> {
        Region {
            gain: self.of_si(self.lqr.gain, self.torque),
            factor: self.factor.map(|row| self.of_si(row, 1.0 / self.safe)),
        }
    }

    /// A row for deviations in rad and rad/s, times a number.
    #[inline(never)]
    fn of_si<S: Real>(&self, mut row: [f64; 4], by: f64) -> [S; 4] {
        row.iter_mut().zip(self.units).for_each(|(x, unit)| *x *= by / unit);
        row.map(S::from_f64)
    }
}

/// A regulator and its region.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region<S> {
    /// K in u = −K x, N m per rad and per rad/s.
    gain: [S; 4],
    /// F: |F x| is at most 1 in the region.
    factor: Matrix<S>,
}

impl<S: Real> Region<S> {
    /// The torque for a deviation, N m.
    #[inline(always)]
    pub(super) fn torque(&self, x: [S; 4]) -> S {
        -dot(self.gain, x)
    }

    /// |F x|².
    #[inline(always)]
    pub(super) fn square(&self, x: [S; 4]) -> S {
        let y = self.factor.map(|row| dot(row, x));
        dot(y, y)
    }

    /// How far θ1 may be from upright in the region, rad, with all else at 0.
    pub(super) fn lean(&self) -> S {
        let [[f, ..], ..] = self.factor; // the only element of its column
        S::ONE / f
    }
}

/// U with P = Uᵀ U for a symmetric, positive definite P.
#[expect(clippy::indexing_slicing, reason = "the indices are 0 to 3")]
#[inline(never)] // saves flash
fn cholesky(mut p: Matrix) -> Matrix {
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
#[inline(never)]
fn largest(u: &Matrix, mut k: [f64; 4]) -> f64 {
    let y = array::from_fn(|i| {
        let y = k[i] / u[i][i];
        k = plus_scaled(k, -y, u[i]);
        y
    });
    Real::sqrt(dot(y, y))
}
