//! The scalars: `f32` and `f64`.

use core::fmt;
use core::ops::{Add, Div, Mul, Neg, Sub};

use super::zeros::Zeros;
use sealed::Sealed as _;

/// A scalar: `f32` or `f64`.
///
/// It has only operations that IEEE 754 rounds correctly, and no fused multiply-add, so results are
/// the same on every machine.
pub trait Real:
    Zeros
    + fmt::Display
    + Default
    + PartialOrd
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

    /// Whether it is neither infinite nor NaN.
    fn is_finite(self) -> bool;

    /// The nearest integer, ties to even. Exact for |self| up to 2²² in `f32` and 2⁵¹ in `f64`,
    /// finite beyond.
    ///
    /// It consists of two additions, because a Cortex-M4F has no rounding instruction.
    fn round_small(self) -> Self;

    /// The square root; NaN below 0.
    fn sqrt(self) -> Self;

    /// The exact remainder of the division by `divisor`, with the sign of `self`.
    fn remainder(self, divisor: Self) -> Self;
}

/// Sine and cosine of one angle.
pub type SinCos<V> = (V, V);

macro_rules! impl_real {
    ($scalar:ident, $bits:ident, $sqrt:ident) => {
        impl sealed::Sealed for $scalar {
            const ONE: Self = 1.0;
            const HALF: Self = 0.5;
            const EPSILON: Self = $scalar::EPSILON;
            const MAGIC: Self = 1.5 / $scalar::EPSILON;

            #[inline]
            fn select([first, second, third]: [Self; 3], index: u8) -> Self {
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

            #[inline(always)]
            fn power_of_two(self) -> Self {
                const DIGITS: u32 = $scalar::MANTISSA_DIGITS - 1;
                let biased = self + (Self::MAGIC + ($scalar::MAX_EXP - 1) as $scalar);
                $scalar::from_bits(biased.to_bits() << DIGITS)
            }
        }

        impl Zeros for $scalar {
            const ZEROS: Self = 0.0;
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
                (self + Self::MAGIC) - Self::MAGIC
            }

            #[inline]
            fn sqrt(self) -> Self {
                #[cfg(feature = "std")]
                return self.sqrt();
                #[cfg(not(feature = "std"))]
                libm::$sqrt(self)
            }

            #[inline]
            fn remainder(self, divisor: Self) -> Self {
                self % divisor
            }
        }
    };
}

impl_real!(f32, u32, sqrtf);
impl_real!(f64, u64, sqrt);

pub(crate) mod sealed {
    /// What the features `serde` and `defmt` need of numbers.
    #[cfg(feature = "serde")]
    pub trait Serde: serde::Serialize + serde::de::DeserializeOwned {}
    #[cfg(feature = "serde")]
    impl<T: serde::Serialize + serde::de::DeserializeOwned> Serde for T {}
    #[cfg(not(feature = "serde"))]
    pub trait Serde {}
    #[cfg(not(feature = "serde"))]
    impl<T> Serde for T {}

    #[cfg(feature = "defmt")]
    pub use defmt::Format;
    #[cfg(not(feature = "defmt"))]
    pub trait Format {}
    #[cfg(not(feature = "defmt"))]
    impl<T> Format for T {}

    /// Items of a scalar that only this crate uses.
    pub trait Sealed: Sized + Serde + Format {
        const ONE: Self;
        const HALF: Self;

        /// The distance from 1 to the next number.
        const EPSILON: Self;

        /// 1.5 / ε: a sum with it rounds to an integer, whose low bits are the sum's lowest bits.
        const MAGIC: Self;

        /// The element with an index of 0 to 2, without a branch or an address that depends on the
        /// index.
        fn select(three: [Self; 3], index: u8) -> Self;

        fn abs(self) -> Self;

        /// 2^self for an integer from −120 to 120.
        fn power_of_two(self) -> Self;
    }
}
