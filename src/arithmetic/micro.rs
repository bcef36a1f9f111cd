//! f32 with `micromath`, in the lean form: the least flash.

use micromath::F32Ext;

use super::{Arithmetic, Form, reduce};

/// `f32` and `micromath`'s trigonometry, in the lean form: the smallest code, and wrong by up to
/// 1.1e-3 in a sine or cosine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Micro;

impl Arithmetic for Micro {
    type Scalar = f32;
    const FORM: Form = Form::Lean;

    #[inline]
    fn sin_cos(x: f32) -> (f32, f32) {
        let x = if x.abs() > 64.0 { reduce(x) } else { x };
        // By path: `x.sin()` would silently be the platform's wherever std is linked.
        (F32Ext::sin(x), F32Ext::cos(x))
    }
}
