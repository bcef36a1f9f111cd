//! `N` numbers side by side, for batches.
//!
//! These are plain arrays and loops over them, which LLVM compiles to the SIMD instructions of the target.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::{Arithmetic, Numbers, Real, SinCos, Zeroed};

#[derive(Clone, Copy, Debug)]
pub struct Lanes<S, const N: usize>(pub(crate) [S; N]);

impl<S: Zeroed + Copy, const N: usize> Zeroed for Lanes<S, N> {
    const ZEROED: Self = Self([S::ZEROED; N]);
}

macro_rules! lane_by_lane {
    ($($trait:ident $method:ident),*) => {$(
        impl<S: Real, const N: usize> $trait for Lanes<S, N> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, S::$method)
            }
        }
    )*};
}

lane_by_lane!(Add add, Sub sub, Mul mul, Div div);

impl<S: Real, const N: usize> Neg for Lanes<S, N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.map(S::neg)
    }
}

impl<S: Real, const N: usize> Lanes<S, N> {
    /// The same numbers, but `x` in one lane.
    pub(crate) fn with(mut self, lane: usize, x: S) -> Self {
        if let Some(to) = self.0.get_mut(lane) {
            *to = x;
        }
        self
    }
}

// Loops and not `array::map`, which LLVM keeps out of line, where it may not use the SIMD instructions of its caller.
impl<S: Real, const N: usize> Numbers<S> for Lanes<S, N> {
    type Mask = [bool; N];
    const IS_ONE: bool = false;

    #[inline(always)]
    fn splat(x: S) -> Self {
        Self([x; N])
    }

    #[inline(always)]
    fn map(mut self, mut f: impl FnMut(S) -> S) -> Self {
        for x in &mut self.0 {
            *x = f(*x);
        }
        self
    }

    #[inline(always)]
    fn zip(mut self, other: Self, mut f: impl FnMut(S, S) -> S) -> Self {
        for (x, y) in self.0.iter_mut().zip(other.0) {
            *x = f(*x, y);
        }
        self
    }

    #[inline(always)]
    fn all_within(self, limit: Self) -> bool {
        let pairs = self.0.iter().zip(&limit.0);
        pairs.fold(true, |all, (x, limit)| all & (x.abs() <= *limit))
    }

    #[inline(always)]
    fn select_within(self, limit: S, inside: Self, mut outside: Self) -> Self {
        for ((x, inside), outside) in self.0.iter().zip(inside.0).zip(&mut outside.0) {
            *outside = if x.abs() <= limit { inside } else { *outside };
        }
        outside
    }

    #[inline(always)]
    fn above(self, limit: S) -> [bool; N] {
        let mut above = [false; N];
        for (above, x) in above.iter_mut().zip(self.0) {
            *above = x > limit;
        }
        above
    }

    #[inline(always)]
    fn sin_cos<A: Arithmetic<Scalar = S>>(self) -> SinCos<Self> {
        let (sin, cos) = A::sin_cos_lanes(self.0);
        (Self(sin), Self(cos))
    }
}
