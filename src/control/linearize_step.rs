//! The derivatives of a step.

use super::error::ControlError;
use super::linearize::{LinearModel, partials};
use super::matrix::{check_finite, dot, identity, transpose};
use crate::arithmetic::Arithmetic;
use crate::math::{Real, SinCos};
use crate::physics::{Model, Pendulum, check_torque, plus_scaled};

/// Linearizes one step of `dt` about the pendulum's state and a torque, N m, which is constant
/// during the step: A and B of x′ = A x + B u.
///
/// They are the derivatives of the Runge-Kutta step, exact up to rounding, and not a matrix
/// exponential. The state need not be an equilibrium: x′ is the deviation from the state after the
/// step.
///
/// ```
/// use acrobot::physics::Pendulum;
/// use acrobot::control::linearize_step;
/// use acrobot::{Params, Portable, State};
///
/// let upright = Pendulum::<Portable>::new(Params::DEFAULT, State::UPRIGHT)?;
/// let model = linearize_step(&upright, 0.0)?;
///
/// let mut pushed = upright.clone();
/// pushed.step(1e-6)?; // N m
/// assert!((pushed.state().dtheta2 - model.b[3] * 1e-6).abs() < 1e-11);
/// # Ok::<(), acrobot::control::ControlError>(())
/// ```
///
/// # Errors
///
/// Those of [`linearize`](super::linearize).
pub fn linearize_step<A: Arithmetic>(
    pendulum: &Pendulum<A>,
    torque: A::Scalar,
) -> Result<LinearModel<A::Scalar>, ControlError> {
    check_torque(torque)?;
    let model = pendulum.model();
    let common = &model.constants;
    let (half, dt, sixth) = (common.half_dt, model.params.dt, common.sixth_dt);
    let third = sixth + sixth;
    let [by1, by2, by3, by4] = identity();
    let before = Sensitive {
        y: pendulum.state().into(),
        columns: [by1, by2, by3, by4, [A::Scalar::ZERO; 4]],
    };
    let mut k = rates::<A>(model, &before, pendulum.sin_cos(), torque);
    let mut after = before.plus_scaled(sixth, &k);
    // The other stages of the Runge-Kutta step.
    for (h, weight) in [(half, third), (half, third), (dt, sixth)] {
        let x = before.plus_scaled(h, &k);
        let [theta1, theta2, ..] = x.y;
        k = rates::<A>(model, &x, [theta1, theta2].map(A::sin_cos_near), torque);
        after = after.plus_scaled(weight, &k);
    }
    let [columns @ .., b] = after.columns;
    let a = transpose(&columns);
    let model = LinearModel { a, b };
    check_finite("a", model.a.as_flattened())?;
    check_finite("b", &model.b)?;
    Ok(model)
}

/// A state, and its derivatives by the four numbers of an earlier state and by the torque.
#[derive(Clone, Copy)]
struct Sensitive<S> {
    y: [S; 4],
    columns: [[S; 4]; 5],
}

impl<S: Real> Sensitive<S> {
    /// self + h k.
    fn plus_scaled(mut self, h: S, k: &Self) -> Self {
        self.y = plus_scaled(self.y, h, k.y);
        for (column, k) in self.columns.iter_mut().zip(k.columns) {
            *column = plus_scaled(*column, h, k);
        }
        self
    }
}

/// The equations of motion with their variational equations. A Runge-Kutta step of both gives the
/// state after a step and its exact derivatives. `sin_cos` are the sines and cosines of θ1 and θ2.
#[inline(never)] // saves flash: it is called in two places
fn rates<A: Arithmetic>(
    model: &Model<A::Scalar>,
    x: &Sensitive<A::Scalar>,
    sin_cos: [SinCos<A::Scalar>; 2],
    torque: A::Scalar,
) -> Sensitive<A::Scalar> {
    let ([ddtheta1, ddtheta2], [by_state @ .., by_torque]) =
        partials::<A>(model, x.y, sin_cos, torque);
    let [_, _, dtheta1, dtheta2] = x.y;
    let y = [dtheta1, dtheta2, ddtheta1, ddtheta2];
    let ddtheta1 = by_state.map(|[ddtheta1, _]| ddtheta1);
    let ddtheta2 = by_state.map(|[_, ddtheta2]| ddtheta2);
    let mut columns = x.columns.map(|x| {
        let [_, _, dtheta1, dtheta2] = x;
        [dtheta1, dtheta2, dot(ddtheta1, x), dot(ddtheta2, x)]
    });
    let [.., [_, _, ddtheta1, ddtheta2]] = &mut columns;
    *ddtheta1 = *ddtheta1 + by_torque[0];
    *ddtheta2 = *ddtheta2 + by_torque[1];
    Sensitive { y, columns }
}
