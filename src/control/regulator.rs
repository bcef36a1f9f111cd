//! The regulator of an equilibrium.

use super::error::ControlError;
use super::linearize_step::linearize_step;
use super::lqr::{Lqr, lqr};
use crate::arithmetic::Arithmetic;
use crate::math::Real;
use crate::physics::Pendulum;

/// The largest acceleration in equilibrium, rad/s²: far above rounding.
const LARGEST: f64 = 0.01;

/// The [regulator](lqr) that holds a pendulum in its state, which must be in equilibrium under
/// `torque`, N m: [an example](crate::guide::control).
///
/// # Errors
///
/// [`ControlError::NotInEquilibrium`] for a velocity that is not 0 or an acceleration above
/// 0.01 rad/s², and those of [`linearize_step`] and [`lqr`].
pub fn regulator<A: Arithmetic>(
    pendulum: &Pendulum<A>,
    torque: A::Scalar,
    q: &[[A::Scalar; 4]; 4],
    r: A::Scalar,
) -> Result<Lqr<A::Scalar>, ControlError> {
    let model = linearize_step(pendulum, torque)?;
    let rates = pendulum.derivative(torque).map(Real::to_f64);
    for (rate, largest) in rates.into_iter().zip([0.0, 0.0, LARGEST, LARGEST]) {
        if !(-largest..=largest).contains(&rate) {
            return Err(ControlError::NotInEquilibrium { rate });
        }
    }
    lqr(&model, q, r)
}
