//! One step, of one acrobot or of many side by side.

use core::marker::PhantomData;

use super::rk4::{Derivative, classical, compact};
use super::{Arithmetic, Coefficients, Equations};
use crate::math::{Numbers, Real, SinCos};

/// Advances `y` = \[θ1, θ2, θ̇1, θ̇2\] and the sines and cosines of θ1 and θ2 by one dt under a constant torque, N m.
/// Returns whether the new state is a goal state.
#[inline(always)]
pub(crate) fn step<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &impl Coefficients<A, V>,
    y: &mut [V; 4],
    sin_cos: &mut [SinCos<V>; 2],
    torque: V,
) -> V::Mask {
    let common = A::Form::common(model.constants());
    let dts = [common.half_dt, model.dt(), common.sixth_dt];
    let k1 = A::Form::derivative(model, *y, Some(*sin_cos), torque);
    let forced = Forced {
        model,
        torque,
        arithmetic: PhantomData::<A>,
    };
    let angles = [y[0], y[1]];
    *y = if A::Form::COMPACT {
        compact(*y, k1, dts, &forced)
    } else {
        classical(*y, k1, dts, &forced)
    };
    // One acrobot seldom leaves its bounds, so this is out of line, which saves flash. Among many lanes one often does.
    // There it is inlined, because a function out of line may not use the SIMD instructions of its caller.
    if !V::IS_ONE {
        enforce_bounds(model, y, angles);
    } else if !is_within_bounds(model, y) {
        enforce_bounds_apart(model, y, angles);
    }
    *sin_cos = [model.sin_cos(y[0]), model.sin_cos(y[1])];
    A::Form::reaches_goal::<A, V>([y[0], y[1]], *sin_cos)
}

/// The equations of motion under a torque that is constant during a step.
struct Forced<'a, A, M, V> {
    model: &'a M,
    torque: V,
    arithmetic: PhantomData<A>,
}

impl<A, M, V> Derivative<[V; 4]> for Forced<'_, A, M, V>
where
    A: Arithmetic,
    M: Coefficients<A, V>,
    V: Numbers<A::Scalar>,
{
    #[inline(always)]
    fn at(&self, y: [V; 4]) -> [V; 4] {
        A::Form::derivative(self.model, y, None, self.torque)
    }
}

/// Whether all angles are within ±π and all velocities within their bounds; false for NaN.
#[inline(always)]
fn is_within_bounds<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &impl Coefficients<A, V>,
    [theta1, theta2, dtheta1, dtheta2]: &[V; 4],
) -> bool {
    let pi = V::splat(A::Scalar::PI);
    let [max_velocity1, max_velocity2] = model.max_velocities();
    theta1.all_within(pi)
        && theta2.all_within(pi)
        && dtheta1.all_within(max_velocity1)
        && dtheta2.all_within(max_velocity2)
}

#[inline(never)]
fn enforce_bounds_apart<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &impl Coefficients<A, V>,
    y: &mut [V; 4],
    angles: [V; 2],
) {
    enforce_bounds(model, y, angles);
}

/// Wraps the angles and bounds the velocities. A result that is not finite becomes the angles before the step with
/// zero velocities.
#[inline(always)]
fn enforce_bounds<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &impl Coefficients<A, V>,
    y: &mut [V; 4],
    [before1, before2]: [V; 2],
) {
    let zero = V::ZEROED;
    let [theta1, theta2, dtheta1, dtheta2] = *y;
    // 0 times a number that is not finite is NaN.
    let zeros = ((theta1 * zero + theta2 * zero) + dtheta1 * zero) + dtheta2 * zero;
    if !zeros.all_within(zero) {
        let or = |x, otherwise| zeros.select_within(A::Scalar::ZERO, x, otherwise);
        *y = [
            or(theta1, before1),
            or(theta2, before2),
            or(dtheta1, zero),
            or(dtheta2, zero),
        ];
    }
    let [theta1, theta2, dtheta1, dtheta2] = *y;
    let [max_velocity1, max_velocity2] = model.max_velocities();
    *y = [
        A::Form::wrap(theta1),
        A::Form::wrap(theta2),
        dtheta1.bound(max_velocity1),
        dtheta2.bound(max_velocity2),
    ];
}
