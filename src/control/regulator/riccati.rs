//! The algebraic Riccati equation of steps, and that of continuous time.
//!
//! The structured doubling algorithm (E. K.-W. Chu, H.-Y. Fan, W.-W. Lin and C.-S. Wang,
//! *Structure-Preserving Algorithms for Periodic Discrete-Time Algebraic Riccati Equations*, 2004)
//! finds a gain. Newton's method (G. A. Hewer, *An Iterative Technique for the Computation of the
//! Steady State Gains for the Discrete Optimal Regulator*, 1971), with residuals in twice the
//! digits of `f64`, makes it exact up to rounding.
//!
//! A Cayley transform makes steps of continuous time (E. K.-W. Chu, H.-Y. Fan and W.-W. Lin, *A
//! Structure-Preserving Doubling Algorithm for Continuous-Time Algebraic Riccati Equations*, 2005):
//! deviations vanish in ẋ = C x as in x′ = (1 − C)⁻¹ (1 + C) x. Its unit of time is that of the
//! problem.

use super::double::{Double, MINUS_ONE, ONE, narrow, widen};
use crate::error::Error;
use crate::math::Real;
use crate::math::matrix::{
    Matrix, add, add_outer, add_scaled, apply, congruence, diagonal, divide, identity, inner,
    largest, product, scale, spread, symmetrize, transpose,
};

/// A motion persists if it does not vanish within 2 to the power of this number of steps.
const DOUBLINGS: u32 = 40;
/// Newton's method converges quadratically, but may first halve a gain that is decades too large.
const NEWTON_ITERATIONS: u32 = 60;
/// The largest error of a gain, relative to its largest element.
const TOLERANCE: f64 = 1e-9;

/// A model and its weights: of `STEPS` or of continuous time, with `N` inputs.
#[derive(Clone, Copy)]
pub(super) struct Problem<const STEPS: bool, const N: usize = 1> {
    pub(super) a: Matrix,
    /// The columns of B, and the weight of each input.
    pub(super) inputs: [([f64; 4], f64); N],
    pub(super) q: Matrix,
}

/// K, a row for each input.
pub(super) type Gain<const N: usize = 1> = [[f64; 4]; N];

impl<const STEPS: bool, const N: usize> Problem<STEPS, N> {
    /// K, P, and the unit of this P, which has twice the digits.
    ///
    /// Computes in units of each input and of cost in which the largest elements of B and of the
    /// weights are between 1 and 2, so that nothing overflows. Powers of 2 change no digit.
    pub(super) fn solve(&self) -> Result<(Gain<N>, Matrix<Double>, f64), Error> {
        let Self { a, mut inputs, mut q } = *self;
        let units = inputs.map(|(b, _)| power_of_2(largest(&b)));
        let weighted = largest(q.as_flattened());
        let mut most = weighted;
        for ((b, r), unit) in inputs.iter_mut().zip(units) {
            *b = b.map(|x| x / unit);
            *r = *r / unit / unit;
            most = r.max(most);
        }
        let unit = power_of_2(most);
        if weighted > 0.0 && weighted / unit < 1e-250 {
            return Err(Error::IllConditioned { error: 1.0 }); // costs would underflow
        }
        inputs = inputs.map(|(b, r)| (b, r / unit));
        scale(&mut q, 1.0 / unit);

        let scaled = Self { a, inputs, q };
        let begin = |other: &Self| scaled.refine(other.double().ok_or(Error::NotStabilizable)?);
        // Other weights give a gain that stabilizes even if Q does not weight a motion that grows.
        let (mut gain, cost) = begin(&scaled).or_else(|_| {
            let inputs = inputs.map(|(b, _)| (b, inner(&b, &b)));
            begin(&Self { a, inputs, q: identity() })
        })?;
        for (k, unit) in gain.iter_mut().zip(units) {
            *k = k.map(|x| x / unit);
        }
        Ok((gain, cost, unit))
    }

    /// K and P up to rounding, which can be large.
    ///
    /// With A, G = B R⁻¹ Bᵀ and P = Q for one step, the iteration computes the same for twice as
    /// many steps: P + Aᵀ P W⁻¹ A, G + A W⁻¹ G Aᵀ and A W⁻¹ A, where W = 1 + G P. A vanishes as the
    /// closed loop does.
    #[inline(never)]
    fn double(&self) -> Option<(Gain<N>, Matrix)> {
        let [mut a, mut g, mut p] = self.first()?;
        for _ in 0..DOUBLINGS {
            let mut w = identity();
            add(&mut w, 1.0, &product(&g, &p));
            let [w_a, w_g] = divide(&w, &a, &g)?;
            let mut change = product(&a, &product(&w_g, &transpose(&a)));
            symmetrize(&mut change);
            add(&mut g, 1.0, &change);
            change = product(&transpose(&a), &product(&p, &w_a));
            symmetrize(&mut change);
            add(&mut p, 1.0, &change);
            a = product(&a, &w_a);
            if has_vanished(&a) {
                return Some((self.gain(&widen(&p)).0, p));
            }
        }
        None
    }

    /// A, G and P of one step, or of the Cayley transform.
    fn first(&self) -> Option<[Matrix; 3]> {
        let mut g = [[0.0; 4]; 4];
        for (b, r) in &self.inputs {
            add_outer(&mut g, 1.0 / r, b, b);
        }
        if STEPS {
            return Some([self.a, g, self.q]);
        }
        // With D = 1 − A and W = D + G D⁻ᵀ Q: 1 − 2 W⁻¹, whose sign does not matter, 2 W⁻¹ G D⁻ᵀ
        // and 2 W⁻ᵀ Q D⁻¹.
        let (mut a, mut d) = (identity(), identity());
        add(&mut d, -1.0, &self.a);
        let [d_inverse, d_g] = divide(&d, &identity(), &g)?;
        let g_d = transpose(&d_g);
        add(&mut d, 1.0, &product(&g_d, &self.q));
        let [w_inverse, mut g] = divide(&d, &identity(), &g_d)?;
        add(&mut a, -2.0, &w_inverse);
        let mut p = product(&transpose(&w_inverse), &product(&self.q, &d_inverse));
        for half in [&mut g, &mut p] {
            symmetrize(half);
            scale(half, 2.0);
        }
        Some([a, g, p])
    }

    /// The best gain before a cost P, and the columns and the divisor of B (R + Bᵀ P B)⁻¹, in
    /// continuous time of B R⁻¹.
    #[inline(never)]
    pub(super) fn gain(&self, p: &Matrix<Double>) -> (Gain<N>, Gain<N>, f64) {
        let a = transpose(&widen(&self.a));
        let mut rows = self.inputs.map(|(b, r)| {
            let b = b.map(Double::from);
            let (p_b, r) = (apply(p, &b), Double::from(r));
            match STEPS {
                true => (apply(&a, &p_b), b, r + inner(&b, &p_b), p_b),
                false => (p_b, b, r, p_b),
            }
        });
        if let [(x, b, v, p_b), (y, c, w, _)] = &mut rows[..] {
            // Cramer's rule.
            let shared = inner(c, p_b) * MINUS_ONE;
            for (x, y) in x.iter_mut().zip(y).chain(b.iter_mut().zip(c)) {
                (*x, *y) = (*w * *x + shared * *y, *v * *y + shared * *x);
            }
            *v = *v * *w + shared * shared * MINUS_ONE;
            *w = *v;
        }
        let divisor = rows.iter().fold(1.0, |_, (.., divisor, _)| f64::from(*divisor)); // of all
        let gain = rows.map(|(x, ..)| x.map(|x| f64::from(x) / divisor));
        (gain, rows.map(|(_, b, ..)| b.map(f64::from)), divisor)
    }

    /// Newton's method, from a gain that stabilizes. It alternates between the cost of a gain and
    /// the gain that is best for this cost. Residuals have twice the digits of `f64`, so each
    /// iteration corrects the rounding of the one before.
    #[inline(never)]
    fn refine(
        &self,
        (mut gain, cost): (Gain<N>, Matrix),
    ) -> Result<(Gain<N>, Matrix<Double>), Error> {
        let mut cost = widen(&cost);
        let [mut change, mut before, mut error] = [f64::INFINITY; 3];
        for _ in 0..NEWTON_ITERATIONS {
            let (closed, residual) = self.residual(&gain, &cost);
            let Some(missing) = Self::lyapunov(&closed, &residual) else {
                // By halves the gain approaches one that lets a motion persist.
                if (0.25..0.75).contains(&(change / before)) {
                    return Err(Error::NotDetectable);
                }
                break;
            };
            for (row, missing) in cost.iter_mut().zip(&widen(&missing)) {
                add_scaled(row, ONE, missing);
            }
            let better = self.gain(&cost);
            for (k, better) in gain.iter_mut().zip(&better.0) {
                add_scaled(k, -1.0, better);
            }
            (before, change) = (change, largest(gain.as_flattened()));
            gain = better.0;

            let size = largest(gain.as_flattened());
            error = change / size;
            if change <= 16.0 * f64::EPSILON * size {
                let rounding = self.rounding(&better, &narrow(&cost), &missing, &closed);
                error = rounding / size;
                if error <= TOLERANCE || size == 0.0 && rounding.is_finite() {
                    return Ok((gain, cost));
                }
            }
        }
        Err(match error {
            f64::INFINITY => Error::NotStabilizable, // no gain gave a cost
            _ => Error::IllConditioned { error },
        })
    }

    /// Whether deviations vanish with this gain.
    pub(super) fn is_stable(&self, gain: &Gain<N>) -> bool {
        let (closed, _) = self.residual(gain, &widen(&[[0.0; 4]; 4]));
        Self::lyapunov(&closed, &identity()).is_some()
    }

    /// C = A − B K, and what the equation of P lacks on its left: P = Cᵀ P C + Q + Kᵀ R K, or
    /// 0 = Cᵀ P + P C + Q + Kᵀ R K.
    #[inline(never)]
    fn residual(&self, gain: &Gain<N>, p: &Matrix<Double>) -> (Matrix, Matrix) {
        let mut columns = transpose(&widen(&self.a));
        let mut residual = widen(&self.q);
        for ((b, r), k) in self.inputs.iter().zip(gain) {
            let [b, k] = [b, k].map(|x| x.map(Double::from));
            for ((column, row), x) in columns.iter_mut().zip(&mut residual).zip(k) {
                add_scaled(column, x * MINUS_ONE, &b);
                add_scaled(row, Double::from(*r) * x, &k);
            }
        }
        if STEPS {
            for ((row, p_row), column) in residual.iter_mut().zip(p).zip(&columns) {
                add_scaled(row, MINUS_ONE, p_row);
                add_scaled(row, ONE, &apply(&columns, &apply(p, column)));
            }
        } else {
            let p_c = columns.map(|column| apply(p, &column));
            for ((row, p_c), c_p) in residual.iter_mut().zip(&p_c).zip(&transpose(&p_c)) {
                add_scaled(row, ONE, p_c);
                add_scaled(row, ONE, c_p);
            }
        }
        let mut residual = narrow(&residual);
        symmetrize(&mut residual);
        (transpose(&narrow(&columns)), residual)
    }

    /// The cost P of all time of a closed loop C, P = Cᵀ P C + S or 0 = Cᵀ P + P C + S. `None` if
    /// deviations do not vanish.
    fn lyapunov(closed: &Matrix, stage: &Matrix) -> Option<Matrix> {
        if STEPS {
            return lyapunov(closed, stage);
        }
        let [mut above, mut below] = [identity(); 2];
        add(&mut above, 1.0, closed);
        add(&mut below, -1.0, closed);
        let [power, inverse] = divide(&below, &above, &identity())?;
        let mut stage = congruence(stage, &inverse);
        scale(&mut stage, 2.0);
        lyapunov(&power, &stage)
    }

    /// A bound of the error that rounding leaves in a gain; infinite if the cost still changes.
    ///
    /// The rounding N of the residual has |N_ij| ≤ s_i s_j, because |P_ij|² ≤ P_ii P_jj. So N is
    /// between −4 diag(s²) and 4 diag(s²), and the error E of P between −L and L, if L is the cost
    /// of the latter. Then |xᵀ E y|² ≤ xᵀ L x · yᵀ L y, whatever the units of the state.
    #[inline(never)]
    fn rounding(
        &self,
        (gain, columns, divisor): &(Gain<N>, Gain<N>, f64),
        p: &Matrix,
        missing: &Matrix,
        closed: &Matrix,
    ) -> f64 {
        /// 2⁻¹⁰², times 64 for the number of operations and the factor 4.
        const ROUNDING: f64 = 1.0 / (1_u128 << 96) as f64;
        let p = spread(diagonal(p).map(f64::abs));
        let mut terms = congruence(&p, &self.a);
        add(&mut terms, 1.0, &p);
        for ((b, _), k) in self.inputs.iter().zip(gain) {
            add_outer(&mut terms, inner(b, &apply(&p, b)), k, k);
        }
        let terms = diagonal(&terms);
        // A motion without a cost persists, whatever the powers of the closed loop look like.
        let mut parts = diagonal(missing).into_iter().zip(terms);
        let is_cost = parts.all(|(missing, terms)| missing.abs() <= TOLERANCE * terms);
        match Self::lyapunov(closed, &spread(terms)) {
            Some(l) if is_cost => {
                let squared = columns.map(|b| inner(&b, &apply(&l, &b)) * largest(&diagonal(&l)));
                // s² is a sum over the inputs.
                N as f64 * ROUNDING * Real::sqrt(largest(&squared)) / divisor
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
