//! The linear-quadratic regulator of a discrete model.

use super::Discrete;
use super::matrix::{
    Matrix, apply, check_finite, dot, identity, largest, outer, product, solve, sum, symmetric,
    transpose,
};
use crate::arithmetic::{Arithmetic, Real};
use crate::error::{Error, Range};
use crate::physics::rk4::Along;
use crate::physics::{State, wrap};

/// A linear-quadratic regulator: the state feedback that minimizes the sum of xᵀ Q x + R u² over all steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Lqr<S = f64> {
    /// K in u = −K x, N m per rad and per rad/s.
    pub gain: [S; 4],
    /// P, the solution of the discrete algebraic Riccati equation: xᵀ P x is the cost of all steps from x on. It is
    /// symmetric.
    pub cost_to_go: [[S; 4]; 4],
    /// How often the Riccati iteration doubled the number of steps that P accounts for.
    pub iterations: u32,
}

impl<S: Real> Lqr<S> {
    /// The torque −K x, N m, for a deviation x from the state of the linearization, rad and rad/s: see [`difference`].
    /// Add the torque of the linearization if it is not 0. The torque of the motor is not bounded here.
    #[must_use]
    pub fn torque(&self, x: [S; 4]) -> S {
        -dot(self.gain, x)
    }
}

/// The deviation of `state` from `target`, rad and rad/s. The differences of the angles are wrapped to \[−π, π\], so
/// that it is continuous upright, where θ1 jumps from π to −π. Velocities near the limit of the scalar can overflow.
///
/// ```
/// use acrobot::physics::control::difference;
/// use acrobot::{Portable, State};
///
/// let beyond = State { theta1: -3.0, ..State::UPRIGHT };
/// let x = difference::<Portable>(beyond, State::UPRIGHT);
/// assert!((x[0] - 0.14159).abs() < 1e-5);
/// ```
#[must_use]
pub fn difference<A: Arithmetic>(
    state: State<A::Scalar>,
    target: State<A::Scalar>,
) -> [A::Scalar; 4] {
    // Wrapped first, so that no difference overflows.
    let between = |x, y| wrap::<A>(wrap::<A>(x) - wrap::<A>(y));
    [
        between(state.theta1, target.theta1),
        between(state.theta2, target.theta2),
        state.dtheta1 - target.dtheta1,
        state.dtheta2 - target.dtheta2,
    ]
}

/// A closed loop whose deviations have not vanished after 2²⁰ steps counts as unstable: in `f32` the rounding of its
/// elements decides what it is.
const SQUARINGS: u32 = 20;
/// The doublings after which the Riccati iteration ends: P must be exact up to rounding, which takes longer.
const MAX_ITERATIONS: u32 = SQUARINGS + 5;

/// The linear-quadratic regulator of a discrete model, which minimizes the sum of xᵀ Q x + R u² over all steps.
///
/// `q` weights the deviation of the state: it is symmetric and positive semidefinite, by rows, in 1/rad², s/rad² and
/// s²/rad². `r` weights the torque, in 1/(N m)²; above 0. Only their ratio matters for the gain.
///
/// The structured doubling algorithm (E. K.-W. Chu, H.-Y. Fan, W.-W. Lin and C.-S. Wang, *Structure-Preserving
/// Algorithms for Periodic Discrete-Time Algebraic Riccati Equations*, 2004) solves the Riccati equation. Each iteration
/// doubles the number of steps that P accounts for. It has converged when no element changes by more than the scalar's
/// machine epsilon times the largest element; about ten iterations do. Then the closed loop A − B K must be stable: one
/// of its powers up to 2²⁰ must be less than 1 in norm.
///
/// ```
/// use acrobot::physics::control::{Discrete, lqr};
///
/// // A force moves a mass of 1 kg in steps of 0.1 s: position and velocity are the first and the third number. The
/// // others decay.
/// let a: [[f64; 4]; 4] = [[1.0, 0.0, 0.1, 0.0], [0.0, 0.5, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 0.5]];
/// let model = Discrete { a, b: [0.005, 0.0, 0.1, 0.0] };
/// let q = [[1.0, 0.0, 0.0, 0.0], [0.0; 4], [0.0; 4], [0.0; 4]];
/// let regulator = lqr(&model, &q, 1.0)?;
/// assert!((regulator.gain[0] - 0.9317).abs() < 1e-4 && regulator.gain[1] == 0.0);
/// # Ok::<(), acrobot::Error>(())
/// ```
///
/// # Errors
///
/// - [`Error::OutOfRange`] for an `r` that is not above 0.
/// - [`Error::NotFinite`] for an element of the model or of `q` that is not finite.
/// - [`Error::NotSymmetric`] and [`Error::NotSemidefinite`] for such a `q`. Elements smaller than 16 machine epsilons of
///   the largest one count as 0.
/// - [`Error::NotStabilized`] if the iteration does not converge, or to no stable closed loop: the torque cannot reach
///   an unstable motion, `q` does not weight it, the closed loop takes a million steps, or the scalar is too coarse.
pub fn lqr<S: Real>(model: &Discrete<S>, q: &[[S; 4]; 4], r: S) -> Result<Lqr<S>, Error> {
    let Discrete { a, b } = model;
    check_finite("a", a.as_flattened())?;
    check_finite("b", b)?;
    check_finite("q", q.as_flattened())?;
    check_symmetric(q)?;
    check_semidefinite(q)?;
    Range::AboveZero.check("r", r.to_f64(), "per (N m)²")?;

    let Some((cost_to_go, iterations)) = riccati(a, *b, q, r) else {
        return Err(Error::NotStabilized);
    };
    let cost_b = apply(&cost_to_go, *b);
    let inverse = S::ONE / (r + dot(*b, cost_b));
    let gain = apply(&transpose(a), cost_b).map(|x| x * inverse);
    let closed = sum(*a, S::MINUS_ONE, &outer(*b, gain));
    if !is_finite(&cost_to_go) || !is_stable(closed) {
        return Err(Error::NotStabilized);
    }
    Ok(Lqr {
        gain,
        cost_to_go,
        iterations,
    })
}

/// P and the number of iterations, if they converge.
///
/// With A, G = B Bᵀ / R and P = Q for one step, the iteration computes the same for twice as many steps:
/// P + Aᵀ P W⁻¹ A, G + A W⁻¹ G Aᵀ and A W⁻¹ A, where W = 1 + G P.
fn riccati<S: Real>(a: &Matrix<S>, b: [S; 4], q: &Matrix<S>, r: S) -> Option<(Matrix<S>, u32)> {
    let (mut a, mut g, mut p) = (*a, outer(b, b.map(|b| b / r)), *q);
    for iteration in 1..=MAX_ITERATIONS {
        let w = sum(identity(), S::ONE, &product(&g, &p));
        let (w_a, w_g) = (solve(&w, &a)?, solve(&w, &g)?);
        let transposed = transpose(&a);
        let change = symmetric(&product(&transposed, &product(&p, &w_a)));
        p = sum(p, S::ONE, &change);
        if largest(&change) <= S::EPSILON * largest(&p) {
            return Some((p, iteration));
        }
        g = sum(
            g,
            S::ONE,
            &symmetric(&product(&a, &product(&w_g, &transposed))),
        );
        a = product(&a, &w_a);
    }
    None
}

/// Whether the powers of `m` vanish within 2²⁰ steps, by squaring. They do once one of them is less than 1 in norm, and
/// the norm is at most four times the largest element.
fn is_stable<S: Real>(mut m: Matrix<S>) -> bool {
    for _ in 0..=SQUARINGS {
        if !is_finite(&m) {
            return false;
        }
        if largest(&m) < S::HALF * S::HALF {
            return true;
        }
        m = product(&m, &m);
    }
    false
}

fn is_finite<S: Real>(m: &Matrix<S>) -> bool {
    m.as_flattened().iter().all(|x| x.is_finite())
}

fn check_symmetric<S: Real>(q: &Matrix<S>) -> Result<(), Error> {
    let transposed = transpose(q);
    let mut pairs = q.as_flattened().iter().zip(transposed.as_flattened());
    match pairs.find(|(upper, lower)| upper != lower) {
        Some((upper, lower)) => Err(Error::NotSymmetric {
            name: "q",
            upper: upper.to_f64(),
            lower: lower.to_f64(),
        }),
        None => Ok(()),
    }
}

/// Subtracts (column columnᵀ) / pivot for the largest pivot on the diagonal, until none is above the rounding. What
/// remains of a positive semidefinite matrix is rounding.
fn check_semidefinite<S: Real>(q: &Matrix<S>) -> Result<(), Error> {
    let mut rest = *q;
    let rounding = S::from_f64(16.0) * S::EPSILON * largest(q);
    for _ in 0..4 {
        let mut greatest = (rounding, [S::ZERO; 4]);
        for (i, row) in rest.iter().enumerate() {
            if let Some(&pivot) = row.get(i)
                && pivot > greatest.0
            {
                greatest = (pivot, *row);
            }
        }
        let (pivot, row) = greatest;
        for (x, factor) in rest.iter_mut().zip(row) {
            *x = x.along(-(factor / pivot), row);
        }
    }
    let most = largest(&rest);
    if most > rounding {
        return Err(Error::NotSemidefinite {
            name: "q",
            value: most.to_f64(),
        });
    }
    Ok(())
}
