//! `f64` with the crate `libm`: the same bits on every target.

use super::Arithmetic;
use crate::physics::Lean;

/// `f64`, sines from the crate `libm`, and the lean form: the fastest `f64` with the same bits on every target.
///
/// A release of `libm` could round its sines differently and so change the bits. [Fix its
/// version](crate::guide::determinism#limits), or use [`Reference`](super::Reference), which depends on no
/// library.
///
/// ```
/// use acrobot::Portable;
/// use acrobot::arithmetic::Arithmetic;
///
/// let (sin, cos) = Portable::sin_cos(1.0);
/// assert_eq!([sin, cos].map(f64::to_bits), [0x3fea_ed54_8f09_0cee, 0x3fe1_4a28_0fb5_068c]);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Portable;

impl Arithmetic for Portable {
    const NAME: &'static str = "portable";
    type Scalar = f64;
    type Form = Lean;

    #[inline]
    fn sin_cos(x: f64) -> (f64, f64) {
        libm::sincos(x)
    }

    #[inline]
    fn cos(x: f64) -> f64 {
        libm::cos(x)
    }
}
