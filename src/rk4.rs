//! The classical Runge-Kutta method of fourth order. No physics.

use core::array::from_fn;

use crate::arithmetic::{Form, Real};

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
    rk4_from(
        Form::Gymnasium,
        y,
        derivative(y),
        [dt * S::from_f64(0.5), dt, dt / S::from_f64(6.0)],
        &derivative,
        |derivative, y| derivative(y),
    )
}

/// The same, where `k1`, the derivative at `y`, is known already, and dt/2, dt and dt/6 too.
///
/// The lean form adds each stage to the result at once, in a loop: it keeps few numbers alive and the
/// derivative, inlined once, is small in flash. What `derivative` needs is in `context`, so that it
/// can be a function marked for inlining; LLVM keeps a closure apart.
#[inline(always)]
#[expect(clippy::indexing_slicing, reason = "from_fn counts up to N")]
pub(crate) fn rk4_from<S: Real, C, const N: usize>(
    form: Form,
    y: [S; N],
    k1: [S; N],
    [half, dt, sixth]: [S; 3],
    context: &C,
    derivative: impl Fn(&C, [S; N]) -> [S; N],
) -> [S; N] {
    let along = |h: S, k: [S; N]| from_fn(|i| y[i] + h * k[i]);
    match form {
        Form::Gymnasium => {
            let two = S::from_f64(2.0);
            let k2 = derivative(context, along(half, k1));
            let k3 = derivative(context, along(half, k2));
            let k4 = derivative(context, along(dt, k3));
            from_fn(|i| y[i] + sixth * (((k1[i] + two * k2[i]) + two * k3[i]) + k4[i]))
        }
        Form::Lean => {
            let third = sixth + sixth;
            let mut next: [S; N] = along(sixth, k1);
            let mut k = k1;
            let mut h = half;
            let mut stage = 2;
            loop {
                k = derivative(context, along(h, k));
                if stage == 4 {
                    return from_fn(|i| next[i] + sixth * k[i]);
                }
                next = from_fn(|i| next[i] + third * k[i]);
                if stage == 3 {
                    h = dt;
                }
                stage += 1;
            }
        }
    }
}
