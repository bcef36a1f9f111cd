//! The linear-quadratic regulator of a finite time: the gains along a trajectory.

use crate::control::model::StepModel;
use crate::error::{Error, Range};
use crate::math::Real;
use crate::math::matrix::{Matrix, check_finite, dot, transpose};
use crate::physics::plus_scaled;

/// The time-varying linear-quadratic regulator along a trajectory: of all torques, those with the
/// least sum of xᵀ Q x + R u² over its steps and xᵀ P x after them.
///
/// `models` are those of the steps in their order, with `q` and `r` as in
/// [`dlqr`](super::dlqr::dlqr), and `cost_to_go` is P, symmetric and positive semidefinite. Writes
/// K of u = −K x for each step, N m per rad and per rad/s. Returns P before the first step.
///
/// ```
/// use acrobot::control::regulator::tvlqr;
/// use acrobot::physics::Pendulum;
/// use acrobot::{Params, Portable, State};
///
/// let upright = Pendulum::<Portable>::new(Params::DEFAULT, State::UPRIGHT)?;
/// let q = [[1.0, 0.0, 0.0, 0.0], [0.0; 4], [0.0; 4], [0.0; 4]]; // θ1 alone
/// let mut gains = [[0.0; 4]; 10];
/// tvlqr(&[upright.linearize_step(0.0)?; 10], &q, 1.0, &q, &mut gains)?;
/// assert!(gains[0][0] < gains[9][0]); // weaker near the end
/// # Ok::<(), acrobot::Error>(())
/// ```
///
/// # Errors
///
/// [`Error::WrongLength`] for other than one gain for each model, [`Error::OutOfRange`] for an `r`
/// that is not above 0, and [`Error::NotFinite`] for a result that overflows.
pub fn tvlqr<S: Real>(
    models: &[StepModel<S>],
    q: &[[S; 4]; 4],
    r: S,
    cost_to_go: &[[S; 4]; 4],
    gains: &mut [[S; 4]],
) -> Result<[[S; 4]; 4], Error> {
    Range::AboveZero.check("r", r.to_f64(), "per (N m)²")?;
    let (len, expected) = (gains.len(), models.len());
    if len != expected {
        return Err(Error::WrongLength { name: "gains", len, expected });
    }
    let mut cost = *cost_to_go;
    for (model, gain) in models.iter().zip(gains).rev() {
        *gain = back_up(model, q, r, &mut cost)?;
    }
    check_finite("cost_to_go", cost.as_flattened())?;
    Ok(cost)
}

/// The gain of a step before a cost P, which becomes that before the step.
#[inline(never)] // saves flash
pub(in crate::control) fn back_up<S: Real>(
    StepModel { a, b }: &StepModel<S>,
    q: &Matrix<S>,
    r: S,
    cost: &mut Matrix<S>,
) -> Result<[S; 4], Error> {
    let cost_b = cost.map(|row| dot(row, *b));
    let divisor = dot(*b, cost_b) + r;
    let mut columns = transpose(a);
    let gain = columns.map(|column| dot(column, cost_b) / divisor);
    // Those of A − B K.
    for (column, k) in columns.iter_mut().zip(gain) {
        *column = plus_scaled(*column, -k, *b);
    }
    let curved = columns.map(|column| cost.map(|row| dot(row, column)));
    *cost = columns.map(|column| curved.map(|curved| dot(column, curved)));
    for ((row, own), k) in cost.iter_mut().zip(q).zip(gain) {
        *row = plus_scaled(plus_scaled(*row, S::ONE, *own), r * k, gain);
    }
    check_finite("gain", &gain)?;
    Ok(gain)
}
