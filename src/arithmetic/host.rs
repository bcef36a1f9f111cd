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
    /// argument in a thousand: some of those where the exact square lies about half way between two
    /// doubles. Elsewhere `pow` is spared, which costs much of a step.
    #[inline]
    fn square(x: f64) -> f64 {
        /// How far from `x * x`, in units of its last place, the exact square may be for `pow` to be
        /// equal to it: half a unit but for the error of `pow`, of which glibc's source says that it adds
        /// 0.044 units at worst (`e_pow.c`: 0.54 in all).
        const SURE: f64 = 0.45;
        let product = x * x;
        // Within these the residual is exact and the exponents are.
        if (1e-280..1e280).contains(&product) && residual(x, product).abs() < SURE * ulp(product) {
            return product;
        }
        // LLVM turns `pow(x, 2.0)` into `x * x` wherever it sees the exponent.
        x.powf(black_box(2.0))
    }
}

/// x² − `product`, exactly: Dekker's product, for many machines have no fused multiply-add.
#[inline]
fn residual(x: f64, product: f64) -> f64 {
    let scaled = x * 134_217_729.0; // 2²⁷ + 1
    let high = scaled - (scaled - x);
    let low = x - high;
    ((high * high - product) + 2.0 * high * low) + low * low
}

/// The unit in the last place of a normal number above 0.
#[inline]
fn ulp(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & f64::INFINITY.to_bits()) * f64::EPSILON
}
