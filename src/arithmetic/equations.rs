//! What a form of the equations of motion provides, for one number or for many at once.

use core::fmt;
use core::ops::{Add, Div, Mul, Neg, Sub};

use super::{Arithmetic, Real, SinCos, Zeroed};
use crate::physics::{Common, Dynamics, Params};

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

/// One number, or many side by side. The code of a step is generic over this, so it is written once.
pub trait Numbers<S: Real>:
    Copy
    + fmt::Debug
    + Send
    + Sync
    + Zeroed
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// A truth value for each number.
    type Mask;

    /// Whether this is a single number.
    const IS_ONE: bool;

    /// `x` in each lane.
    fn splat(x: S) -> Self;

    /// Applies `f` to each number.
    fn map(self, f: impl FnMut(S) -> S) -> Self;

    /// Applies `f` to each pair of numbers.
    fn zip(self, other: Self, f: impl FnMut(S, S) -> S) -> Self;

    /// Whether |x| ≤ `limit` for all numbers x; false for NaN.
    fn all_within(self, limit: Self) -> bool;

    /// `inside` where |x| ≤ `limit`, `outside` elsewhere and for NaN.
    fn select_within(self, limit: S, inside: Self, outside: Self) -> Self;

    /// Which numbers are above `limit`.
    fn above(self, limit: S) -> Self::Mask;

    /// [`Arithmetic::sin_cos_near`] of each number.
    fn sin_cos<A: Arithmetic<Scalar = S>>(self) -> SinCos<Self>;

    /// Each number clamped to \[−`limit`, `limit`\]; NaN stays NaN.
    #[inline(always)]
    fn bound(self, limit: Self) -> Self {
        self.zip(limit, |x, limit| if x > limit { limit } else { x })
            .zip(limit, |x, limit| if x < -limit { -limit } else { x })
    }
}

impl<S: Real> Numbers<S> for S {
    type Mask = bool;
    const IS_ONE: bool = true;

    #[inline(always)]
    fn splat(x: S) -> Self {
        x
    }

    #[inline(always)]
    fn map(self, mut f: impl FnMut(S) -> S) -> Self {
        f(self)
    }

    #[inline(always)]
    fn zip(self, other: Self, mut f: impl FnMut(S, S) -> S) -> Self {
        f(self, other)
    }

    #[inline(always)]
    fn all_within(self, limit: S) -> bool {
        self.abs() <= limit
    }

    #[inline(always)]
    fn select_within(self, limit: S, inside: Self, outside: Self) -> Self {
        if self.abs() <= limit { inside } else { outside }
    }

    #[inline(always)]
    fn above(self, limit: S) -> bool {
        self > limit
    }

    #[inline(always)]
    fn sin_cos<A: Arithmetic<Scalar = S>>(self) -> SinCos<Self> {
        A::sin_cos_near(self)
    }
}
