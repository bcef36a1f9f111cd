//! The trait that determines every bit of a step, and what it decides about parameters.

use core::fmt;

use super::friction::Viscous;
use super::model::{Form, Given, Model, Modeled, Models};
use super::params::Params;
use crate::error::Error;
use crate::math::Numbers;

/// The numbers that an acrobot computes with: a scalar, its sines and the form of the equations.
/// They determine every bit of a result.
///
/// [These types](crate::arithmetic#structs) implement it. Implement it [for a hardware sine
/// unit](crate::arithmetic).
pub trait Arithmetic: Copy + fmt::Debug + Default + PartialEq + Send + Sync + 'static {
    /// A short name in lower case, such as "fast". Snapshots hold it, so no other arithmetic can
    /// load them. With more than 16 bytes, code that saves or loads a snapshot does not compile.
    const NAME: &'static str;

    /// The type of angles, velocities, torques and parameters.
    type Scalar: Modeled;

    /// How the equations of motion are evaluated.
    const FORM: Form = Form::Lean;

    /// Whether the joints can have [friction](Viscous), as in
    /// [`Damped`](crate::arithmetic::Damped).
    const HAS_FRICTION: bool = false;

    /// Sine and cosine of `x` rad. Both must be within \[−1, 1\] for every finite `x`.
    fn sin_cos(x: Self::Scalar) -> (Self::Scalar, Self::Scalar);

    /// Sines and cosines of one angle or of many, bit-identical to [`sin_cos`](Self::sin_cos) for
    /// |x| ≤ 2¹⁹ rad. Beyond, any result is valid, even NaN. Steps call it for speed.
    #[inline(always)]
    fn sin_cos_near<V: Numbers<Self::Scalar>>(x: V) -> (V, V) {
        x.map2(Self::sin_cos)
    }

    /// The cosines of [`sin_cos_near`](Self::sin_cos_near). Only [`Form::Gymnasium`] calls it.
    #[inline(always)]
    fn cos_near<V: Numbers<Self::Scalar>>(x: V) -> V {
        Self::sin_cos_near(x).1
    }

    /// The square of `x`: only `Host` replaces it.
    #[doc(hidden)]
    #[inline]
    fn square(x: Self::Scalar) -> Self::Scalar {
        x * x
    }

    /// Whether `square` is x · x, as a `const` computes it.
    #[doc(hidden)]
    const SQUARES_IN_CONST: bool = true;
}

/// The model of given parameters, which must suit the arithmetic.
pub(crate) const fn default_model<A: Arithmetic, G: Given>() -> Model<A::Scalar> {
    const {
        let Viscous { joint1, joint2 } = G::PARAMS.friction;
        let suits = check_friction::<A>([joint1, joint2]).is_ok();
        assert!(suits, "the arithmetic must be Damped, because the parameters have friction");
        assert!(G::PARAMS.check().is_ok(), "a parameter is out of range");
    }
    match A::FORM {
        Form::Lean => <A::Scalar as Modeled>::Of::<G>::LEAN,
        Form::Gymnasium => <A::Scalar as Modeled>::Of::<G>::GYMNASIUM,
    }
}

/// The model of valid parameters.
#[inline]
pub(crate) fn model<A: Arithmetic>(params: Params<A::Scalar>) -> Model<A::Scalar> {
    let lengths = [params.length1, params.center_of_mass1, params.center_of_mass2];
    A::Scalar::model(A::FORM, params, lengths.map(A::square))
}

/// Checks parameters, and that there is no friction where the arithmetic has none.
pub(crate) fn check_params<A: Arithmetic>(params: &Params<impl Modeled>) -> Result<(), Error> {
    params.validate()?;
    let Viscous { joint1, joint2 } = params.friction;
    check_friction::<A>([joint1.to_f64(), joint2.to_f64()])
}

/// Checks that both coefficients are 0 where the arithmetic has no friction.
pub(super) const fn check_friction<A: Arithmetic>(friction: [f64; 2]) -> Result<(), Error> {
    let (name, value) = match friction {
        _ if A::HAS_FRICTION => return Ok(()),
        [0.0, 0.0] => return Ok(()),
        [0.0, joint2] => ("friction.joint2", joint2),
        [joint1, _] => ("friction.joint1", joint1),
    };
    let rule = "0 unless the arithmetic is Damped, in";
    Err(Error::OutOfRange { name, value, unit: "N m s/rad", rule })
}

/// A torque less that of a joint's friction, N m.
#[inline(always)]
pub(super) fn resist<A: Arithmetic, V: Numbers<A::Scalar>>(torque: V, joint: V, dtheta: V) -> V {
    match A::HAS_FRICTION {
        true => torque - joint * dtheta,
        false => torque,
    }
}
