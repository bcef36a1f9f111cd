//! Friction of the joints.

use super::arithmetic::Arithmetic;
use super::model::Model;
use crate::math::Numbers;
use crate::math::sealed::Sealed as _;

/// The torque against each velocity, N m, and its slope by that velocity: viscous friction in
/// proportion to it, and Coulomb's, which is smooth below a small velocity and constant above.
#[inline(always)]
pub(crate) fn friction<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &Model<V>,
    [dtheta1, dtheta2]: [V; 2],
) -> [(V, V); 2] {
    let (viscous, coulomb) = (model.params.friction, model.params.coulomb);
    let one = V::splat(A::Scalar::ONE);
    let half = V::splat(A::Scalar::HALF);
    let resist = |viscous: V, coulomb: V, dtheta: V| {
        let x = (dtheta * model.constants.dry).saturate(one);
        let rest = half * (one - x * x);
        let slope = viscous + coulomb * ((rest + (rest + rest)) * model.constants.dry);
        (viscous * dtheta + coulomb * (x + x * rest), slope)
    };
    [
        resist(viscous.joint1, coulomb.joint1, dtheta1),
        resist(viscous.joint2, coulomb.joint2, dtheta2),
    ]
}
