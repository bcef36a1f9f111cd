//! f64 with the platform's C library, in Gymnasium's order: Gymnasium's own bits.

use core::hint::black_box;

use super::{Arithmetic, Form};

/// `f64` and the C library's `sin`, `cos` and `pow`, in Gymnasium's order: Gymnasium's bits where
/// the library is the one that NumPy calls, as on x86-64 Linux with glibc.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Host;

#[expect(
    clippy::disallowed_methods,
    reason = "this is where the platform's library is called"
)]
impl Arithmetic for Host {
    type Scalar = f64;
    const FORM: Form = Form::Gymnasium;

    #[inline]
    fn sin_cos(x: f64) -> (f64, f64) {
        x.sin_cos()
    }

    #[inline]
    fn cos(x: f64) -> f64 {
        x.cos()
    }

    /// `x**2` of a NumPy scalar is C's `pow`, which glibc rounds differently from `x * x` on one
    /// argument in a thousand. LLVM turns `pow(x, 2.0)` into `x * x` wherever it sees the exponent.
    #[inline]
    fn square(x: f64) -> f64 {
        x.powf(black_box(2.0))
    }
}
