//! For comparison: the sine and cosine of the `micromath` crate, whose error is 1.1e-3.

use acrobot::arithmetic::Arithmetic;
use acrobot::physics::Lean;
use micromath::F32Ext;

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Micromath;

impl Arithmetic for Micromath {
    const NAME: &'static str = "micromath";
    type Scalar = f32;
    type Form = Lean;

    fn sin_cos(x: f32) -> (f32, f32) {
        // By path, because `x.sin()` is the platform's where std is linked.
        (F32Ext::sin(x), F32Ext::cos(x))
    }
}
