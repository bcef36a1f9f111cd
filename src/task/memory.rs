//! What a task remembers of an acrobot between steps.

use crate::error::Error;
use crate::math::{Real, Zeros};

/// The numbers that a task remembers of an acrobot: `()` for none, or `f32`, arrays and pairs. In
/// an `f64` arithmetic they are `f64`.
///
/// ```
/// use acrobot::task::Memory;
///
/// fn len<M: Memory>() -> usize {
///     M::LEN
/// }
/// assert_eq!((len::<()>(), len::<[f32; 3]>(), len::<(f32, [[f32; 4]; 2])>()), (0, 3, 9));
/// ```
pub trait Memory: Zeros {
    /// The same of one acrobot or of many side by side: `[V; 3]` for `[f32; 3]`.
    type Of<V: Zeros>: Zeros;

    /// How many numbers.
    const LEN: usize;

    /// Calls `f` with each number and its place in `to`, in their order.
    fn zip<V: Zeros, W: Zeros>(
        from: &Self::Of<V>,
        to: &mut Self::Of<W>,
        f: &mut impl FnMut(V, &mut W),
    );
}

impl Memory for () {
    type Of<V: Zeros> = ();
    const LEN: usize = 0;

    #[inline(always)]
    fn zip<V: Zeros, W: Zeros>((): &(), (): &mut (), _: &mut impl FnMut(V, &mut W)) {}
}

impl Memory for f32 {
    type Of<V: Zeros> = V;
    const LEN: usize = 1;

    #[inline(always)]
    fn zip<V: Zeros, W: Zeros>(from: &V, to: &mut W, f: &mut impl FnMut(V, &mut W)) {
        f(*from, to);
    }
}

impl<M: Memory, const N: usize> Memory for [M; N] {
    type Of<V: Zeros> = [M::Of<V>; N];
    const LEN: usize = N * M::LEN;

    #[inline(always)]
    fn zip<V: Zeros, W: Zeros>(
        from: &[M::Of<V>; N],
        to: &mut [M::Of<W>; N],
        f: &mut impl FnMut(V, &mut W),
    ) {
        from.iter().zip(to).for_each(|(from, to)| M::zip(from, to, f));
    }
}

impl<L: Memory, M: Memory> Memory for (L, M) {
    type Of<V: Zeros> = (L::Of<V>, M::Of<V>);
    const LEN: usize = L::LEN + M::LEN;

    #[inline(always)]
    fn zip<V: Zeros, W: Zeros>(
        from: &(L::Of<V>, M::Of<V>),
        to: &mut (L::Of<W>, M::Of<W>),
        f: &mut impl FnMut(V, &mut W),
    ) {
        L::zip(&from.0, &mut to.0, f);
        M::zip(&from.1, &mut to.1, f);
    }
}

/// Checks that each number is finite.
pub(super) fn check_finite<M: Memory, S: Real>(memory: &M::Of<S>) -> Result<(), Error> {
    let mut result = Ok(());
    M::zip(memory, &mut { *memory }, &mut |x: S, _: &mut S| {
        if !x.is_finite() {
            result = Err(Error::NotFinite { name: "memory", value: x.to_f64() });
        }
    });
    result
}
