//! `control`, for any numbers: finite results or an error, and no hang.

use std::array::from_fn;

use acrobot::State;
use acrobot::arithmetic::Real;
use acrobot::control::{
    self, ControlError, LinearModel, inverse_dynamics, linearize, linearize_step, lqr, velocities,
};
use acrobot::physics::Pendulum;
use common::in_every_arithmetic;
use proptest::prelude::*;

use crate::given::{Number, Range, Tested, holds, number, params, state};

/// Whether the result is finite, or an error that says what is not.
fn is_finite<S: Real>(result: Result<Vec<S>, ControlError>) -> bool {
    match result {
        Ok(elements) => elements.iter().all(|x| x.is_finite()),
        Err(error) => matches!(error, ControlError::NotFinite { .. }),
    }
}

#[test]
fn results_are_finite_or_errors() {
    fn check<A: Tested>() {
        let rates = [number::<A::Scalar>(Range::Any), number(Range::Any)];
        let given = (params::<A>(Range::Any), state(Range::Any), number(Range::Any), rates);
        holds(2000, given, |(params, state, torque, accelerations)| {
            let pendulum = Pendulum::<A>::new(params, state).unwrap();
            let continuous = linearize(&pendulum, torque);
            let discrete = linearize_step(&pendulum, torque);
            let forces = inverse_dynamics(&pendulum, accelerations);
            assert!(is_finite(continuous.map(|model| [model.a.as_flattened(), &model.b].concat())));
            assert!(is_finite(discrete.map(|model| [model.a.as_flattened(), &model.b].concat())));
            assert!(is_finite(
                forces.map(|forces| { [forces.torques, forces.reaction, forces.elbow].concat() })
            ));
            assert!(is_finite(velocities(&pendulum).map(|points| points.concat())));
        });
    }
    in_every_arithmetic!(check);
}

/// Symmetric weights, of which half are positive semidefinite: those of sums of squares.
fn weights<S: Number>(range: Range) -> BoxedStrategy<[[S; 4]; 4]> {
    let rows = [(); 4].map(|()| [(); 4].map(|()| number::<f64>(range)));
    (rows, any::<bool>())
        .prop_map(|(rows, is_square)| {
            let element = |i: usize, j: usize| {
                let product = (0..4).map(|k| rows[k][i] * rows[k][j]).sum::<f64>();
                if is_square { product } else { rows[i.min(j)][i.max(j)] }
            };
            from_fn(|i| from_fn(|j| S::from_f64(element(i, j))))
        })
        .boxed()
}

#[test]
fn regulators_stabilize_or_are_errors() {
    fn check<S: Number>(range: Range) {
        let vector = move || [(); 4].map(|()| number::<S>(range));
        let given = (
            [vector(), vector(), vector(), vector()],
            vector(),
            weights::<S>(range),
            number::<S>(range),
        );
        holds(2000, given, |(a, b, q, r)| {
            let model = LinearModel { a, b };
            let Ok(regulator) = lqr(&model, &q, r) else {
                return;
            };
            let [gain, cost] = [&regulator.gain[..], regulator.cost_to_go.as_flattened()];
            assert!(gain.iter().chain(cost).all(|x| x.is_finite()));
            for i in 0..4 {
                for j in 0..4 {
                    assert_eq!(regulator.cost_to_go[i][j], regulator.cost_to_go[j][i]);
                }
            }
        });
    }
    for range in [Range::Moderate, Range::Any] {
        check::<f32>(range);
        check::<f64>(range);
    }
}

/// Upright, with a motor that is weighted more or less.
#[test]
fn moderate_pendulums_can_be_held_upright() {
    fn check<A: Tested>() {
        let weight = (-4.0..4.0_f64).prop_map(f64::exp);
        holds(500, (params::<A>(Range::Moderate), weight), |(params, r)| {
            let pendulum = Pendulum::<A>::new(params, State::UPRIGHT).unwrap();
            let zero = A::Scalar::ZERO;
            let Ok(model) = linearize_step(&pendulum, zero) else {
                return;
            };
            let one = A::Scalar::from_f64(1.0);
            let q = from_fn(|i| from_fn(|j| if i == j { one } else { zero }));
            let r = A::Scalar::from_f64(r);
            let Ok(regulator) = lqr(&model, &q, r) else {
                return;
            };
            // Rounding leaves upright an equilibrium.
            assert_eq!(control::regulator(&pendulum, zero, &q, r), Ok(regulator));
            // In f64, where rounding hides less, the powers of the closed loop vanish too.
            let [gain, b] = [regulator.gain, model.b].map(|row| row.map(Real::to_f64));
            let mut closed: [[f64; 4]; 4] =
                from_fn(|i| from_fn(|j| model.a[i][j].to_f64() - b[i] * gain[j]));
            for _ in 0..40 {
                let row = |i: usize| from_fn(|j| (0..4).map(|k| closed[i][k] * closed[k][j]).sum());
                closed = from_fn(row);
            }
            let largest = closed.as_flattened().iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            assert!(largest < 0.1, "{regulator:?} {largest}");
        });
    }
    in_every_arithmetic!(check);
}
