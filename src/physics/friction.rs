//! Friction of the joints.

use super::arithmetic::Arithmetic;
use super::model::Model;
use super::params::Params;
use crate::math::Numbers;
use crate::math::sealed::Sealed as _;

/// The torque against each velocity, N m, and its slope by that velocity: viscous friction in
/// proportion to it, and Coulomb's, which is smooth below a small velocity and constant above.
#[inline(always)]
pub(crate) fn friction<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &Model<V>,
    [dtheta1, dtheta2]: [V; 2],
) -> [(V, V); 2] {
    let Params { damping1, damping2, coulomb1, coulomb2, .. } = model.params;
    [
        resist::<A, V>(model, [damping1, coulomb1], dtheta1),
        resist::<A, V>(model, [damping2, coulomb2], dtheta2),
    ]
}

// No closure, which LLVM may keep out of line, without its caller's SIMD.
#[inline(always)]
fn resist<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &Model<V>,
    [viscous, coulomb]: [V; 2],
    dtheta: V,
) -> (V, V) {
    let (part, slope) = coulomb_friction::<A, V>(model, dtheta);
    (viscous * dtheta + coulomb * part, viscous + coulomb * slope)
}

/// Coulomb friction as a part of its largest torque, and the slope by the velocity, s/rad.
#[inline(always)]
pub(crate) fn coulomb_friction<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &Model<V>,
    dtheta: V,
) -> (V, V) {
    let one = V::splat(A::Scalar::ONE);
    let x = (dtheta * model.constants.inverse_width).simd_clamp(-one, one);
    let rest = V::splat(A::Scalar::HALF) * (one - x * x);
    (x + x * rest, (rest + (rest + rest)) * model.constants.inverse_width)
}
