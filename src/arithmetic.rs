//! Arithmetics: the types that determine every bit of a result.
//!
//! An [`Arithmetic`] names a scalar, a sine and cosine, and a [`Form`] of the equations of motion.
//! It is a type parameter and not a feature flag, because Cargo unifies features: a flag that
//! changes results would change them for every crate in the build. The guide says
//! [which to choose](crate::guide::numbers#arithmetics).
//!
//! For a hardware sine unit, implement [`Arithmetic`]:
//!
//! ```
//! use acrobot::arithmetic::Arithmetic;
//! use acrobot::{Acrobot, Action};
//!
//! /// Sines from the microcontroller's table.
//! #[derive(Clone, Copy, Debug, Default, PartialEq)]
//! struct Table;
//!
//! impl Arithmetic for Table {
//!     const NAME: &'static str = "table";
//!     type Scalar = f32;
//!     fn sin_cos(x: f32) -> (f32, f32) {
//! #       fn look_up(x: f32) -> f32 { libm::sinf(x) }
//!         (look_up(x), look_up(x + core::f32::consts::FRAC_PI_2))
//!     }
//! }
//!
//! let step = Acrobot::<Table>::new(42).step(Action::Positive);
//! assert_eq!(step.reward, -1.0);
//! ```

use core::marker::PhantomData;

#[cfg(feature = "std")]
use crate::math::sines::platform;
use crate::math::sines::{self, correctly_rounded, fdlibm, polynomial, table};

pub use crate::math::{Numbers, Real, Zeros};
pub use crate::physics::arithmetic::Arithmetic;
pub use crate::physics::model::{Form, Modeled};

/// `f64`, correctly rounded sines and cosines, and Gymnasium's expressions: the same bits on every
/// target, defined by mathematics and not by a library.
///
/// 99.75 % of its steps are [bit-identical to
/// Gymnasium's](crate::guide::parity#bit-identical-steps), about as many as between Gymnasium on
/// two CPUs. `src/math/sines/correctly_rounded.rs` explains the method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reference;

impl Arithmetic for Reference {
    const NAME: &'static str = "reference";
    type Scalar = f64;
    const FORM: Form = Form::Gymnasium;

    /// Sine and cosine, correctly rounded. NaN for infinity and NaN.
    #[inline]
    fn sin_cos(x: f64) -> (f64, f64) {
        correctly_rounded::sin_cos(x)
    }

    #[inline(always)]
    fn sin_cos_near<V: Numbers<f64>>(x: V) -> (V, V) {
        correctly_rounded::sin_cos(x)
    }

    #[inline(always)]
    fn cos_near<V: Numbers<f64>>(x: V) -> V {
        correctly_rounded::cos(x)
    }
}

/// `f64`, the C library's `sin`, `cos` and `pow`, and Gymnasium's order: [bit-identical to
/// Gymnasium](crate::guide::parity#bit-identical-steps) if NumPy calls the same library, as on
/// Linux with glibc and a CPU with FMA.
#[cfg(feature = "std")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Host;

#[cfg(feature = "std")]
impl Arithmetic for Host {
    const NAME: &'static str = "host";
    type Scalar = f64;
    const FORM: Form = Form::Gymnasium;

    #[inline]
    fn sin_cos(x: f64) -> (f64, f64) {
        platform::sin_cos(x)
    }

    #[inline(always)]
    fn cos_near<V: Numbers<f64>>(x: V) -> V {
        x.map(platform::cos)
    }

    const SQUARES_IN_CONST: bool = false;

    #[inline(always)]
    fn square(x: f64) -> f64 {
        platform::square(x)
    }
}

/// `f64`, the sines of the crate `libm`, and the lean form: the fastest `f64` with the same bits on
/// every target.
///
/// For some angles [it calls `libm`](crate::guide::determinism#limits), of which a release could
/// round differently. [`Reference`] depends on no library.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Portable;

impl Arithmetic for Portable {
    const NAME: &'static str = "portable";
    type Scalar = f64;

    #[inline]
    fn sin_cos(x: f64) -> (f64, f64) {
        fdlibm::sin_cos(x)
    }

    #[inline(always)]
    fn sin_cos_near<V: Numbers<f64>>(x: V) -> (V, V) {
        fdlibm::sin_cos(x)
    }
}

/// `f32`, polynomial sines, and the lean form: the same bits on every target, with or without an
/// FPU. For single-precision FPUs, WASM and batches with SIMD.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fast;

impl Arithmetic for Fast {
    const NAME: &'static str = "fast";
    type Scalar = f32;

    /// Sine and cosine with an error of at most 1.17e-7 (two units in the last place of 1) for |x|
    /// ≤ 64 rad. For larger angles it is that of an angle in `f32`, 1.2e-7 |x|. Angles beyond ±2¹⁹
    /// rad are clamped to ±2¹⁹ rad.
    #[inline]
    fn sin_cos(x: f32) -> (f32, f32) {
        polynomial::sin_cos(sines::clamp(x))
    }

    #[inline(always)]
    fn sin_cos_near<V: Numbers<f32>>(x: V) -> (V, V) {
        polynomial::sin_cos(x)
    }
}

/// `f32`, a table of sixteen sines for half a turn, and the lean form: a sixth fewer instructions
/// than [`Fast`] on a Cortex-M4, and about seven times its error for |x| ≤ π.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Micro;

impl Arithmetic for Micro {
    const NAME: &'static str = "micro";
    type Scalar = f32;

    /// As [`Fast`]'s, with an error of at most 8e-7 for |x| ≤ π, 4e-6 for |x| ≤ 64 rad, and 2e-7
    /// |x| for larger angles.
    #[inline]
    fn sin_cos(x: f32) -> (f32, f32) {
        table::sin_cos(sines::clamp(x))
    }

    #[inline(always)]
    fn sin_cos_near<V: Numbers<f32>>(x: V) -> (V, V) {
        x.map_unzip(table::sin_cos)
    }
}

/// An arithmetic with [friction](crate::guide::equations#friction-and-rotors) and a rotor, which are 0 by default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Damped<A>(PhantomData<A>);

impl<A: Arithmetic> Arithmetic for Damped<A> {
    const NAME: &'static str = A::NAME;
    type Scalar = A::Scalar;
    const FORM: Form = A::FORM;
    const HAS_FRICTION: bool = true;
    const SQUARES_IN_CONST: bool = A::SQUARES_IN_CONST;

    #[inline]
    fn sin_cos(x: A::Scalar) -> (A::Scalar, A::Scalar) {
        A::sin_cos(x)
    }

    #[inline(always)]
    fn sin_cos_near<V: Numbers<A::Scalar>>(x: V) -> (V, V) {
        A::sin_cos_near(x)
    }

    #[inline(always)]
    fn cos_near<V: Numbers<A::Scalar>>(x: V) -> V {
        A::cos_near(x)
    }

    #[inline(always)]
    fn square(x: A::Scalar) -> A::Scalar {
        A::square(x)
    }
}
