//! Some `f32` side by side: the numbers that a batch of [`Fast`](crate::Fast) computes in.
//!
//! Plain arrays and loops over them, which LLVM turns into whatever vectors the target has.

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::arithmetic::{Numbers, QuarterTurns, Real};

#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Lanes<const N: usize>(pub(crate) [f32; N]);

impl<const N: usize> Lanes<N> {
    // Loops, for LLVM keeps `array::map` apart, without the vectors that its caller may use.
    #[inline(always)]
    pub(crate) fn map(mut self, mut f: impl FnMut(f32) -> f32) -> Self {
        for x in &mut self.0 {
            *x = f(*x);
        }
        self
    }

    /// [`wrap`](crate::wrap) without a branch.
    #[inline(always)]
    pub(crate) fn wrap(self) -> Self {
        let turns = self * Self::splat((1.0 / core::f64::consts::TAU) as f32);
        let turns = turns.map(Real::round_small);
        let turned = (self - turns * Self::splat(<f32 as Real>::TAU)).bound(<f32 as Real>::PI);
        self.zip(turned, |x, turned| {
            if x.abs() <= <f32 as Real>::PI {
                x
            } else {
                turned
            }
        })
    }

    /// [`bound`](crate::bound) without a branch.
    #[inline(always)]
    pub(crate) fn bound(self, limit: f32) -> Self {
        self.map(|x| if x > limit { limit } else { x })
            .map(|x| if x < -limit { -limit } else { x })
    }

    #[inline(always)]
    pub(crate) fn zip(mut self, other: Self, mut f: impl FnMut(f32, f32) -> f32) -> Self {
        for (x, y) in self.0.iter_mut().zip(other.0) {
            *x = f(*x, y);
        }
        self
    }
}

macro_rules! lane_by_lane {
    ($($trait:ident $method:ident),*) => {$(
        impl<const N: usize> $trait for Lanes<N> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, f32::$method)
            }
        }
    )*};
}

lane_by_lane!(Add add, Sub sub, Mul mul, Div div);

impl<const N: usize> Neg for Lanes<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.map(f32::neg)
    }
}

impl<const N: usize> Numbers<f32> for Lanes<N> {
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self([x; N])
    }
}

impl<const N: usize> QuarterTurns for Lanes<N> {
    /// By picking and by flipping signs. What the table of `f32` makes NaN is infinite here; neither
    /// gives a step that is finite.
    #[inline(always)]
    fn rotate(turns: Self, mut sin: Self, mut cos: Self) -> (Self, Self) {
        const SIGN: u32 = 1 << 31;
        for ((turns, sin), cos) in turns.0.iter().zip(&mut sin.0).zip(&mut cos.0) {
            let turns = turns.to_bits();
            let even = (turns & 1).wrapping_sub(1);
            let kept = (sin.to_bits() ^ cos.to_bits()) & even;
            let turned_sin = cos.to_bits() ^ kept ^ (turns << 30 & SIGN);
            let turned_cos = sin.to_bits() ^ kept ^ (turns.wrapping_add(1) << 30 & SIGN);
            *sin = f32::from_bits(turned_sin);
            *cos = f32::from_bits(turned_cos);
        }
        (sin, cos)
    }
}
