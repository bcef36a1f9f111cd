//! The trait that determines every bit of a step, and what it decides about parameters.

use core::fmt;

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

    /// Whether the joints can have friction, as in [`Damped`](crate::arithmetic::Damped).
    const HAS_FRICTION: bool = false;

    /// Sine and cosine of `x` rad. Both must be within \[−1, 1\] for every finite `x`.
    fn sin_cos(x: Self::Scalar) -> (Self::Scalar, Self::Scalar);

    /// Sines and cosines of one angle or of many, bit-identical to [`sin_cos`](Self::sin_cos) for
    /// |x| ≤ 2¹⁹ rad. Beyond, any result is valid, even NaN. Steps call it for speed.
    #[inline(always)]
    fn sin_cos_near<V: Numbers<Self::Scalar>>(x: V) -> (V, V) {
        x.map_unzip(Self::sin_cos)
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
        assert!(G::PARAMS.check(true).is_ok(), "a parameter is out of range");
        let suits = G::PARAMS.check(A::HAS_FRICTION).is_ok();
        assert!(suits, "the arithmetic must be Damped, because the parameters have friction");
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
    A::Scalar::model(A::FORM, A::HAS_FRICTION, params, lengths.map(A::square))
}

/// Checks parameters, and that there is no friction where the arithmetic has none.
pub(crate) fn check_params<A: Arithmetic>(params: &Params<impl Modeled>) -> Result<(), Error> {
    Modeled::check(params, A::HAS_FRICTION)
}
