//! The derivatives of the accelerations.

use crate::arithmetic::Arithmetic;
use crate::math::{Numbers, Real, SinCos};
use crate::physics::{Constants, Model, Modeled, coulomb_friction, directions, friction};

/// M of the absolute angles α = θ1 and β = θ1 + θ2, with the rows \[upper, between\] and
/// \[between, link2\], kg m².
pub(in crate::control) struct MassMatrix<S> {
    upper: S,
    between: S,
    link2: S,
    /// 1 over the determinant.
    inverse: S,
}

impl<S: Modeled> MassMatrix<S> {
    #[inline(always)]
    pub(in crate::control) fn new<A: Arithmetic<Scalar = S>>(
        model: &Model<S>,
        sin_cos2: SinCos<S>,
    ) -> Self {
        let (Constants { coupling, link2, .. }, params) = (model.constants, &model.params);
        let [link1, tip, ..] = S::inertias(params);
        let (coupling_sin, coupling_cos) = (coupling * sin_cos2.0, coupling * sin_cos2.1);
        // U L − c² as a sum in which nothing cancels without a rotor.
        let mut determinant = link1 * link2 + tip * params.inertia2 + coupling_sin * coupling_sin;
        let mut between = coupling_cos;
        if A::HAS_FRICTION {
            between = coupling_cos - params.rotor;
            determinant = determinant + params.rotor * (coupling_cos + between);
        }
        Self { upper: link1 + tip, between, link2, inverse: S::from_f64(1.0) / determinant }
    }

    /// \[θ̈1, θ̈2\] by forces on α and β, N m.
    #[inline(always)]
    pub(in crate::control) fn solve(&self, [force1, force2]: [S; 2]) -> [S; 2] {
        let alpha = (self.link2 * force1 - self.between * force2) * self.inverse;
        let beta = (self.upper * force2 - self.between * force1) * self.inverse;
        [alpha, beta - alpha]
    }
}

/// \[θ̈1, θ̈2\], and their derivatives by θ1, θ2, θ̇1, θ̇2 and the torque.
///
/// The equations M q̈ = f for the absolute angles are those of docs/equations.md. The derivative by
/// p is M⁻¹ (∂f/∂p − ∂M/∂p q̈). Nothing cancels in the determinant, where Gymnasium's form loses
/// digits if one link is much heavier than the other.
#[inline(always)]
pub(in crate::control) fn partials<A: Arithmetic>(
    model: &Model<A::Scalar>,
    [_, _, dtheta1, dtheta2]: [A::Scalar; 4],
    [(sin1, cos1), (sin2, cos2)]: [SinCos<A::Scalar>; 2],
    torque: A::Scalar,
) -> ([A::Scalar; 2], [[A::Scalar; 2]; 5]) {
    let (zero, one) = (A::Scalar::ZERO, A::Scalar::from_f64(1.0));
    let Constants { coupling, gravity1, gravity2, nips, .. } = model.constants;
    let (coupling_sin, coupling_cos) = (coupling * sin2, coupling * cos2);
    let mass = MassMatrix::new::<A>(model, (sin2, cos2));
    let solve = |forces| mass.solve(forces);
    let [mut resistance1, mut resistance2] = [(zero, zero); 2];
    if A::HAS_FRICTION {
        [resistance1, resistance2] = friction::<A, A::Scalar>(model, [dtheta1, dtheta2]);
    }

    // The term in α̇² acts on link 2 in the book's equations, and on link 1 in those of the paper.
    let book = one - nips;
    let (dalpha, dbeta) = (dtheta1, dtheta1 + dtheta2);
    let [_, (sin_sum, cos_sum)] = directions([(sin1, cos1), (sin2, cos2)]);
    let fall = -(gravity2 * cos_sum);
    let dalpha_squared = dalpha * dalpha;
    let twice_sin = coupling_sin + coupling_sin;
    let ((friction1, slope1), (friction2, slope2)) = (resistance1, resistance2);
    let force1 = coupling_sin * (dbeta * dbeta - nips * dalpha_squared)
        - gravity1 * sin1
        - torque
        - friction1
        + friction2;
    let force2 = torque - gravity2 * sin_sum - coupling_sin * (book * dalpha_squared) - friction2;
    let [ddalpha, ddtheta2] = solve([force1, force2]);
    let ddbeta = ddalpha + ddtheta2;
    let derivatives = [
        [-(gravity1 * cos1), fall],
        [
            coupling_cos * (dbeta * dbeta - nips * dalpha_squared) + coupling_sin * ddbeta,
            fall - coupling_cos * (book * dalpha_squared) + coupling_sin * ddalpha,
        ],
        [twice_sin * (dbeta - nips * dalpha) - slope1, -(twice_sin * (book * dalpha))],
        [twice_sin * dbeta + slope2, -slope2],
        [-one, one],
    ]
    .map(solve);
    ([ddalpha, ddtheta2], derivatives)
}

/// How many parameters act on the accelerations.
pub(in crate::control) const PARAMETERS: usize = 13;

/// ∂f/∂p − ∂M/∂p q̈ of a motion with the accelerations \[a1, a2\], for each parameter.
#[inline(always)]
pub(in crate::control) fn by_parameters<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &Model<V>,
    [v1, v2]: [V; 2],
    sines: [SinCos<V>; 2],
    [a1, a2]: [V; 2],
) -> [[V; 2]; PARAMETERS] {
    let (o, one) = (V::ZEROS, V::splat(A::Scalar::from_f64(1.0)));
    let (params, nips) = (&model.params, model.constants.nips);
    let (l1, lc1, lc2) = (params.length1, params.center_of_mass1, params.center_of_mass2);
    let [_, (sin2, cos2)] = sines;
    let [(sin1, _), (sin_sum, _)] = directions(sines);
    let (weight1, weight2) = (params.gravity * sin1, params.gravity * sin_sum);
    let (coulomb1, _) = coulomb_friction::<A, V>(model, v1);
    let (coulomb2, _) = coulomb_friction::<A, V>(model, v2);
    let (square, sum) = (v1 * v1, v1 + v2);
    // Of l1 lc2 m2: what the links do to each other.
    let on_link1 = sin2 * (sum * sum - nips * square) - cos2 * (a1 + a2);
    let on_link2 = -(sin2 * ((one - nips) * square)) - cos2 * a1;
    let of_tip = lc2 * on_link1 - weight1 - l1 * a1;
    let of_center2 = l1 * on_link2 - weight2 - lc2 * (a1 + a2);
    let (m1, m2) = (params.mass1, params.mass2);
    [
        [m2 * (of_tip - l1 * a1), m2 * lc2 * on_link2],
        [-(lc1 * (weight1 + lc1 * a1)), o],
        [l1 * of_tip, lc2 * of_center2],
        [-(m1 * (weight1 + (lc1 + lc1) * a1)), o],
        [m2 * l1 * on_link1, m2 * (of_center2 - lc2 * (a1 + a2))],
        [-a1, o],
        [o, -(a1 + a2)],
        [-((m1 * lc1 + m2 * l1) * sin1), -(m2 * lc2 * sin_sum)],
        [-v1, o],
        [v2, -v2],
        [-coulomb1, o],
        [coulomb2, -coulomb2],
        [a1 + a2, a1],
    ]
}
