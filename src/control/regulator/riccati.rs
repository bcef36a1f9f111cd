//! The algebraic Riccati equation of steps.
//!
//! The structured doubling algorithm (E. K.-W. Chu, H.-Y. Fan, W.-W. Lin and C.-S. Wang,
//! *Structure-Preserving Algorithms for Periodic Discrete-Time Algebraic Riccati Equations*, 2004)
//! finds a gain. Newton's method (G. A. Hewer, *An Iterative Technique for the Computation of the
//! Steady State Gains for the Discrete Optimal Regulator*, 1971), with residuals in twice the
//! digits of `f64`, makes it exact up to rounding.

use super::double::{Double, MINUS_ONE, narrow, widen};
use crate::error::Error;
use crate::math::Real;
use crate::math::matrix::{
    Matrix, add, add_outer, add_scaled, apply, congruence, diagonal, eliminate, identity, inner,
    largest, product, scale, spread, symmetrize, transpose,
};

/// A motion persists if it does not vanish within 2 to the power of this number of steps.
const DOUBLINGS: u32 = 40;
/// Newton's method converges quadratically, but may first halve a gain that is decades too large.
const NEWTON_ITERATIONS: u32 = 60;
/// The largest error of a gain, relative to its largest element.
const TOLERANCE: f64 = 1e-9;

/// A model and its weights.
#[derive(Clone, Copy)]
pub(super) struct Problem {
    pub(super) a: Matrix,
    pub(super) b: [f64; 4],
    pub(super) q: Matrix,
    pub(super) r: f64,
}

/// K and P.
pub(super) type Solution = ([f64; 4], Matrix);

impl Problem {
    /// Computes in units of torque and cost in which the largest elements of B and of the weights
    /// are between 1 and 2, so that nothing overflows. Powers of 2 change no digit.
    pub(super) fn solve(mut self) -> Result<Solution, Error> {
        let torque_unit = power_of_2(largest(&self.b));
        self.b = self.b.map(|x| x / torque_unit);
        self.r = self.r / torque_unit / torque_unit;
        let most = largest(self.q.as_flattened());
        let cost_unit = power_of_2(self.r.max(most));
        if most > 0.0 && most / cost_unit < 1e-250 {
            return Err(Error::IllConditioned { error: 1.0 }); // costs would underflow
        }
        self.r /= cost_unit;
        scale(&mut self.q, 1.0 / cost_unit);

        // Other weights give a gain that stabilizes even if Q does not weight a motion that grows.
        let (gain, mut cost) = self
            .solve_from(&self.q, self.r)
            .or_else(|_| self.solve_from(&identity(), inner(&self.b, &self.b)))?;
        scale(&mut cost, cost_unit);
        Ok((gain.map(|x| x / torque_unit), cost))
    }

    /// The solution, beginning with that for the weights `q` and `r`.
    fn solve_from(&self, q: &Matrix, r: f64) -> Result<Solution, Error> {
        let start = self.double(q, r);
        self.refine(start.ok_or(Error::NotStabilizable)?)
    }

    /// K and P for the weights `q` and `r` up to rounding, which can be large.
    ///
    /// With A, G = B Bᵀ / R and P = Q for one step, the iteration computes the same for twice as
    /// many steps: P + Aᵀ P W⁻¹ A, G + A W⁻¹ G Aᵀ and A W⁻¹ A, where W = 1 + G P. A vanishes as the
    /// closed loop does.
    #[inline(never)]
    fn double(&self, q: &Matrix, r: f64) -> Option<Solution> {
        let (mut a, mut p, mut g) = (self.a, *q, [[0.0; 4]; 4]);
        add_outer(&mut g, 1.0 / r, &self.b, &self.b);
        for _ in 0..DOUBLINGS {
            let mut w = identity();
            add(&mut w, 1.0, &product(&g, &p));
            let mut rows =
                [[w[0], a[0], g[0]], [w[1], a[1], g[1]], [w[2], a[2], g[2]], [w[3], a[3], g[3]]];
            eliminate(&mut rows)?;
            let mut change = product(&a, &product(&rows.map(|[.., w_g]| w_g), &transpose(&a)));
            symmetrize(&mut change);
            add(&mut g, 1.0, &change);
            let w_a = rows.map(|[_, w_a, _]| w_a);
            change = product(&transpose(&a), &product(&p, &w_a));
            symmetrize(&mut change);
            add(&mut p, 1.0, &change);
            a = product(&a, &w_a);
            if has_vanished(&a) {
                return Some((self.gain(&widen(&p), r).0, p));
            }
        }
        None
    }

    /// The best gain before a cost P, and how much that weights the torque.
    #[inline(never)]
    fn gain(&self, p: &Matrix<Double>, r: f64) -> ([f64; 4], f64) {
        let b = self.b.map(Double::from);
        let p_b = apply(p, &b);
        let weight = f64::from(Double::from(r) + inner(&b, &p_b));
        let gain = apply(&transpose(&widen(&self.a)), &p_b);
        (gain.map(|x| f64::from(x) / weight), weight)
    }

    /// Newton's method, from a gain that stabilizes. It alternates between the cost of a gain and
    /// the gain that is best for this cost. Residuals have twice the digits of `f64`, so each
    /// iteration corrects the rounding of the one before.
    #[inline(never)]
    fn refine(&self, (mut gain, cost): Solution) -> Result<Solution, Error> {
        let mut cost = widen(&cost);
        let [mut change, mut before, mut error] = [f64::INFINITY; 3];
        for _ in 0..NEWTON_ITERATIONS {
            let (closed, residual) = self.residual(&gain, &cost);
            let Some(missing) = lyapunov(&closed, &residual) else {
                // By halves the gain approaches one that lets a motion persist.
                if (0.25..0.75).contains(&(change / before)) {
                    return Err(Error::NotDetectable);
                }
                break;
            };
            for (row, missing) in cost.iter_mut().zip(&widen(&missing)) {
                add_scaled(row, Double::from(1.0), missing);
            }
            let (better, weight) = self.gain(&cost, self.r);
            add_scaled(&mut gain, -1.0, &better);
            (before, change) = (change, largest(&gain));
            gain = better;

            let size = largest(&gain);
            error = change / size;
            if change <= 16.0 * f64::EPSILON * size {
                let rounded = narrow(&cost);
                let rounding = self.rounding(&gain, &rounded, &missing, &closed) / weight;
                error = rounding / size;
                if error <= TOLERANCE || size == 0.0 && rounding.is_finite() {
                    return Ok((gain, rounded));
                }
            }
        }
        Err(match error {
            f64::INFINITY => Error::NotStabilizable, // no gain gave a cost
            _ => Error::IllConditioned { error },
        })
    }

    /// Whether deviations vanish with this gain.
    pub(super) fn is_stable(&self, gain: &[f64; 4]) -> bool {
        let (closed, _) = self.residual(gain, &widen(&[[0.0; 4]; 4]));
        lyapunov(&closed, &identity()).is_some()
    }

    /// A − B Kᵀ, and what the equation P = (A − B Kᵀ)ᵀ P (A − B Kᵀ) + Q + R K Kᵀ lacks on its left.
    #[inline(never)]
    fn residual(&self, gain: &[f64; 4], p: &Matrix<Double>) -> (Matrix, Matrix) {
        let [b, gain] = [&self.b, gain].map(|x| x.map(Double::from));
        let mut columns = transpose(&widen(&self.a));
        for (column, k) in columns.iter_mut().zip(gain) {
            add_scaled(column, k * MINUS_ONE, &b);
        }
        let mut residual = widen(&self.q);
        for (((row, p_row), k), column) in residual.iter_mut().zip(p).zip(gain).zip(&columns) {
            add_scaled(row, Double::from(self.r) * k, &gain);
            add_scaled(row, MINUS_ONE, p_row);
            add_scaled(row, Double::from(1.0), &apply(&columns, &apply(p, column)));
        }
        let mut residual = narrow(&residual);
        symmetrize(&mut residual);
        (transpose(&narrow(&columns)), residual)
    }

    /// A bound of the error that rounding leaves in a gain, times the weight of the torque;
    /// infinite if the cost still changes.
    ///
    /// The rounding N of the residual has |N_ij| ≤ s_i s_j, because |P_ij|² ≤ P_ii P_jj. So N is
    /// between −4 diag(s²) and 4 diag(s²), and the error E of P between −L and L, if L is the cost
    /// of the latter. Then |xᵀ E y|² ≤ xᵀ L x · yᵀ L y, whatever the units of the state.
    #[inline(never)]
    fn rounding(&self, gain: &[f64; 4], p: &Matrix, missing: &Matrix, closed: &Matrix) -> f64 {
        /// 2⁻¹⁰², times 64 for the number of operations and the factor 4.
        const ROUNDING: f64 = 1.0 / (1_u128 << 96) as f64;
        let p = spread(diagonal(p).map(f64::abs));
        let mut terms = congruence(&p, &self.a);
        add(&mut terms, 1.0, &p);
        add_outer(&mut terms, inner(&self.b, &apply(&p, &self.b)), gain, gain);
        let terms = diagonal(&terms);
        // A motion without a cost persists, whatever the powers of the closed loop look like.
        let mut parts = diagonal(missing).into_iter().zip(terms);
        let is_cost = parts.all(|(missing, terms)| missing.abs() <= TOLERANCE * terms);
        match lyapunov(closed, &spread(terms)) {
            Some(l) if is_cost => {
                let squared = largest(&diagonal(&l)) * inner(&self.b, &apply(&l, &self.b));
                ROUNDING * Real::sqrt(squared)
            }
            _ => f64::INFINITY,
        }
    }
}

/// The largest power of 2 up to a positive number; 1 for 0.
fn power_of_2(x: f64) -> f64 {
    match f64::from_bits(x.to_bits() & f64::INFINITY.to_bits()) {
        0.0 => 1.0,
        power => power,
    }
}

/// The solution of P = mᵀ P m + stage, the discrete Lyapunov equation, by doubling. `None` if the
/// powers of m do not vanish.
#[inline(never)]
fn lyapunov(m: &Matrix, stage: &Matrix) -> Option<Matrix> {
    let (mut m, mut p) = (*m, *stage);
    for _ in 0..=DOUBLINGS {
        let change = congruence(&p, &m);
        add(&mut p, 1.0, &change);
        if has_vanished(&m) {
            return p.as_flattened().iter().all(|x| x.is_finite()).then_some(p);
        }
        m = product(&m, &m);
    }
    None
}

fn has_vanished(m: &Matrix) -> bool {
    m.iter().fold(0.0, |sum, row| sum + inner(row, row)) < 1e-24
}
