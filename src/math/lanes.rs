//! One number, or `N` side by side for batches.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::real::Real;
use super::zeros::Zeros;

/// One number, or many side by side: the crate implements it for `f32`, for `f64` and for their
/// lanes in a batch.
pub trait Numbers<S: Real>:
    Zeros
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// A truth value for each number.
    type Mask: Copy;

    /// As many numbers in `f32`, as rewards are.
    type Single: Numbers<f32, Mask = Self::Mask>;

    /// Whether this is a single number.
    const IS_ONE: bool;

    /// How many numbers.
    #[doc(hidden)]
    const LEN: usize;

    /// The number of lane `i`, which must be below `LEN`.
    #[doc(hidden)]
    fn lane(&self, i: usize) -> S;

    /// Sets the number of lane `i`, which must be below `LEN`.
    #[doc(hidden)]
    fn set_lane(&mut self, i: usize, x: S);

    /// `x` in each lane.
    fn splat(x: S) -> Self;

    /// Applies `f` to each number.
    #[inline(always)]
    fn map(self, mut f: impl FnMut(S) -> S) -> Self {
        self.zip(self, |x, _| f(x))
    }

    /// Applies `f` to each pair of numbers.
    fn zip(self, other: Self, f: impl FnMut(S, S) -> S) -> Self;

    /// Applies `f` to each number. Its results are the numbers of two.
    #[inline(always)]
    fn map_unzip(self, mut f: impl FnMut(S) -> (S, S)) -> (Self, Self) {
        self.zip3(self, self, |x, _, _| f(x))
    }

    /// Applies `f` to each triple of numbers. Its results are the numbers of two.
    fn zip3(self, second: Self, third: Self, f: impl FnMut(S, S, S) -> (S, S)) -> (Self, Self);

    /// Whether |x| ≤ `limit` for all numbers x; false for NaN.
    fn all_abs_le(self, limit: Self) -> bool;

    /// `yes` where |x| ≤ `limit`, `no` elsewhere and for NaN.
    #[inline(always)]
    fn select_abs_le(self, limit: S, yes: Self, no: Self) -> Self {
        let select = |x: S, yes, no| if x.abs() <= limit { yes } else { no };
        let (selected, _) = self.zip3(yes, no, |x, y, z| (select(x, y, z), z));
        selected
    }

    /// Which numbers are above the other one: false for NaN.
    fn simd_gt(self, other: Self) -> Self::Mask;

    /// Each number rounded to `f32`.
    fn to_f32(self) -> Self::Single;

    /// `yes` where `mask` is true, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// Each number clamped to \[`min`, `max`\]; NaN stays NaN.
    #[inline(always)]
    fn simd_clamp(self, min: Self, max: Self) -> Self {
        self.zip(max, |x, max| if x > max { max } else { x })
            .zip(min, |x, min| if x < min { min } else { x })
    }
}

impl<S: Real> Numbers<S> for S {
    type Mask = bool;
    type Single = f32;
    const IS_ONE: bool = true;
    const LEN: usize = 1;

    #[inline(always)]
    fn lane(&self, _: usize) -> S {
        *self
    }

    #[inline(always)]
    fn set_lane(&mut self, _: usize, x: S) {
        *self = x;
    }

    #[inline(always)]
    fn splat(x: S) -> Self {
        x
    }

    #[inline(always)]
    fn zip(self, other: Self, mut f: impl FnMut(S, S) -> S) -> Self {
        f(self, other)
    }

    #[inline(always)]
    fn zip3(self, second: S, third: S, mut f: impl FnMut(S, S, S) -> (S, S)) -> (S, S) {
        f(self, second, third)
    }

    #[inline(always)]
    fn all_abs_le(self, limit: S) -> bool {
        self.abs() <= limit
    }

    #[inline(always)]
    fn simd_gt(self, other: S) -> bool {
        self > other
    }

    #[inline(always)]
    fn to_f32(self) -> f32 {
        self.to_f64() as f32
    }

    #[inline(always)]
    fn select(mask: bool, yes: S, no: S) -> S {
        if mask { yes } else { no }
    }
}

/// `N` numbers: a plain array and loops over it, which LLVM compiles to the SIMD instructions of
/// the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes<S, const N: usize>(pub(crate) [S; N]);

impl<S: Real, const N: usize> Zeros for Lanes<S, N> {
    const ZEROS: Self = Self([S::ZERO; N]);
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

// Loops and not `array::map`, which LLVM keeps out of line, where it may not use the SIMD
// instructions of its caller.
impl<S: Real, const N: usize> Numbers<S> for Lanes<S, N> {
    type Mask = [bool; N];
    type Single = Lanes<f32, N>;
    const IS_ONE: bool = false;
    const LEN: usize = N;

    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "the callers' loops end below N")]
    fn lane(&self, i: usize) -> S {
        self.0[i]
    }

    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "the callers' loops end below N")]
    fn set_lane(&mut self, i: usize, x: S) {
        self.0[i] = x;
    }

    #[inline(always)]
    fn splat(x: S) -> Self {
        Self([x; N])
    }

    #[inline(always)]
    fn zip(mut self, other: Self, mut f: impl FnMut(S, S) -> S) -> Self {
        for (x, y) in self.0.iter_mut().zip(other.0) {
            *x = f(*x, y);
        }
        self
    }

    #[inline(always)]
    fn zip3(
        self,
        mut second: Self,
        mut third: Self,
        mut f: impl FnMut(S, S, S) -> (S, S),
    ) -> (Self, Self) {
        for ((x, y), z) in self.0.iter().zip(&mut second.0).zip(&mut third.0) {
            (*y, *z) = f(*x, *y, *z);
        }
        (second, third)
    }

    #[inline(always)]
    fn all_abs_le(self, limit: Self) -> bool {
        let pairs = self.0.iter().zip(&limit.0);
        pairs.fold(true, |all, (x, limit)| all & (x.abs() <= *limit))
    }

    #[inline(always)]
    fn simd_gt(self, other: Self) -> [bool; N] {
        let mut mask = [false; N];
        for ((mask, x), y) in mask.iter_mut().zip(self.0).zip(other.0) {
            *mask = x > y;
        }
        mask
    }

    #[inline(always)]
    fn to_f32(self) -> Lanes<f32, N> {
        let mut numbers = [0.0; N];
        for (number, x) in numbers.iter_mut().zip(self.0) {
            *number = x.to_f64() as f32;
        }
        Lanes(numbers)
    }

    #[inline(always)]
    fn select(mask: [bool; N], yes: Self, no: Self) -> Self {
        let mut numbers = no;
        for (((number, mask), yes), no) in numbers.0.iter_mut().zip(mask).zip(yes.0).zip(no.0) {
            *number = if mask { yes } else { no };
        }
        numbers
    }
}

/// Lane `i` of some numbers.
#[inline(always)]
pub fn lanes<S: Real, V: Numbers<S>, const K: usize>(x: &[V; K], i: usize) -> [S; K] {
    let mut lanes = [S::ZERO; K];
    for (lane, x) in lanes.iter_mut().zip(x) {
        *lane = x.lane(i);
    }
    lanes
}

/// Sets lane `i` of some numbers.
#[inline(always)]
pub fn set_lanes<S: Real, V: Numbers<S>, const K: usize>(places: &mut [V; K], i: usize, x: [S; K]) {
    for (place, x) in places.iter_mut().zip(x) {
        place.set_lane(i, x);
    }
}

/// Lane `i` of a pair.
#[inline(always)]
pub fn pair<S: Real, V: Numbers<S>>((x, y): &(V, V), i: usize) -> (S, S) {
    (x.lane(i), y.lane(i))
}
