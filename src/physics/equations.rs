//! What determines every bit of a step, for one number or for many at once: an arithmetic, which names a form of the
//! equations of motion.

use core::fmt;

use super::common::Common;
use super::friction::Friction;
use super::params::Params;
use super::params_range::ParamsRange;
use super::task::Task;
use crate::math::{Numbers, Real, SinCos};

/// A scalar, its sines and the form of the equations: they determine every bit of a result.
pub trait Arithmetic: Copy + fmt::Debug + Default + PartialEq + Send + Sync + 'static {
    /// A short name in lower case, of at most 16 bytes. Snapshots hold it, so no other arithmetic can load them. The
    /// crate's names are "reference", "portable", "fast", "micro" and "host". With a longer name, code that saves or
    /// loads a snapshot does not compile.
    const NAME: &'static str;

    /// The type of angles, velocities, torques and parameters.
    type Scalar: Real;

    /// How the equations of motion are evaluated: [`Lean`](super::Lean) or [`Gymnasium`](super::Gymnasium).
    type Form: Form<Self::Scalar>;

    /// Sine and cosine of `x` rad. Both must be within \[−1, 1\] for every finite `x`.
    fn sin_cos(x: Self::Scalar) -> (Self::Scalar, Self::Scalar);

    /// Sines and cosines of one angle or of many, bit-identical to [`sin_cos`](Self::sin_cos) for |x| ≤ 2¹⁹ rad.
    /// Beyond, any result is valid, even NaN. Steps call this method for speed: it can leave out range checks, and
    /// compute many angles with SIMD.
    #[inline(always)]
    fn sin_cos_near<V: Numbers<Self::Scalar>>(x: V) -> (V, V) {
        x.zip3(x, x, |x, _, _| Self::sin_cos(x))
    }

    /// Cosine of `x` rad, bit-identical to the cosine of [`sin_cos`](Self::sin_cos).
    #[inline]
    fn cos(x: Self::Scalar) -> Self::Scalar {
        Self::sin_cos(x).1
    }

    /// The task: Gymnasium's, unless it is replaced as in [`Swingup`](crate::arithmetic::Swingup).
    const TASK: Task = Task::Acrobot;

    /// The model of the default parameters, computed by the compiler.
    #[doc(hidden)]
    const DEFAULT: Model<Self> = Model::UNDAMPED;

    /// The square of `x`: only `Host` replaces it.
    #[doc(hidden)]
    #[inline]
    fn square(x: Self::Scalar) -> Self::Scalar {
        x * x
    }
}

/// The parameters of an arithmetic: with friction if its form of the equations has it.
pub type ParamsOf<A, V = <A as Arithmetic>::Scalar> =
    Params<V, <FrictionOf<A> as Friction<<A as Arithmetic>::Scalar>>::Of<V>>;

/// A range of [`ParamsOf`].
pub type ParamsRangeOf<A> = ParamsRange<<A as Arithmetic>::Scalar, FrictionOf<A>>;

/// The friction in the parameters of an arithmetic.
pub type FrictionOf<A> = <<A as Arithmetic>::Form as Form<<A as Arithmetic>::Scalar>>::Friction;

/// The constants that the form of the equations computes from the parameters.
pub type Constants<A, V> =
    <<A as Arithmetic>::Form as Form<<A as Arithmetic>::Scalar>>::Constants<V>;

/// The parameters, and the constants that follow from them: of one acrobot or of many.
#[derive(Clone, Copy, Debug)]
pub struct Model<A: Arithmetic, V: Numbers<A::Scalar> = <A as Arithmetic>::Scalar> {
    pub(crate) params: ParamsOf<A, V>,
    pub(crate) constants: Constants<A, V>,
}

impl<A: Arithmetic, V: Numbers<A::Scalar>> Model<A, V> {
    /// Applies `f` to each pair of numbers. The dynamics are those of `self`.
    #[inline(always)]
    pub(crate) fn zip<W: Numbers<A::Scalar>>(
        &self,
        one: &Model<A>,
        f: impl Fn(V, A::Scalar) -> W + Copy,
    ) -> Model<A, W> {
        let friction = FrictionOf::<A>::zip(self.params.friction, one.params.friction, f);
        Model {
            params: self.params.zip(&one.params, f, friction),
            constants: A::Form::zip(self.constants, one.constants, f),
        }
    }
}

impl<A: Arithmetic> Model<A> {
    /// The model of [`Params::DEFAULT`], without friction.
    pub(crate) const UNDAMPED: Self = Self {
        params: Params::DEFAULT.with_friction(Friction::ZERO),
        constants: A::Form::DEFAULT,
    };

    #[inline]
    pub(crate) fn new(params: ParamsOf<A>) -> Self {
        let lengths = [
            params.length1,
            params.center_of_mass1,
            params.center_of_mass2,
        ];
        Self {
            constants: A::Form::constants(&params, lengths.map(A::square)),
            params,
        }
    }
}

/// A form of the equations of motion: [`Gymnasium`](super::Gymnasium) or [`Lean`](super::Lean), which
/// agree up to rounding. No other type can implement it.
pub trait Form<S: Real>: Copy + fmt::Debug {
    /// The friction of the joints.
    type Friction: Friction<S, Of<S> = Self::Friction>;

    /// The constants, which depend only on the parameters.
    type Constants<V: Numbers<S>>: Copy + fmt::Debug + Send + Sync;

    /// The constants of [`Params::DEFAULT`], computed by the compiler.
    #[doc(hidden)]
    const DEFAULT: Self::Constants<S>;

    /// The constants of `params`, given l1², lc1² and lc2².
    #[doc(hidden)]
    fn constants(params: &Params<S, Self::Friction>, squares: [S; 3]) -> Self::Constants<S>;

    /// The constants that both forms need.
    #[doc(hidden)]
    fn common<V: Numbers<S>>(constants: &Self::Constants<V>) -> &Common<V>;

    /// Applies `f` to each pair of constants.
    #[doc(hidden)]
    fn zip<V: Numbers<S>, W: Numbers<S>>(
        constants: Self::Constants<V>,
        numbers: Self::Constants<S>,
        f: impl Fn(V, S) -> W + Copy,
    ) -> Self::Constants<W>;

    /// Whether the Runge-Kutta step adds each stage to the result at once, instead of in Gymnasium's order.
    #[doc(hidden)]
    const COMPACT: bool;

    /// The derivative at `y` = \[θ1, θ2, θ̇1, θ̇2\] under a torque, N m. `sin_cos` are the sines and cosines of θ1 and
    /// θ2, if they are known.
    #[doc(hidden)]
    fn derivative<A: Arithmetic<Scalar = S, Form = Self>, V: Numbers<S>>(
        model: &Model<A, V>,
        y: [V; 4],
        sin_cos: Option<[SinCos<V>; 2]>,
        torque: V,
    ) -> [V; 4];

    /// The angle `x`, rad, wrapped to \[−π, π\] by whole turns.
    #[doc(hidden)]
    fn wrap<V: Numbers<S>>(x: V) -> V;

    /// Whether −cos θ1 − cos(θ1 + θ2) > 1: Gymnasium's goal, whatever the lengths of the links.
    #[doc(hidden)]
    fn reaches_goal<A: Arithmetic<Scalar = S>, V: Numbers<S>>(
        angles: [V; 2],
        sin_cos: [SinCos<V>; 2],
    ) -> V::Mask;
}
