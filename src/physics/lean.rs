//! The lean form: one division and the sines and cosines of θ1 and θ2 for each evaluation.

use super::arithmetic::Arithmetic;
use super::friction::friction;
use super::model::{Constants, Model};
use super::params::Params;
use crate::math::sealed::Sealed;
use crate::math::{Numbers, Real, SinCos};

/// The determinant is a positive constant plus a square, so nothing cancels. Gymnasium's cos(θ1 −
/// π/2) is sin θ1 here, and its cos(θ1 + θ2 − π/2) is sin(θ1 + θ2), by the addition theorem.
#[inline(always)]
pub(super) fn derivative<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &Model<V>,
    [theta1, theta2, dtheta1, dtheta2]: [V; 4],
    sin_cos: Option<[SinCos<V>; 2]>,
    torque: V,
) -> [V; 4] {
    let [(sin1, cos1), (sin2, cos2)] = match sin_cos {
        Some(sin_cos) => sin_cos,
        None => [A::sin_cos_near(theta1), A::sin_cos_near(theta2)],
    };
    let &Constants {
        coupling,
        link2,
        gravity1,
        gravity2,
        nips,
        own: [upper, determinant, book, dry, _], // kg m², kg² m⁴, 1, N m or kg m²
        ..
    } = &model.constants;
    let mut coupling_cos = coupling * cos2;
    let coupling_sin = coupling * sin2;
    let mut determinant = determinant + coupling_sin * coupling_sin;
    let sin_sum = sin1 * cos2 + cos1 * sin2;
    let dtheta_sum = dtheta1 + dtheta2;
    let square = dtheta1 * dtheta1;

    // The generalized forces: the negated one on θ1, and the one on θ1 + θ2.
    let mut torque = torque;
    let mut force1 = gravity1 * sin1 - coupling_sin * (dtheta_sum * dtheta_sum - nips * square);
    // Friction takes a quarter of a step of one acrobot, and a tenth where a block has 4 lanes, as
    // in WebAssembly. With 16 lanes it takes 2 %, and a branch would cost more.
    if A::HAS_FRICTION && V::LEN <= 4 && dry.all_abs_le(V::splat(A::Scalar::ZERO)) {
        let Params { damping1, damping2, .. } = model.params;
        torque = torque - damping2 * dtheta2;
        force1 = (force1 + torque) + damping1 * dtheta1;
    } else if A::HAS_FRICTION {
        let [(friction1, _), (friction2, _)] = friction::<A, V>(model, [dtheta1, dtheta2]);
        torque = torque - friction2;
        force1 = (force1 + torque) + friction1;
        let rotor = model.params.rotor;
        determinant = determinant + rotor * (coupling_cos + (coupling_cos - rotor));
        coupling_cos = coupling_cos - rotor;
    } else {
        force1 = force1 + torque;
    }
    let force2 = torque - gravity2 * sin_sum - coupling_sin * (book * square);
    let inverse = V::splat(A::Scalar::ONE) / determinant;
    let common = link2 * force1 + coupling_cos * force2;
    let ddtheta1 = -(common * inverse);
    let ddtheta2 = (common + upper * force2 + coupling_cos * force1) * inverse;
    [dtheta1, dtheta2, ddtheta1, ddtheta2]
}
