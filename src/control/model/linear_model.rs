//! The derivatives of the equations of motion.

use super::partials::partials;
use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::math::Real;
use crate::math::matrix::check_finite;
use crate::physics::{Pendulum, check_torque};

/// A linear model in continuous time, ẋ = A x + B u: x is the deviation from a state \[θ1, θ2, θ̇1,
/// θ̇2\], rad and rad/s, and u that from a torque, N m. [`lqr`](crate::control::regulator::lqr) has
/// its regulator.
///
/// ```
/// use acrobot::{Params, Portable, State, control::model::LinearModel, physics::Pendulum};
///
/// let LinearModel { a, .. } = Pendulum::<Portable>::hanging().linearize(0.0)?;
/// let leaning = State { theta1: 1e-3, ..State::HANGING }; // rad
/// let [.., ddtheta1, _] = Pendulum::<Portable>::new(Params::DEFAULT, leaning)?.derivative(0.0);
/// assert!((ddtheta1 - a[2][0] * 1e-3).abs() < 1e-8); // rad/s²
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LinearModel<S = f64> {
    /// A by rows: `a[i][j]` is the derivative of the i-th rate by the j-th number of the state.
    pub a: [[S; 4]; 4],
    /// B: the derivatives of the rates by the torque.
    pub b: [S; 4],
}

impl<A: Arithmetic> Pendulum<A> {
    /// Linearizes the equations of motion about the state and a torque, N m: exact up to rounding.
    ///
    /// The state need not be an equilibrium. Bounds of the velocities do not count.
    ///
    /// ```
    /// use acrobot::physics::Pendulum;
    /// use acrobot::{Params, Portable, State};
    ///
    /// let upright = Pendulum::<Portable>::new(Params::DEFAULT, State::UPRIGHT)?;
    /// let model = upright.linearize(0.0)?;
    /// assert!(model.a[2][0] > 0.0); // link 1 falls
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a torque that is not finite, and [`Error::NotFinite`] if an
    /// element overflows.
    pub fn linearize(&self, torque: A::Scalar) -> Result<LinearModel<A::Scalar>, Error> {
        check_torque(torque)?;
        let (zero, one) = (A::Scalar::ZERO, A::Scalar::from_f64(1.0));
        let y = self.state().into();
        let (_, [by_state @ .., by_torque]) =
            partials::<A>(self.model(), y, self.sin_cos(), torque);
        let model = LinearModel {
            a: [
                [zero, zero, one, zero],
                [zero, zero, zero, one],
                by_state.map(|[ddtheta1, _]| ddtheta1),
                by_state.map(|[_, ddtheta2]| ddtheta2),
            ],
            b: [zero, zero, by_torque[0], by_torque[1]],
        };
        check_finite("a", model.a.as_flattened())?;
        check_finite("b", &model.b)?;
        Ok(model)
    }
}
