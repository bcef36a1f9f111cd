//! The classical Runge-Kutta method of fourth order, for any derivative.

use crate::arithmetic::{Numbers, Real};

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
    let k1 = derivative(y);
    classical(y, k1, dts, &Closure(derivative))
}

struct Closure<F>(F);

impl<V, const N: usize, F: Fn([V; N]) -> [V; N]> Derivative<V, N> for Closure<F> {
    #[inline(always)]
    fn at(&self, y: [V; N]) -> [V; N] {
        (self.0)(y)
    }
}

/// The right side of `y' = f(y)`. It is not a closure, because closures cannot be marked for inlining: LLVM keeps a
/// large one out of line, where it may not use the SIMD instructions of its caller.
pub trait Derivative<V, const N: usize> {
    /// f(y).
    fn at(&self, y: [V; N]) -> [V; N];
}

/// [`rk4`], given `k1`, the derivative at `y`, and dt/2, dt and dt/6.
#[inline(always)]
pub(super) fn classical<S: Real, V: Numbers<S>, const N: usize>(
    y: [V; N],
    k1: [V; N],
    dts: [S; 3],
    derivative: &impl Derivative<V, N>,
) -> [V; N] {
    let [half, dt, sixth] = dts.map(V::splat);
    let k2 = derivative.at(along(y, half, k1));
    let k3 = derivative.at(along(y, half, k2));
    let k4 = derivative.at(along(y, dt, k3));
    let two = V::splat(S::from_f64(2.0));
    along(y, sixth, sum(along(along(k1, two, k2), two, k3), k4))
}

/// [`classical`] with another order of additions: a loop adds each stage to the result at once. Few numbers are alive
/// at a time, and the derivative is inlined only once, which saves flash.
#[inline(always)]
pub(super) fn compact<S: Real, V: Numbers<S>, const N: usize>(
    y: [V; N],
    k1: [V; N],
    dts: [S; 3],
    derivative: &impl Derivative<V, N>,
) -> [V; N] {
    let [half, dt, sixth] = dts.map(V::splat);
    let third = sixth + sixth;
    let mut next = along(y, sixth, k1);
    let mut k = k1;
    let mut h = half;
    let mut stage = 2;
    loop {
        k = derivative.at(along(y, h, k));
        if stage == 4 {
            return along(next, sixth, k);
        }
        next = along(next, third, k);
        if stage == 3 {
            h = dt;
        }
        stage += 1;
    }
}

/// y + h k.
#[inline(always)]
fn along<S: Real, V: Numbers<S>, const N: usize>(mut y: [V; N], h: V, k: [V; N]) -> [V; N] {
    for (y, k) in y.iter_mut().zip(k) {
        *y = *y + h * k;
    }
    y
}

/// x + y.
#[inline(always)]
fn sum<S: Real, V: Numbers<S>, const N: usize>(mut x: [V; N], y: [V; N]) -> [V; N] {
    for (x, y) in x.iter_mut().zip(y) {
        *x = *x + y;
    }
    x
}
