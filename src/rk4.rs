//! The classical Runge-Kutta method of fourth order. No physics.

use core::array::from_fn;

use crate::arithmetic::Real;

/// One step of the classical Runge-Kutta method: the solution of `y' = derivative(y)` after the
/// time `dt`, in Gymnasium's order of operations.
///
/// ```
/// let y = acrobot::rk4([1.0_f64], 0.1, |[y]| [-y]);
/// assert!((y[0] - (-0.1_f64).exp()).abs() < 1e-7);
/// ```
#[must_use]
#[inline]
pub fn rk4<S: Real, const N: usize>(
    y: [S; N],
    dt: S,
    derivative: impl Fn([S; N]) -> [S; N],
) -> [S; N] {
    rk4_from(y, derivative(y), dt, derivative)
}

/// The same, where `k1`, the derivative at `y`, is known already.
#[inline]
#[expect(clippy::indexing_slicing, reason = "from_fn counts up to N")]
pub(crate) fn rk4_from<S: Real, const N: usize>(
    y: [S; N],
    k1: [S; N],
    dt: S,
    derivative: impl Fn([S; N]) -> [S; N],
) -> [S; N] {
    let two = S::from_f64(2.0);
    let half = dt * S::from_f64(0.5);
    let sixth = dt / S::from_f64(6.0);
    let along = |h: S, k: [S; N]| from_fn(|i| y[i] + h * k[i]);

    let k2 = derivative(along(half, k1));
    let k3 = derivative(along(half, k2));
    let k4 = derivative(along(dt, k3));
    from_fn(|i| y[i] + sixth * (((k1[i] + two * k2[i]) + two * k3[i]) + k4[i]))
}
