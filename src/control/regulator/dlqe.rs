//! The steady-state Kalman filter of a model of one step.

use super::dlqr::check_weights;
use super::double::narrow;
use super::riccati::Problem;
use crate::control::model::StepModel;
use crate::error::{Error, Range};
use crate::math::Real;
use crate::math::matrix::{apply, check_finite, identity, scale, transpose};

/// A steady-state Kalman filter: of all linear filters, the one with the least variances of its
/// errors after many steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Lqe<S = f64> {
    /// L by rows: the correction of each deviation by both measured angles. python-control's L is
    /// A L, which also predicts the step.
    pub gain: [[S; 2]; 4],
    /// P, symmetric: the covariance of the errors before the correction, as python-control's P.
    pub prior_covariance: [[S; 4]; 4],
}

impl<S: Real> Lqe<S> {
    /// The deviation x, rad and rad/s, corrected by the measured deviations y of both angles, rad.
    #[must_use]
    pub fn correct(&self, mut x: [S; 4], [y1, y2]: [S; 2]) -> [S; 4] {
        let [x1, x2, ..] = x;
        for (x, [l1, l2]) in x.iter_mut().zip(self.gain) {
            *x = *x + l1 * (y1 - x1) + l2 * (y2 - x2);
        }
        x
    }
}

/// The [steady-state Kalman filter](Lqe) of a model of one step whose angles are measured.
///
/// `w` is the covariance of the noise that each step adds to x, by rows, rad², rad²/s and rad²/s²:
/// symmetric and positive semidefinite, both up to 16 machine epsilons of its largest element. `s`
/// are the variances of both measurements, rad²; above 0. The gain depends only on their ratios.
///
/// A filter is the regulator of the transposed model, so all else is as in
/// [`dlqr`](super::dlqr::dlqr).
///
/// ```
/// use acrobot::control::regulator::dlqe;
/// use acrobot::physics::Pendulum;
/// use acrobot::{Params, Portable, State};
///
/// let upright = Pendulum::<Portable>::new(Params::DEFAULT, State::UPRIGHT)?;
/// let w = [[0.0; 4], [0.0; 4], [0.0, 0.0, 1e-4, 0.0], [0.0, 0.0, 0.0, 1e-4]];
/// let lqe = dlqe(&upright.linearize_step(0.0)?, &w, [1e-6; 2])?;
/// let [x1, _, dx1, _] = lqe.correct([0.0; 4], [0.01, 0.0]);
/// assert!(x1 > 0.0 && dx1 > 0.0);
/// # Ok::<(), acrobot::Error>(())
/// ```
///
/// # Errors
///
/// [`Error::OutOfRange`] for a variance that is not above 0; `NotFinite`, `NotSymmetric`,
/// `NotSemidefinite`, `NotObservable`, `NotExcited` and `IllConditioned`.
pub fn dlqe<S: Real>(model: &StepModel<S>, w: &[[S; 4]; 4], s: [S; 2]) -> Result<Lqe<S>, Error> {
    let a = model.a.map(|row| row.map(S::to_f64));
    check_finite("a", a.as_flattened())?;
    let mut q = w.map(|row| row.map(S::to_f64));
    check_weights("w", &mut q, S::EPSILON.to_f64())?;
    let s = s.map(S::to_f64);
    for s in s {
        Range::AboveZero.check("s", s, "rad²")?;
    }
    let [angle1, angle2, ..] = identity();
    let inputs = |unit| [(angle1, s[0] / unit), (angle2, s[1] / unit)];
    let dual = Problem::<true, 2> { a: transpose(&a), inputs: inputs(1.0), q };
    let (_, covariance, unit) = dual.solve().map_err(|error| match error {
        Error::NotStabilizable => Error::NotObservable,
        Error::NotDetectable => Error::NotExcited,
        error => error,
    })?;
    // Without A, which predicts.
    let filter = Problem::<true, 2> { a: identity(), inputs: inputs(unit), q };
    let rows = filter.gain(&covariance).0.map(|row| row.map(S::from_f64));
    let mut covariance = narrow(&covariance);
    scale(&mut covariance, unit);

    let [row1, row2] = rows;
    let gain = transpose(&[row1, row2, row1, row2]).map(|[x, y, ..]| [x, y]);
    let prior_covariance = covariance.map(|row| row.map(S::from_f64));
    check_finite("gain", gain.as_flattened())?;
    check_finite("prior_covariance", prior_covariance.as_flattened())?;
    match dual.is_stable(&rows.map(|row| apply(&a, &row.map(S::to_f64)))) {
        true => Ok(Lqe { gain, prior_covariance }),
        false => Err(Error::IllConditioned { error: S::EPSILON.to_f64() }),
    }
}
