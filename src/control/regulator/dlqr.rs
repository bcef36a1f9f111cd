//! The linear-quadratic regulator of a model of one step.

use super::double::narrow;
use super::riccati::Problem;
use crate::control::model::StepModel;
use crate::error::{Error, Range};
use crate::math::Real;
use crate::math::matrix::{Matrix, add, add_scaled, check_finite, dot, largest, scale, transpose};

/// A linear-quadratic regulator: of all state feedbacks that make every deviation vanish, the one
/// with the least sum of xᵀ Q x + R u² over all steps, or the least integral over all time.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Lqr<S = f64> {
    /// K in u = −K x, N m per rad and per rad/s.
    pub gain: [S; 4],
    /// P, symmetric: xᵀ P x is the sum or the integral from x on.
    pub cost_to_go: [[S; 4]; 4],
}

impl<S: Real> Lqr<S> {
    /// The torque −K x, N m, for a [deviation](crate::State::deviation_from) x from the state of
    /// the linearization, rad and rad/s. Add the torque of the linearization, and
    /// [`saturate`](crate::physics::saturate) the sum to that of a motor. For an extreme deviation
    /// it can be infinite or NaN.
    #[must_use]
    pub fn torque(&self, x: [S; 4]) -> S {
        -dot(self.gain, x)
    }
}

/// The [linear-quadratic regulator](Lqr) of a model of one step: the discrete one.
///
/// `q` weights the deviation, by rows, 1/rad², s/rad² and s²/rad²: symmetric and positive
/// semidefinite, both up to 16 machine epsilons of its largest element. `r` weights the torque,
/// 1/(N m)²; above 0. The gain depends only on their ratio.
///
/// Both scalars are computed in `f64`.
///
/// The structured doubling algorithm (E. K.-W. Chu, H.-Y. Fan, W.-W. Lin and C.-S. Wang,
/// *Structure-Preserving Algorithms for Periodic Discrete-Time Algebraic Riccati Equations*, 2004)
/// finds a gain. Newton's method (G. A. Hewer, *An Iterative Technique for the Computation of the
/// Steady State Gains for the Discrete Optimal Regulator*, 1971), with residuals in twice the
/// digits of `f64`, makes it exact up to rounding.
///
/// ```
/// use acrobot::control::regulator::dlqr;
/// use acrobot::physics::Pendulum;
/// use acrobot::{Params, Portable, State};
///
/// let params = Params { dt: 0.02, ..Params::DEFAULT };
/// let upright = Pendulum::<Portable>::new(params, State::UPRIGHT)?;
/// let q = [[1.0, 0.0, 0.0, 0.0], [0.0; 4], [0.0; 4], [0.0; 4]]; // θ1 alone
/// let lqr = dlqr(&upright.linearize_step(0.0)?, &q, 1.0)?;
/// assert!(lqr.torque([0.01, 0.0, 0.0, 0.0]) > 0.0); // against a lean
/// # Ok::<(), acrobot::Error>(())
/// ```
///
/// A model in continuous time does not compile:
///
/// ```compile_fail,E0308
/// # use acrobot::control::regulator::dlqr;
/// # use acrobot::physics::Pendulum;
/// # use acrobot::{Params, Portable, State};
/// # let upright = Pendulum::<Portable>::new(Params::DEFAULT, State::UPRIGHT)?;
/// # let q = [[1.0, 0.0, 0.0, 0.0], [0.0; 4], [0.0; 4], [0.0; 4]];
/// let lqr = dlqr(&upright.linearize(0.0)?, &q, 1.0)?;
/// # Ok::<(), acrobot::Error>(())
/// ```
///
/// # Errors
///
/// [`Error::OutOfRange`] for an `r` that is not above 0; `NotFinite`, `NotSymmetric`,
/// `NotSemidefinite`, `NotStabilizable`, `NotDetectable` and `IllConditioned`.
pub fn dlqr<S: Real>(model: &StepModel<S>, q: &[[S; 4]; 4], r: S) -> Result<Lqr<S>, Error> {
    let problem: Problem<true> = problem(&model.a, &model.b, q, r)?;
    let ([gain], cost_to_go, unit) = problem.solve()?;
    let mut cost_to_go = narrow(&cost_to_go);
    scale(&mut cost_to_go, unit);
    rounded(&gain, &cost_to_go, |gain| problem.is_stable(&[*gain]))
}

/// A checked problem.
pub(super) fn problem<S: Real, const STEPS: bool>(
    a: &Matrix<S>,
    b: &[S; 4],
    q: &Matrix<S>,
    r: S,
) -> Result<Problem<STEPS>, Error> {
    let [a, mut q] = [a, q].map(|m| m.map(|row| row.map(S::to_f64)));
    let (b, r) = (b.map(S::to_f64), r.to_f64());
    check_finite_f64("a", a.as_flattened())?;
    check_finite_f64("b", &b)?;
    check_weights("q", &mut q, S::EPSILON.to_f64())?;
    Range::AboveZero.check("r", r, "per (N m)²")?;
    Ok(Problem { a, inputs: [(b, r)], q })
}

/// A regulator whose gain is stable as the scalar rounds it.
pub(super) fn rounded<S: Real>(
    gain: &[f64; 4],
    cost_to_go: &Matrix,
    is_stable: impl Fn(&[f64; 4]) -> bool,
) -> Result<Lqr<S>, Error> {
    let regulator =
        Lqr { gain: gain.map(S::from_f64), cost_to_go: cost_to_go.map(|row| row.map(S::from_f64)) };
    check_finite("gain", &regulator.gain)?;
    check_finite("cost_to_go", regulator.cost_to_go.as_flattened())?;
    match is_stable(&regulator.gain.map(S::to_f64)) {
        true => Ok(regulator),
        false => Err(Error::IllConditioned { error: S::EPSILON.to_f64() }),
    }
}

/// Checks weights, and makes them symmetric to the last digit: products such as G W Gᵀ are so only
/// up to rounding. `epsilon` is that of the scalar in which they were given.
#[inline(never)] // saves flash
pub(in crate::control) fn check_weights(
    name: &'static str,
    q: &mut Matrix,
    epsilon: f64,
) -> Result<(), Error> {
    check_finite_f64(name, q.as_flattened())?;
    let rounding = 16.0 * epsilon * largest(q.as_flattened());
    for (row, column) in q.iter().zip(&transpose(q)) {
        check_symmetric(name, row, column, rounding)?;
    }
    scale(q, 0.5); // before the sum, which would overflow
    let transposed = transpose(q);
    add(q, 1.0, &transposed);
    check_semidefinite(name, q, rounding)
}

#[inline(never)] // saves flash
fn check_finite_f64(name: &'static str, elements: &[f64]) -> Result<(), Error> {
    check_finite(name, elements)
}

#[inline(never)] // saves flash
fn check_symmetric(
    name: &'static str,
    row: &[f64; 4],
    column: &[f64; 4],
    rounding: f64,
) -> Result<(), Error> {
    for (&upper, &lower) in row.iter().zip(column) {
        if (upper - lower).abs() > rounding {
            return Err(Error::NotSymmetric { name, upper, lower });
        }
    }
    Ok(())
}

/// Subtracts (column columnᵀ) / pivot for the largest pivot on the diagonal, until none is above
/// the rounding. Then only rounding remains of a positive semidefinite matrix.
fn check_semidefinite(name: &'static str, q: &Matrix, rounding: f64) -> Result<(), Error> {
    #[inline(never)] // saves flash
    fn subtract(rest: &mut Matrix, rounding: f64) {
        let mut greatest = (rounding, [0.0; 4]);
        for (i, row) in rest.iter().enumerate() {
            if let Some(&pivot) = row.get(i)
                && pivot > greatest.0
            {
                greatest = (pivot, *row);
            }
        }
        let (pivot, row) = greatest;
        for (x, factor) in rest.iter_mut().zip(row) {
            add_scaled(x, -(factor / pivot), &row);
        }
    }

    let mut rest = *q;
    for _ in 0..4 {
        subtract(&mut rest, rounding);
    }
    match largest(rest.as_flattened()) {
        value if value > rounding => Err(Error::NotSemidefinite { name, value }),
        _ => Ok(()),
    }
}
