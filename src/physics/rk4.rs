//! The classical Runge-Kutta method of fourth order, for any derivative.

use core::ops::{Add, Mul};

use crate::math::{Numbers, Real};

/// One step of the classical Runge-Kutta method: approximates the solution of `y' = derivative(y)` after the time `dt`.
/// The order of operations is Gymnasium's.
///
/// ```
/// let y = acrobot::physics::rk4([1.0_f64], 0.1, |[y]| [-y]);
/// assert!((y[0] - (-0.1_f64).exp()).abs() < 1e-7);
/// ```
#[must_use]
#[inline]
pub fn rk4<S: Real, const N: usize>(
    y: [S; N],
    dt: S,
    derivative: impl Fn([S; N]) -> [S; N],
) -> [S; N] {
    let dts = [dt * S::from_f64(0.5), dt, dt / S::from_f64(6.0)];
    let k1 = Any(derivative(y));
    classical(Any(y), k1, dts, &Closure(derivative)).0
}

/// The state of any system.
#[derive(Clone, Copy)]
struct Any<S, const N: usize>([S; N]);

impl<S: Real, const N: usize> Along<S> for Any<S, N> {
    #[inline(always)]
    fn along(mut self, h: S, k: Self) -> Self {
        for (y, k) in self.0.iter_mut().zip(k.0) {
            *y = *y + h * k;
        }
        self
    }
}

struct Closure<F>(F);

impl<S, const N: usize, F: Fn([S; N]) -> [S; N]> Derivative<Any<S, N>> for Closure<F> {
    #[inline(always)]
    fn at(&self, y: Any<S, N>) -> Any<S, N> {
        Any((self.0)(y.0))
    }
}

/// The right side of `y' = f(y)`. It is not a closure, because closures cannot be marked for inlining: LLVM keeps a
/// large one out of line, where it may not use the SIMD instructions of its caller.
pub trait Derivative<Y> {
    /// f(y).
    fn at(&self, y: Y) -> Y;
}

/// A state, to which a multiple of its derivative can be added.
pub trait Along<V>: Copy {
    /// y + h k.
    fn along(self, h: V, k: Self) -> Self;
}

impl<V: Copy + Add<Output = V> + Mul<Output = V>> Along<V> for [V; 4] {
    // Not a loop, which LLVM can vectorize across the four numbers instead of across their lanes.
    #[inline(always)]
    fn along(self, h: V, k: Self) -> Self {
        let ([y1, y2, y3, y4], [k1, k2, k3, k4]) = (self, k);
        [y1 + h * k1, y2 + h * k2, y3 + h * k3, y4 + h * k4]
    }
}

/// [`rk4`], given `k1`, the derivative at `y`, and dt/2, dt and dt/6.
#[inline(always)]
pub(super) fn classical<S: Real, V: Numbers<S>, Y: Along<V>>(
    y: Y,
    k1: Y,
    [half, dt, sixth]: [V; 3],
    derivative: &impl Derivative<Y>,
) -> Y {
    let k2 = derivative.at(y.along(half, k1));
    let k3 = derivative.at(y.along(half, k2));
    let k4 = derivative.at(y.along(dt, k3));
    let [one, two] = [V::splat(S::ONE), V::splat(S::from_f64(2.0))];
    y.along(sixth, k1.along(two, k2).along(two, k3).along(one, k4))
}

/// [`classical`] with another order of additions: a loop adds each stage to the result at once. Few numbers are alive
/// at a time, and the derivative is inlined only once, which saves flash.
#[inline(always)]
pub(super) fn compact<V: Copy + Add<Output = V>, Y: Along<V>>(
    y: Y,
    k1: Y,
    [half, dt, sixth]: [V; 3],
    derivative: &impl Derivative<Y>,
) -> Y {
    let third = sixth + sixth;
    let mut next = y.along(sixth, k1);
    let mut k = k1;
    let mut h = half;
    let mut stage = 2;
    loop {
        k = derivative.at(y.along(h, k));
        if stage == 4 {
            return next.along(sixth, k);
        }
        next = next.along(third, k);
        if stage == 3 {
            h = dt;
        }
        stage += 1;
    }
}
