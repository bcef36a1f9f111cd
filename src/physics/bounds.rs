//! The bounds of a state: angles are wrapped, velocities are clamped.

use crate::math::{Numbers, Real};

/// The angle `x`, rad, wrapped to \[−π, π\] by whole turns.
///
/// Subtracts the rounded number of turns at once, as a step of the form
/// [`Lean`](super::model::Form::Lean) does; one of the form
/// [`Gymnasium`](super::model::Form::Gymnasium) subtracts turn by turn, so beyond one turn its last
/// digits differ. The error in `f32` is at most 1.2e-7 |x|. Wrapping −x negates the result, except
/// for the sign of zero, up to 2²² turns in `f32` and 2⁵¹ in `f64`. An infinite angle or NaN gives
/// NaN.
#[must_use]
#[inline]
pub fn wrap<S: Real>(x: S) -> S {
    wrap_each(x)
}

/// As [`wrap`], of one angle or of many.
#[inline(always)]
pub(crate) fn wrap_each<S: Real, V: Numbers<S>>(x: V) -> V {
    let turns = x * V::splat(S::from_f64(1.0 / core::f64::consts::TAU));
    let turned = x - turns.map(S::round_small) * V::splat(S::TAU);
    // The bound is for angles whose neighbours are more than a turn away. An angle within ±π does
    // not change, even where its turns round to ±1.
    let turned = turned.simd_clamp(V::splat(-S::PI), V::splat(S::PI));
    x.zip(turned, |x, turned| if x.abs() <= S::PI { x } else { turned })
}

/// `x` clamped to \[−`limit`, `limit`\], for a `limit` of at least 0. NaN stays NaN, and a
/// `limit` of NaN does not limit.
#[must_use]
#[inline]
pub fn saturate<S: Real>(x: S, limit: S) -> S {
    x.simd_clamp(-limit, limit)
}
