//! Sines and cosines as plain functions.

pub mod correctly_rounded;
#[cfg(feature = "std")]
pub mod platform;
pub mod polynomial;
pub mod table;

/// `x`, clamped to the largest angle that the `f32` sines reduce, rad: 2¹⁹, where neighbouring `f32` are 1/16 rad apart.
#[inline(always)]
pub fn clamp(x: f32) -> f32 {
    x.clamp(-524_288.0, 524_288.0)
}
