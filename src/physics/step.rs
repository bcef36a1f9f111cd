//! One step, of one acrobot or of many side by side.

use super::arithmetic::Arithmetic;
use super::equations::wrap;
use super::model::Model;
use super::rk4::rk4;
use crate::math::{Numbers, Real, SinCos};

/// Advances `y` = \[θ1, θ2, θ̇1, θ̇2\] and the sines and cosines of θ1 and θ2 by one dt under a
/// constant torque, N m.
#[inline(always)]
pub(crate) fn step<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &Model<V>,
    y: &mut [V; 4],
    sin_cos: &mut [SinCos<V>; 2],
    torque: V,
) {
    let angles = [y[0], y[1]];
    *y = rk4::<A, V>(model, *y, *sin_cos, torque);
    // One acrobot seldom leaves its bounds: out of line this saves flash. Among many lanes one
    // often does, and a function out of line may not use the SIMD instructions of its caller.
    if !V::IS_ONE {
        enforce_bounds::<A, V>(model, y, angles);
    } else if !is_within_bounds::<A, V>(model, y) {
        enforce_bounds_out_of_line::<A, V>(model, y, angles);
    }
    *sin_cos = [A::sin_cos_near(y[0]), A::sin_cos_near(y[1])];
}

/// Whether all angles are within ±π and all velocities within their bounds; false for NaN.
#[inline(always)]
fn is_within_bounds<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &Model<V>,
    [theta1, theta2, dtheta1, dtheta2]: &[V; 4],
) -> bool {
    let pi = V::splat(A::Scalar::PI);
    // Read before the comparisons: otherwise a step takes 13 instructions more on x86-64.
    let (limit1, limit2) = (model.params.max_velocity1, model.params.max_velocity2);
    theta1.all_abs_le(pi)
        && theta2.all_abs_le(pi)
        && dtheta1.all_abs_le(limit1)
        && dtheta2.all_abs_le(limit2)
}

#[inline(never)]
fn enforce_bounds_out_of_line<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &Model<V>,
    y: &mut [V; 4],
    angles: [V; 2],
) {
    enforce_bounds::<A, V>(model, y, angles);
}

/// Wraps the angles and bounds the velocities. A result that is not finite becomes the angles
/// before the step, at rest.
#[inline(always)]
fn enforce_bounds<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &Model<V>,
    y: &mut [V; 4],
    [before1, before2]: [V; 2],
) {
    let zero = V::splat(A::Scalar::ZERO);
    let [theta1, theta2, dtheta1, dtheta2] = *y;
    // 0 times a number that is not finite is NaN.
    let zeros = ((theta1 * zero + theta2 * zero) + dtheta1 * zero) + dtheta2 * zero;
    if !zeros.all_abs_le(zero) {
        let or = |x, otherwise| zeros.select_abs_le(A::Scalar::ZERO, x, otherwise);
        *y = [or(theta1, before1), or(theta2, before2), or(dtheta1, zero), or(dtheta2, zero)];
    }
    let [theta1, theta2, dtheta1, dtheta2] = *y;
    let (limit1, limit2) = (model.params.max_velocity1, model.params.max_velocity2);
    *y = [
        wrap::<A, V>(theta1),
        wrap::<A, V>(theta2),
        dtheta1.simd_clamp(-limit1, limit1),
        dtheta2.simd_clamp(-limit2, limit2),
    ];
}
