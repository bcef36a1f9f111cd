//! The covariances after a step: how the state and the parameters at its begin act on its end.

use super::estimator::KalmanFilter;
use super::parameter_std::{ZEROS, in_order};
use crate::arithmetic::Arithmetic;
use crate::control::model::LinearModel;
use crate::control::model::partials::{MassMatrix, by_parameters};
use crate::error::Error;
use crate::math::Real;
use crate::math::matrix::{Matrix, add_outer, apply, check_finite, dot, symmetrize, transpose};
use crate::math::sealed::Sealed as _;
use crate::physics::{Pendulum, State, plus_scaled};

/// What rounding to `f32` can add to an angle in a step: a standard deviation, rad.
const IN_A_STEP: f64 = 1e-6;

impl<A: Arithmetic, const K: usize> KalmanFilter<A, K> {
    /// The covariances after a step to the state `next`.
    #[expect(clippy::indexing_slicing, reason = "i is below 4")]
    pub(super) fn predicted(
        &mut self,
        mut of_state: Matrix<A::Scalar>,
        next: State<A::Scalar>,
        [sent, torque]: [A::Scalar; 2],
    ) -> Result<Matrix<A::Scalar>, Error> {
        let [zero, one, half] = [A::Scalar::ZERO, A::Scalar::ONE, A::Scalar::HALF];
        let mut middle = self.model.clone();
        let [theta1, theta2, before1, before2]: [A::Scalar; 4] = middle.state().into();
        let [_, _, after1, after2]: [A::Scalar; 4] = next.into();
        let [v1, v2] = [(before1 + after1) * half, (before2 + after2) * half];
        let (dt, half_dt) = (middle.params().dt, middle.model().constants.half_dt);
        middle.set_state([theta1 + half_dt * v1, theta2 + half_dt * v2, v1, v2].into())?;
        // What a rate in the middle of the step changes until its end, to the second order in dt.
        let LinearModel { a, b } = middle.linearize(torque)?;
        let mut lasting = a.map(|row| row.map(|x| dt * (half_dt * x)));
        add_diagonal(&mut lasting, [dt; 4]);
        let mut after = by_transposed(&lasting, &transpose(&a));
        add_diagonal(&mut after, [one; 4]);
        let accelerations = [(after1 - before1) / dt, (after2 - before2) / dt];
        let slopes = self.slopes(&middle, accelerations, sent);
        let slopes = slopes.map(|[x1, x2]| apply(&lasting, &[zero, zero, x1, x2]));

        of_state = by_transposed(&by_transposed(&after, &of_state), &after);
        for (i, (parameter, slope)) in self.parameters.iter_mut().zip(&slopes).enumerate() {
            let moved = apply(&after, &parameter.with_state);
            let mut change = [zero; 4];
            // No motion depends on a zero.
            for (slope, x) in slopes.iter().zip(parameter.with_params).skip(ZEROS.len()) {
                change = plus_scaled(change, x, *slope);
            }
            parameter.with_state = plus_scaled(moved, one, change);
            // Its transpose follows when the matrix becomes symmetric.
            add_outer(&mut of_state, one + one, slope, &plus_scaled(moved, half, change));
            if let Some(own) = parameter.with_params.get_mut(i) {
                *own = *own + self.given.in_parameter;
            }
        }
        let b = apply(&lasting, &b).map(|x| x * self.given.torque);
        add_outer(&mut of_state, self.torque, &b, &b);
        symmetrize(&mut of_state);
        check_finite("covariances", of_state.as_flattened())?;
        let (angle, velocity) =
            (A::Scalar::from_f64(IN_A_STEP * IN_A_STEP), self.given.in_velocity);
        // At opt-level z a `for` loop would keep a check of the index, here and in `corrected`.
        [angle, angle, velocity, velocity].into_iter().enumerate().for_each(|(i, noise)| {
            // Rounding may have made it negative.
            let own = if of_state[i][i] > zero { of_state[i][i] } else { zero };
            of_state[i][i] = own + noise;
        });
        Ok(of_state)
    }

    /// The derivatives of the accelerations of a motion by each parameter, times its
    /// deviation: M⁻¹ (∂f/∂p − ∂M/∂p q̈), as in `partials`.
    fn slopes(
        &self,
        motion: &Pendulum<A>,
        accelerations: [A::Scalar; 2],
        sent: A::Scalar,
    ) -> [[A::Scalar; 2]; K] {
        let o = A::Scalar::ZERO;
        let mut slopes = [[o; 2]; K];
        if K == 0 {
            return slopes;
        }
        let (model, sines) = (motion.model(), motion.sin_cos());
        let State { dtheta1, dtheta2, .. } = motion.state();
        let rates = [dtheta1, dtheta2];
        let by = by_parameters::<A, A::Scalar>(model, rates, sines, accelerations);
        let [length1, mass1, mass2, _, _, inertia1, inertia2, _, friction @ .., rotor] = by;
        let masses = [mass1, mass2, inertia1, inertia2];
        let forces = in_order(masses, friction, [[o, o], [o, o], [-sent, sent]], [length1, rotor]);
        let mass = MassMatrix::new::<A>(model, sines[1]);
        for ((slope, forces), parameter) in slopes.iter_mut().zip(forces).zip(&self.parameters) {
            *slope = mass.solve(forces).map(|x| x * parameter.deviation);
        }
        slopes
    }
}

#[expect(clippy::indexing_slicing, reason = "i is below 4")]
fn add_diagonal<S: Real>(m: &mut Matrix<S>, diagonal: [S; 4]) {
    diagonal.into_iter().enumerate().for_each(|(i, x)| m[i][i] = m[i][i] + x);
}

/// x yᵀ.
#[inline(never)] // saves flash
fn by_transposed<S: Real>(x: &Matrix<S>, y: &Matrix<S>) -> Matrix<S> {
    x.map(|row| y.map(|column| dot(row, column)))
}
