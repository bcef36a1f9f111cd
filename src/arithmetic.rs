//! What an acrobot computes in: scalar, trigonometry and form of the equations, as one type.

mod fast;
#[cfg(feature = "std")]
mod host;
mod micro;
mod portable;

use core::fmt;
use core::ops::{Add, Div, Mul, Neg, Sub};

pub use fast::Fast;
pub(crate) use fast::{QuarterTurns, kernel};
#[cfg(feature = "std")]
pub use host::Host;
pub use micro::Micro;
pub use portable::Portable;

/// In which order the equations of motion are evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Form {
    /// As Gymnasium's source writes them: four divisions and four trigonometric calls a stage.
    Gymnasium,
    /// Solved by Cramer's rule: one division and the sines and cosines of θ1 and θ2.
    Lean,
}

/// A scalar, its trigonometry, and the [`Form`] of the equations: everything that decides an
/// acrobot's bits.
///
/// It is a type parameter and no feature flag, because features are unified over a build: a flag
/// that changed numbers would change them for a stranger. The crate has [`Portable`], [`Fast`],
/// [`Micro`] and, with `std`, `Host`; implement it for a trigonometric unit of your chip.
///
/// ```
/// use acrobot::{Acrobot, Action, Arithmetic, Form};
///
/// /// Sines from a table of the chip's.
/// #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
/// struct Table;
///
/// impl Arithmetic for Table {
///     type Scalar = f32;
///     const FORM: Form = Form::Lean;
///     fn sin_cos(x: f32) -> (f32, f32) {
/// #       fn look_up(x: f32) -> f32 { libm::sinf(x) }
///         (look_up(x), look_up(x + core::f32::consts::FRAC_PI_2))
///     }
/// }
///
/// let step = Acrobot::<Table>::new(42).step(Action::Positive);
/// assert_eq!(step.reward, -1.0);
/// ```
pub trait Arithmetic: Copy + fmt::Debug + Default + PartialEq + Send + Sync + 'static {
    /// The type of angles, velocities, torques and parameters.
    type Scalar: Real;

    /// The order in which the equations of motion are evaluated.
    const FORM: Form;

    /// Sine and cosine of `x` rad; both within \[−1, 1\] for every finite `x`.
    fn sin_cos(x: Self::Scalar) -> (Self::Scalar, Self::Scalar);

    /// The same for an angle near the origin, as a step passes through them: to the bit for |x| up to
    /// 2¹⁹ rad. Beyond, where a step has no meaning left in its scalar, it may return anything, and
    /// NaN too; so it is the place to leave out what [`sin_cos`](Self::sin_cos) does for the rest.
    #[inline]
    fn sin_cos_near(x: Self::Scalar) -> (Self::Scalar, Self::Scalar) {
        Self::sin_cos(x)
    }

    /// Cosine of `x` rad: the second of [`sin_cos`](Self::sin_cos), to the bit.
    #[inline]
    fn cos(x: Self::Scalar) -> Self::Scalar {
        Self::sin_cos(x).1
    }

    /// The cosine of a link's angle against the horizontal, of which its weight turns it, where `x` rad
    /// is that against the vertical: sin `x`, which is `sin` if a step knows it already. Only
    /// [`Form::Gymnasium`] asks for it, whose source takes cos(x − π/2).
    #[inline]
    fn cos_from_horizontal(x: Self::Scalar, sin: Option<Self::Scalar>) -> Self::Scalar {
        sin.unwrap_or_else(|| Self::sin_cos(x).0)
    }

    /// The square of `x`.
    #[inline]
    fn square(x: Self::Scalar) -> Self::Scalar {
        x * x
    }
}

/// A scalar that the physics can be computed in: `f32` or `f64`.
///
/// Only what IEEE 754 rounds correctly, and no fused multiply-add, so that every machine agrees.
pub trait Real:
    Copy
    + fmt::Debug
    + fmt::Display
    + Default
    + PartialOrd
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + sealed::Sealed
{
    /// 0.
    const ZERO: Self;
    /// π, rounded to the scalar.
    const PI: Self;
    /// 2π, rounded to the scalar.
    const TAU: Self;

    /// The scalar nearest to `x`.
    fn from_f64(x: f64) -> Self;

    /// The same number, exactly.
    fn to_f64(self) -> f64;

    /// Neither infinite nor NaN.
    fn is_finite(self) -> bool;

    /// The nearest whole number, of two equally near ones the even; exact for |self|
    /// up to 2²² in `f32` and 2⁵¹ in `f64`, finite beyond.
    ///
    /// Two additions, because a Cortex-M4F has no instruction for it.
    fn round_small(self) -> Self;

    /// The remainder of the division by `divisor`, exact, with the sign of `self`.
    fn remainder(self, divisor: Self) -> Self;
}

/// One scalar, or as many as are computed at once: what the lean form and its integration are
/// written in.
pub(crate) trait Numbers<S>:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// `x`, as often as there are numbers.
    fn splat(x: S) -> Self;
}

impl<S: Real> Numbers<S> for S {
    #[inline(always)]
    fn splat(x: S) -> Self {
        x
    }
}

macro_rules! impl_real {
    ($scalar:ident, $bits:ident) => {
        impl sealed::Sealed for $scalar {
            const NAME: &'static str = stringify!($scalar);

            #[inline]
            fn pick([first, second, third]: [Self; 3], index: u8) -> Self {
                let mask = |i| u64::from(index == i).wrapping_neg() as $bits;
                $scalar::from_bits(
                    (first.to_bits() & mask(0))
                        | (second.to_bits() & mask(1))
                        | (third.to_bits() & mask(2)),
                )
            }

            #[inline]
            fn abs(self) -> Self {
                self.abs()
            }
        }

        impl Real for $scalar {
            const ZERO: Self = 0.0;
            const PI: Self = core::$scalar::consts::PI;
            const TAU: Self = core::$scalar::consts::TAU;

            #[inline]
            fn from_f64(x: f64) -> Self {
                x as Self
            }

            #[inline]
            fn to_f64(self) -> f64 {
                self.into()
            }

            #[inline]
            fn is_finite(self) -> bool {
                self.is_finite()
            }

            #[inline]
            fn round_small(self) -> Self {
                // 1.5 / ε: the sum's last place is 1, so that the addition itself rounds.
                const MAGIC: $scalar = 1.5 / $scalar::EPSILON;
                (self + MAGIC) - MAGIC
            }

            #[inline]
            fn remainder(self, divisor: Self) -> Self {
                self % divisor
            }
        }
    };
}

impl_real!(f32, u32);
impl_real!(f64, u64);

pub(crate) mod sealed {
    /// What only this crate needs of a scalar.
    pub trait Sealed: Sized {
        /// Its name in Rust.
        const NAME: &'static str;

        /// The one of three at an index of 0 to 2, without a branch or an address that depends on it.
        fn pick(three: [Self; 3], index: u8) -> Self;

        /// The absolute value.
        fn abs(self) -> Self;
    }
}

/// The largest angle that the `f32` kernels take, rad: 2¹⁹, where neighbouring `f32` are 1/16 rad
/// apart. It stands for all that lies beyond.
const FARTHEST: f32 = 524_288.0;
