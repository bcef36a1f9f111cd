//! The classical Runge-Kutta method of fourth order.

use core::ops::{Add, Mul};

use super::arithmetic::Arithmetic;
use super::equations::derivative;
use super::model::{Form, Model};
use crate::math::{Numbers, Real, SinCos};

/// The state \[θ1, θ2, θ̇1, θ̇2\] one dt after `y`, under a constant torque, N m. `sin_cos` are the
/// sines and cosines of θ1 and θ2.
// No closure for the derivative: LLVM keeps a large one out of line, without its caller's SIMD. Two
// functions: in one, a step of `Fast` needs 92 instructions more on a Cortex-M4F.
#[inline(always)]
pub(super) fn rk4<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &Model<V>,
    y: [V; 4],
    sin_cos: [SinCos<V>; 2],
    torque: V,
) -> [V; 4] {
    let k1 = derivative::<A, V>(model, y, Some(sin_cos), torque);
    match A::FORM {
        Form::Lean => compact::<A, V>(model, y, k1, torque),
        Form::Gymnasium => classical::<A, V>(model, y, k1, torque),
    }
}

/// Gymnasium's order of additions.
#[inline(always)]
fn classical<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &Model<V>,
    y: [V; 4],
    k1: [V; 4],
    torque: V,
) -> [V; 4] {
    let common = &model.constants;
    let (half, dt, sixth) = (common.half_dt, model.params.dt, common.sixth_dt);
    let k2 = derivative::<A, V>(model, plus_scaled(y, half, k1), None, torque);
    let k3 = derivative::<A, V>(model, plus_scaled(y, half, k2), None, torque);
    let k4 = derivative::<A, V>(model, plus_scaled(y, dt, k3), None, torque);
    let [one, two] = [1.0, 2.0].map(|x| V::splat(A::Scalar::from_f64(x)));
    let sum = plus_scaled(plus_scaled(k1, two, k2), two, k3);
    plus_scaled(y, sixth, plus_scaled(sum, one, k4))
}

/// Adds each stage to the result at once, so few numbers are alive. The loop inlines the derivative
/// once.
#[inline(always)]
fn compact<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &Model<V>,
    y: [V; 4],
    k1: [V; 4],
    torque: V,
) -> [V; 4] {
    let common = &model.constants;
    let sixth = common.sixth_dt;
    let third = sixth + sixth;
    let mut next = plus_scaled(y, sixth, k1);
    let mut k = k1;
    let mut h = common.half_dt;
    let mut stage = 2;
    loop {
        k = derivative::<A, V>(model, plus_scaled(y, h, k), None, torque);
        if stage == 4 {
            return plus_scaled(next, sixth, k);
        }
        next = plus_scaled(next, third, k);
        if stage == 3 {
            h = model.params.dt;
        }
        stage += 1;
    }
}

/// y + h k.
// Not a loop, which LLVM can vectorize across the four numbers instead of across their lanes.
#[inline(always)]
pub(crate) fn plus_scaled<V: Copy + Add<Output = V> + Mul<Output = V>>(
    [y1, y2, y3, y4]: [V; 4],
    h: V,
    [k1, k2, k3, k4]: [V; 4],
) -> [V; 4] {
    [y1 + h * k1, y2 + h * k2, y3 + h * k3, y4 + h * k4]
}
