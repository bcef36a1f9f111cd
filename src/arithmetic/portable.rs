//! f64 with `libm`, in Gymnasium's order: the reference on every target.

use super::{Arithmetic, Form};

/// `f64` and `libm`'s trigonometry, in Gymnasium's order: the same bits on every target, and
/// within rounding of Gymnasium's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Portable;

impl Arithmetic for Portable {
    type Scalar = f64;
    const FORM: Form = Form::Gymnasium;

    #[inline]
    fn sin_cos(x: f64) -> (f64, f64) {
        libm::sincos(x)
    }

    #[inline]
    fn cos(x: f64) -> f64 {
        libm::cos(x)
    }
}
