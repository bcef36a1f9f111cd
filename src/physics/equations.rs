//! The equations of motion in the form that the arithmetic names, for one number or for many at
//! once.

use super::arithmetic::Arithmetic;
use super::bounds::wrap_each;
use super::model::{Form, Model};
use super::{gymnasium, lean};
use crate::math::{Numbers, SinCos};

/// The derivative at `y` = \[θ1, θ2, θ̇1, θ̇2\] under a torque, N m. `sin_cos` are the sines and
/// cosines of θ1 and θ2, if they are known.
#[inline(always)]
pub(super) fn derivative<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &Model<V>,
    y: [V; 4],
    sin_cos: Option<[SinCos<V>; 2]>,
    torque: V,
) -> [V; 4] {
    match A::FORM {
        Form::Lean => lean::derivative::<A, V>(model, y, sin_cos, torque),
        Form::Gymnasium => gymnasium::derivative::<A, V>(model, y, sin_cos, torque),
    }
}

/// The angle `x`, rad, wrapped to \[−π, π\] by whole turns.
#[inline(always)]
pub(super) fn wrap<A: Arithmetic, V: Numbers<A::Scalar>>(x: V) -> V {
    match A::FORM {
        Form::Lean => wrap_each(x),
        Form::Gymnasium => gymnasium::wrap(x),
    }
}
