//! Plain data that begins as zeros.

use core::fmt;

/// One number or more: scalars, lanes, arrays and pairs of these, and `()`.
pub trait Zeros: Copy + fmt::Debug + PartialEq + Send + Sync + 'static {
    /// 0 for each number.
    const ZEROS: Self;
}

impl Zeros for () {
    const ZEROS: Self = ();
}

impl<Z: Zeros, const N: usize> Zeros for [Z; N] {
    const ZEROS: Self = [Z::ZEROS; N];
}

impl<Y: Zeros, Z: Zeros> Zeros for (Y, Z) {
    const ZEROS: Self = (Y::ZEROS, Z::ZEROS);
}
