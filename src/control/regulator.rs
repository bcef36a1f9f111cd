//! The regulator of an equilibrium.

use super::error::ControlError;
use super::linearize_step::linearize_step;
use super::lqr::{Lqr, lqr};
use super::units::Units;
use crate::arithmetic::Arithmetic;
use crate::math::Real;
use crate::math::sealed::Sealed as _;
use crate::physics::Pendulum;

/// The largest acceleration in equilibrium, 1/T²: far above rounding.
const LARGEST: f64 = 2.5e-3;

/// The [regulator](lqr) that holds a pendulum in its state, which must be in equilibrium under
/// `torque`, N m: [an example](crate::guide::control).
///
/// # Errors
///
/// [`ControlError::NotInEquilibrium`] for a velocity that is not 0, or an acceleration above 0.25 %
/// of that with which the straight machine, when it is horizontal, falls and is turned by `torque`:
/// 0.011 rad/s² for Gymnasium's machine without a torque. Those of [`linearize_step`] and [`lqr`].
pub fn regulator<A: Arithmetic>(
    pendulum: &Pendulum<A>,
    torque: A::Scalar,
    q: &[[A::Scalar; 4]; 4],
    r: A::Scalar,
) -> Result<Lqr<A::Scalar>, ControlError> {
    let model = linearize_step(pendulum, torque)?;
    let rates = pendulum.derivative(torque).map(Real::to_f64);
    let Units { time, .. } = Units::new(pendulum.params(), torque.abs());
    let largest = LARGEST / time / time;
    for (rate, most) in rates.into_iter().zip([0.0, 0.0, largest, largest]) {
        if !(-most..=most).contains(&rate) {
            return Err(ControlError::NotInEquilibrium { rate, largest });
        }
    }
    lqr(&model, q, r)
}
