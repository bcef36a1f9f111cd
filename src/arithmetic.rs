//! Arithmetics: the types that determine every bit of a result.
//!
//! An [`Arithmetic`] names a scalar, a sine and cosine, and a [`Form`] of the equations of motion. It is a type
//! parameter and not a feature flag, because Cargo unifies features: a flag that changes results would change them for
//! every crate in the build.
//!
//! | type | scalar | sine and cosine | equations | use |
//! |---|---|---|---|---|
//! | [`Reference`] | `f64` | correctly rounded | Gymnasium's | bits defined by mathematics, and nearest to Gymnasium's |
//! | `Host` (feature `std`) | `f64` | the platform's C library | Gymnasium's | Gymnasium's own bits |
//! | [`Portable`] | `f64` | the crate `libm` | lean | the fastest `f64` on desktops, the same bits everywhere |
//! | [`Fast`] | `f32` | polynomial | lean | single-precision FPUs, WASM, SIMD batches |
//! | [`Micro`] | `f32` | table | lean | the fewest instructions on a microcontroller |
//!
//! No arithmetic uses the sines of the crate `micromath`. On a Cortex-M4F they take more flash than those of [`Fast`]
//! and [`Micro`] and more instructions (616 per step, `Fast` 559), and their error is 1.1e-3.
//!
//! For a hardware sine unit, implement [`Arithmetic`]:
//!
//! ```
//! use acrobot::arithmetic::Arithmetic;
//! use acrobot::physics::Lean;
//! use acrobot::{Acrobot, Action};
//!
//! /// Sines from the microcontroller's table.
//! #[derive(Clone, Copy, Debug, Default, PartialEq)]
//! struct Table;
//!
//! impl Arithmetic for Table {
//!     const NAME: &'static str = "table";
//!     type Scalar = f32;
//!     type Form = Lean;
//!     fn sin_cos(x: f32) -> (f32, f32) {
//! #       fn look_up(x: f32) -> f32 { libm::sinf(x) }
//!         (look_up(x), look_up(x + core::f32::consts::FRAC_PI_2))
//!     }
//! }
//!
//! let step = Acrobot::<Table>::new(42).step(Action::Positive);
//! assert_eq!(step.reward, -1.0);
//! ```

mod equations;
mod fast;
#[cfg(feature = "std")]
mod host;
mod lanes;
mod micro;
mod portable;
mod real;
mod reference;

use core::fmt;

pub(crate) use equations::{Coefficients, Constants, Equations, Model, Numbers, Zeroed};
pub use fast::Fast;
#[cfg(feature = "std")]
pub use host::Host;
pub(crate) use lanes::Lanes;
pub use micro::Micro;
pub use portable::Portable;
pub use real::Real;
pub(crate) use real::SinCos;
pub use reference::Reference;

/// A scalar, its sines and the form of the equations: they determine every bit of a result.
pub trait Arithmetic: Copy + fmt::Debug + Default + PartialEq + Send + Sync + 'static {
    /// A short name in lower case, of at most 16 bytes. Snapshots hold it, so no other arithmetic can load them. The
    /// crate's names are "reference", "portable", "fast", "micro" and "host". With a longer name, code that saves or
    /// loads a snapshot does not compile.
    const NAME: &'static str;

    /// The type of angles, velocities, torques and parameters.
    type Scalar: Real;

    /// How the equations of motion are evaluated: [`Lean`](crate::physics::Lean) or
    /// [`Gymnasium`](crate::physics::Gymnasium).
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

/// A form of the equations of motion: [`Gymnasium`](crate::physics::Gymnasium) or [`Lean`](crate::physics::Lean), which
/// agree up to rounding. No other type can implement it.
pub trait Form<S: Real>: Equations<S> {}

impl<S: Real, F: Equations<S>> Form<S> for F {}

/// The largest angle that the `f32` arithmetics reduce, rad: 2¹⁹, where neighbouring `f32` are 1/16 rad apart. Their
/// `sin_cos` clamps larger angles to it.
const FARTHEST: f32 = 524_288.0;
