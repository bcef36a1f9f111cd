//! The regulator of an equilibrium.

use super::dlqr::{Lqr, dlqr};
use crate::arithmetic::Arithmetic;
use crate::control::units::Units;
use crate::error::Error;
use crate::math::Real;
use crate::math::sealed::Sealed as _;
use crate::physics::Pendulum;

/// The largest acceleration in equilibrium, 1/T²: far above rounding.
const LARGEST: f64 = 2.5e-3;

impl<A: Arithmetic> Pendulum<A> {
    /// The [regulator](dlqr) in steps of `dt` that holds the pendulum in its state, which must be
    /// in equilibrium under `torque`, N m: [an example](crate::guide::control).
    ///
    /// # Errors
    ///
    /// [`Error::NotInEquilibrium`] for a velocity that is not 0, or an acceleration above 0.25 % of
    /// that with which the straight machine, when it is horizontal, falls and is turned by
    /// `torque`: 0.011 rad/s² for Gymnasium's machine without a torque. The errors of
    /// [`linearize_step`](Self::linearize_step) and [`dlqr`].
    pub fn regulator(
        &self,
        torque: A::Scalar,
        q: &[[A::Scalar; 4]; 4],
        r: A::Scalar,
    ) -> Result<Lqr<A::Scalar>, Error> {
        let model = self.linearize_free_step(torque)?;
        check_equilibrium(self, torque)?;
        dlqr(&model, q, r)
    }
}

/// Rejects a state that moves under a torque, N m.
pub(super) fn check_equilibrium<A: Arithmetic>(
    pendulum: &Pendulum<A>,
    torque: A::Scalar,
) -> Result<(), Error> {
    let rates = pendulum.derivative(torque).map(Real::to_f64);
    let Units { time, .. } = Units::new(pendulum.params(), torque.abs());
    let largest = LARGEST / time / time;
    for (rate, most) in rates.into_iter().zip([0.0, 0.0, largest, largest]) {
        if !(-most..=most).contains(&rate) {
            return Err(Error::NotInEquilibrium { rate, largest });
        }
    }
    Ok(())
}
