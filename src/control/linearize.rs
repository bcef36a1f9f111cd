//! The derivatives of the equations of motion.

use super::error::ControlError;
use super::matrix::check_finite;
use crate::arithmetic::Arithmetic;
use crate::math::{Real, SinCos};
use crate::physics::{Constants, Model, Pendulum, check_torque, directions, friction};

/// A linear model: x is the deviation from a state \[θ1, θ2, θ̇1, θ̇2\], rad and rad/s, and u that
/// from a torque, N m. The equations of motion give ẋ = A x + B u, one step gives x′ = A x + B u.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LinearModel<S = f64> {
    /// A by rows: `a[i][j]` is the derivative of the i-th result by the j-th number of the state.
    pub a: [[S; 4]; 4],
    /// B: the derivatives of the results by the torque.
    pub b: [S; 4],
}

/// Linearizes the equations of motion about the pendulum's state and a torque, N m: A and B of
/// ẋ = A x + B u, exact up to rounding.
///
/// The state need not be an equilibrium. Bounds of the velocities do not count.
///
/// # Errors
///
/// [`ControlError::Invalid`] for a torque that is not finite, and [`ControlError::NotFinite`] if an
/// element overflows.
pub fn linearize<A: Arithmetic>(
    pendulum: &Pendulum<A>,
    torque: A::Scalar,
) -> Result<LinearModel<A::Scalar>, ControlError> {
    check_torque(torque)?;
    let (zero, one) = (A::Scalar::ZERO, A::Scalar::from_f64(1.0));
    let y = pendulum.state().into();
    let (_, [by_state @ .., by_torque]) =
        partials::<A>(pendulum.model(), y, pendulum.sin_cos(), torque);
    let model = LinearModel {
        a: [
            [zero, zero, one, zero],
            [zero, zero, zero, one],
            by_state.map(|[ddtheta1, _]| ddtheta1),
            by_state.map(|[_, ddtheta2]| ddtheta2),
        ],
        b: [zero, zero, by_torque[0], by_torque[1]],
    };
    check_finite("a", model.a.as_flattened())?;
    check_finite("b", &model.b)?;
    Ok(model)
}

/// M of the absolute angles α = θ1 and β = θ1 + θ2, with the rows \[upper, between\] and
/// \[between, link2\], kg m².
pub(super) struct MassMatrix<S> {
    upper: S,
    between: S,
    link2: S,
    /// 1 over the determinant.
    inverse: S,
}

impl<S: Real> MassMatrix<S> {
    #[inline(always)]
    pub(super) fn new<A: Arithmetic<Scalar = S>>(model: &Model<S>, sin_cos2: SinCos<S>) -> Self {
        let Constants { coupling, link2, .. } = model.constants;
        let params = &model.params;
        let (l1, lc1) = (params.length1, params.center_of_mass1);
        let link1 = params.mass1 * (lc1 * lc1) + params.inertia1;
        let m2_l1_squared = params.mass2 * (l1 * l1);
        let upper = link1 + m2_l1_squared;
        let (coupling_sin, coupling_cos) = (coupling * sin_cos2.0, coupling * sin_cos2.1);
        // U L − c² as a sum in which nothing cancels without a rotor.
        let mut determinant =
            link1 * link2 + m2_l1_squared * params.inertia2 + coupling_sin * coupling_sin;
        let mut between = coupling_cos;
        if A::HAS_FRICTION {
            between = coupling_cos - params.rotor;
            determinant = determinant + params.rotor * (coupling_cos + between);
        }
        Self { upper, between, link2, inverse: S::from_f64(1.0) / determinant }
    }

    /// \[θ̈1, θ̈2\] by forces on α and β, N m.
    #[inline(always)]
    pub(super) fn solve(&self, [force1, force2]: [S; 2]) -> [S; 2] {
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
pub(super) fn partials<A: Arithmetic>(
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
