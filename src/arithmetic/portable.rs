//! `f64` with the crate `libm`: the same bits on every target.

use super::Arithmetic;
use crate::physics::Gymnasium;

/// `f64`, sines from the crate `libm`, and Gymnasium's order: the same bits on every target, equal to
/// Gymnasium's up to rounding. Where Gymnasium takes cos(x − π/2) it takes sin x, which is often known already
/// and is rounded once less.
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
    type Form = Gymnasium;

    #[inline]
    fn sin_cos(x: f64) -> (f64, f64) {
        libm::sincos(x)
    }

    #[inline]
    fn cos(x: f64) -> f64 {
        libm::cos(x)
    }

    #[inline]
    fn cos_from_horizontal(x: f64, sin: Option<f64>) -> f64 {
        sin.unwrap_or_else(|| libm::sin(x))
    }
}
