//! The reward of a swing-up.

use super::arithmetic::Arithmetic;
use super::geometry;
use super::params::Params;
use super::task::Task;
use crate::math::{Numbers, Real, SinCos};

/// The reward of a swing-up: dm_control's `tolerance` of the distance from the tip to the target,
/// 0.1^(d²) at d metres from its edge. `None` for Gymnasium's task.
#[inline(always)]
pub(crate) fn reward<A: Arithmetic, V: Numbers<A::Scalar>>(
    params: &Params<V>,
    sin_cos: [SinCos<V>; 2],
) -> Option<V> {
    const TARGET: f64 = 2.0;
    const RADIUS: f64 = 0.2;
    let number = |x| V::splat(A::Scalar::from_f64(x));
    let is_sparse = match A::TASK {
        Task::Acrobot => return None,
        Task::Swingup => false,
        Task::SwingupSparse => true,
    };
    let [_, [x, y]] = geometry::positions(params, sin_cos);
    let below = number(TARGET) - y;
    let distance = (x * x + below * below).map(Real::sqrt);
    let beyond = distance - number(RADIUS);
    let outside = if is_sparse {
        number(0.0)
    } else {
        exp2(beyond * beyond * number(-core::f64::consts::LOG2_10))
    };
    Some(distance.select_within(A::Scalar::from_f64(RADIUS), number(1.0), outside))
}

/// 2^x for x up to 0, for rewards, which are `f32`. Below −100, and for NaN, 2^−100.
#[inline(always)]
fn exp2<S: Real, V: Numbers<S>>(x: V) -> V {
    const LEAST: f64 = -100.0;
    let number = |x| V::splat(S::from_f64(x));
    let x = x.select_within(S::from_f64(-LEAST), x, number(LEAST));
    let whole = x.map(S::round_small);
    // The Taylor series of e^y, |y| ≤ ln 2 / 2. Its first omitted term is at most 6e-9.
    let y = (x - whole) * number(core::f64::consts::LN_2);
    let factorials = [720.0, 120.0, 24.0, 6.0, 2.0, 1.0, 1.0];
    let series = factorials
        .into_iter()
        .fold(number(1.0 / 5040.0), |sum, factorial| sum * y + number(1.0 / factorial));
    series * whole.map(S::power_of_two)
}
