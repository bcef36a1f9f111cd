//! What determines every bit of a step, for one number or for many at once: an arithmetic, which names a form of the
//! equations of motion.

use core::fmt;

use super::model::Common;
use super::{Dynamics, Params};
use crate::math::{Numbers, Real, SinCos, Zeroed};

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

    /// Sine and cosine, bit-identical to [`sin_cos`](Self::sin_cos) for |x| ≤ 2¹⁹ rad. Beyond, any result is valid,
    /// even NaN. Steps call this method for speed: it can leave out range checks.
    #[inline]
    fn sin_cos_near(x: Self::Scalar) -> (Self::Scalar, Self::Scalar) {
        Self::sin_cos(x)
    }

    /// Sines and cosines of `N` angles, bit-identical to [`sin_cos_near`](Self::sin_cos_near). Batches call it, so it
    /// is the place for SIMD.
    #[inline(always)]
    fn sin_cos_lanes<const N: usize>(
        mut x: [Self::Scalar; N],
    ) -> ([Self::Scalar; N], [Self::Scalar; N]) {
        let mut cos = x;
        for (x, cos) in x.iter_mut().zip(&mut cos) {
            (*x, *cos) = Self::sin_cos_near(*x);
        }
        (x, cos)
    }

    /// Cosine of `x` rad, bit-identical to the cosine of [`sin_cos`](Self::sin_cos).
    #[inline]
    fn cos(x: Self::Scalar) -> Self::Scalar {
        Self::sin_cos(x).1
    }

    /// The square of `x`.
    #[inline]
    fn square(x: Self::Scalar) -> Self::Scalar {
        x * x
    }
}

/// The constants that the form of the equations computes from the parameters.
pub type Constants<A, V> =
    <<A as Arithmetic>::Form as Equations<<A as Arithmetic>::Scalar>>::Constants<V>;

/// The parameters, and the constants that follow from them.
#[derive(Clone, Copy, Debug)]
pub struct Model<A: Arithmetic> {
    pub(crate) params: Params<A::Scalar>,
    pub(crate) constants: Constants<A, A::Scalar>,
}

/// What a step reads of a model: a number, or one for each lane.
pub trait Coefficients<A: Arithmetic, V: Numbers<A::Scalar>> {
    /// The constants of the equations.
    fn constants(&self) -> &Constants<A, V>;

    /// The duration of a step, s.
    fn dt(&self) -> V;

    /// The bounds of |θ̇1| and |θ̇2|, rad/s.
    fn max_velocities(&self) -> [V; 2];

    /// `book` where the equations are those of the book, `nips` where they are those of the 1996 paper.
    fn select(&self, book: V, nips: V) -> V;

    /// [`Arithmetic::sin_cos_near`] of each number.
    fn sin_cos(&self, x: V) -> SinCos<V>;
}

impl<A: Arithmetic> Coefficients<A, A::Scalar> for Model<A> {
    #[inline(always)]
    fn constants(&self) -> &Constants<A, A::Scalar> {
        &self.constants
    }

    #[inline(always)]
    fn dt(&self) -> A::Scalar {
        self.params.dt
    }

    #[inline(always)]
    fn max_velocities(&self) -> [A::Scalar; 2] {
        [self.params.max_velocity1, self.params.max_velocity2]
    }

    #[inline(always)]
    fn select(&self, book: A::Scalar, nips: A::Scalar) -> A::Scalar {
        match self.params.dynamics {
            Dynamics::Book => book,
            Dynamics::Nips => nips,
        }
    }

    #[inline(always)]
    fn sin_cos(&self, x: A::Scalar) -> SinCos<A::Scalar> {
        A::sin_cos_near(x)
    }
}

impl<A: Arithmetic> Model<A> {
    /// The model of [`Params::DEFAULT`], computed by the compiler.
    pub(crate) const DEFAULT: Self = Self {
        params: Params::DEFAULT,
        constants: A::Form::DEFAULT,
    };

    #[inline]
    pub(crate) fn new(params: Params<A::Scalar>) -> Self {
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
pub trait Form<S: Real>: Equations<S> {}

impl<S: Real, F: Equations<S>> Form<S> for F {}

/// A form of the equations of motion, in the scalar `S`.
pub trait Equations<S: Real>: Copy + fmt::Debug {
    /// The constants, which depend only on the parameters.
    type Constants<V: Numbers<S>>: Copy + fmt::Debug + Send + Sync + Zeroed;

    /// The constants of [`Params::DEFAULT`], computed by the compiler.
    const DEFAULT: Self::Constants<S>;

    /// The constants of `params`, given l1², lc1² and lc2².
    fn constants(params: &Params<S>, squares: [S; 3]) -> Self::Constants<S>;

    /// The constants that both forms need.
    fn common<V: Numbers<S>>(constants: &Self::Constants<V>) -> &Common<V>;

    /// Applies `f` to each pair of constants.
    fn zip<V: Numbers<S>, W: Numbers<S>>(
        constants: Self::Constants<V>,
        numbers: Self::Constants<S>,
        f: impl Fn(V, S) -> W + Copy,
    ) -> Self::Constants<W>;

    /// Whether the Runge-Kutta step adds each stage to the result at once, instead of in Gymnasium's order.
    const COMPACT: bool;

    /// The derivative at `y` = \[θ1, θ2, θ̇1, θ̇2\] under a torque, N m. `sin_cos` are the sines and cosines of θ1 and
    /// θ2, if they are known.
    fn derivative<A: Arithmetic<Scalar = S, Form = Self>, V: Numbers<S>>(
        model: &impl Coefficients<A, V>,
        y: [V; 4],
        sin_cos: Option<[SinCos<V>; 2]>,
        torque: V,
    ) -> [V; 4];

    /// The angle `x`, rad, wrapped to \[−π, π\] by whole turns.
    fn wrap<V: Numbers<S>>(x: V) -> V;

    /// Whether −cos θ1 − cos(θ1 + θ2) > 1: Gymnasium's goal, whatever the lengths of the links.
    fn reaches_goal<A: Arithmetic<Scalar = S>, V: Numbers<S>>(
        angles: [V; 2],
        sin_cos: [SinCos<V>; 2],
    ) -> V::Mask;
}
