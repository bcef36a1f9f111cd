//! The bounds of a state: angles are wrapped, velocities are clamped.

use super::{Arithmetic, Form};
use crate::math::{Numbers, Real};

/// The angle `x`, rad, wrapped to \[−π, π\] by whole turns, as a step of `A` wraps it.
///
/// [`Gymnasium`](super::Gymnasium) subtracts turn by turn, up to 64 turns, and takes the remainder beyond.
/// [`Lean`](super::Lean) subtracts the rounded number of turns at once; its error is at most the spacing of `f32` at
/// `x`, 1.2e-7 |x|. Wrapping −x negates the result, except for the sign of zero; in the lean form
/// up to 2²² turns in `f32` and 2⁵¹ in `f64`, because it counts no more. An infinite angle or NaN
/// gives NaN.
///
/// ```
/// use acrobot::physics::wrap;
/// use acrobot::{Fast, Portable};
///
/// assert_eq!(wrap::<Portable>(4.0), 4.0 - core::f64::consts::TAU);
/// assert_eq!(wrap::<Fast>(4.0), 4.0 - core::f32::consts::TAU);
/// assert!(wrap::<Fast>(1e30).abs() <= core::f32::consts::PI);
/// assert_eq!(wrap::<Portable>(-1e16), -wrap::<Portable>(1e16));
/// assert_ne!(wrap::<Portable>(-1e17), -wrap::<Portable>(1e17)); // beyond 2⁵¹ turns
/// ```
#[must_use]
#[inline]
pub fn wrap<A: Arithmetic>(x: A::Scalar) -> A::Scalar {
    A::Form::wrap(x)
}

/// `x` clamped to \[−`limit`, `limit`\], for a `limit` of at least 0. NaN stays NaN.
#[must_use]
#[inline]
pub fn bound<S: Real>(x: S, limit: S) -> S {
    Numbers::bound(x, limit)
}
