//! Sines and cosines as plain functions.

pub mod correctly_rounded;
pub mod fdlibm;
#[cfg(feature = "std")]
pub mod platform;
pub mod polynomial;
pub mod table;

/// `x`, clamped to the largest angle that the `f32` sines reduce, rad: 2¹⁹, where neighbouring
/// `f32` are 1/16 rad apart.
#[inline(always)]
pub fn clamp(x: f32) -> f32 {
    x.clamp(-524_288.0, 524_288.0)
}

/// Whether the machine has instructions for `f64`. Results do not depend on it.
const HAS_F64: bool =
    cfg!(any(target_pointer_width = "64", target_arch = "wasm32", target_arch = "x86"));

/// Whether the machine has SIMD for `f64`. Without it lanes are faster one by one, with the same
/// results.
const HAS_SIMD: bool = cfg!(any(
    target_feature = "sse2",
    target_feature = "simd128",
    all(target_arch = "aarch64", target_feature = "neon"),
));
