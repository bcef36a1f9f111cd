//! Gymnasium's expressions, operation by operation.

use super::arithmetic::Arithmetic;
use super::friction::friction;
use super::model::{Constants, Model};
use super::params::Params;
use crate::math::sealed::Sealed;
use crate::math::{Numbers, Real, SinCos};

const MAX_TURNS: u32 = 64;

/// `AcrobotEnv._dsdt`, except for the place of the factors 2, which are exact.
// Inlined with `std`, because `Host` takes a tenth longer otherwise. On a microcontroller inlining
// would cost flash and gain nothing.
#[cfg_attr(feature = "std", inline(always))]
pub(super) fn derivative<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &Model<V>,
    [theta1, theta2, dtheta1, dtheta2]: [V; 4],
    sin_cos: Option<[SinCos<V>; 2]>,
    torque: V,
) -> [V; 4] {
    let &Constants { coupling, link2, gravity1, gravity2, nips, own, .. } = &model.constants;
    let [link1, arms_squared, arms_product, ..] = own; // kg m², m², m²
    let [.., lc2_squared, twice_coupling] = own; // m², kg m²
    let &Params { mass2: m2, inertia1, inertia2, .. } = &model.params;
    let (sin2, cos2) = match sin_cos {
        Some([_, second]) => second,
        None => A::sin_cos_near(theta2),
    };
    let (quarter, two) =
        (V::splat(A::Scalar::PI * A::Scalar::HALF), V::splat(A::Scalar::from_f64(2.0)));
    let square = |x: V| x.map(A::square);

    // Computed first, because no float stays in a register across a call on x86-64.
    let phi2 = gravity2 * A::cos_near(theta1 + theta2 - quarter);
    let cos1 = A::cos_near(theta1 - quarter);
    let arm = arms_product * cos2;
    let mut d1 = link1 + m2 * (arms_squared + two * arm) + inertia1 + inertia2;
    let mut d2 = m2 * (lc2_squared + arm) + inertia2;
    let mut torque = torque;
    let mut phi1 = -coupling * square(dtheta2) * sin2 - twice_coupling * dtheta2 * dtheta1 * sin2
        + gravity1 * cos1
        + phi2;
    if A::HAS_FRICTION {
        let [(friction1, _), (friction2, _)] = friction::<A, V>(model, [dtheta1, dtheta2]);
        torque = torque - friction2;
        phi1 = phi1 + friction1;
        let rotor = model.params.rotor;
        d1 = d1 - (rotor + rotor);
        d2 = d2 - rotor;
    }
    let driven = torque + d2 / d1 * phi1;
    let centrifugal = coupling * square(dtheta1) * sin2;
    let driven = nips.select_abs_le(A::Scalar::ZERO, driven - centrifugal, driven);
    let ddtheta2 = (driven - phi2) / (link2 - square(d2) / d1);
    let ddtheta1 = -(d2 * ddtheta2 + phi1) / d1;
    [dtheta1, dtheta2, ddtheta1, ddtheta2]
}

/// Subtracts turn by turn, as Gymnasium does. Beyond `MAX_TURNS`, where Gymnasium takes long or
/// never returns, it takes the remainder.
#[inline(always)]
pub(super) fn wrap<S: Real, V: Numbers<S>>(x: V) -> V {
    if !V::IS_ONE && x.all_abs_le(V::splat(S::PI)) {
        return x;
    }
    x.map(|mut x| {
        for _ in 0..MAX_TURNS {
            if x > S::PI {
                x = x - S::TAU;
            } else if x < -S::PI {
                x = x + S::TAU;
            } else {
                return x;
            }
        }
        wrap_by_remainder(x)
    })
}

#[cold]
fn wrap_by_remainder<S: Real>(x: S) -> S {
    let x = x.remainder(S::TAU);
    let turn = if x > S::PI {
        -S::TAU
    } else if x < -S::PI {
        S::TAU
    } else {
        S::ZERO
    };
    (x + turn).simd_clamp(-S::PI, S::PI)
}
