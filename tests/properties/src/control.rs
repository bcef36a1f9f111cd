//! `control`, for any numbers: finite results or an error, and no hang.

use std::array::from_fn;

use acrobot::arithmetic::{Damped, Real};
use acrobot::control::estimate::{Estimator, Noise, ParameterEstimator, ParameterStd};
use acrobot::control::identify::{Calibration, Regression, Sample, calibrate};
use acrobot::control::model::{LinearModel, StepModel};
use acrobot::control::regulator::{dlqe, dlqr, lqr};
use acrobot::physics::Pendulum;
use acrobot::{Error, Params, Portable, State};
use common::in_every_arithmetic;
use proptest::prelude::*;

use crate::given::{Number, Range, Tested, holds, number, params, state};

/// Whether the result is finite, or an error that says what is not.
fn is_finite<S: Real>(result: Result<Vec<S>, Error>) -> bool {
    match result {
        Ok(elements) => elements.iter().all(|x| x.is_finite()),
        Err(error) => matches!(error, Error::NotFinite { .. }),
    }
}

#[test]
fn results_are_finite_or_errors() {
    fn check<A: Tested>() {
        let rates = [number::<A::Scalar>(Range::Any), number(Range::Any)];
        let given = (params::<A>(Range::Any), state(Range::Any), number(Range::Any), rates);
        holds(1000, given, |(params, state, torque, accelerations)| {
            let pendulum = Pendulum::<A>::new(params, state).unwrap();
            let continuous = pendulum.linearize(torque);
            let discrete = pendulum.linearize_step(torque);
            let forces = pendulum.inverse_dynamics(accelerations);
            assert!(is_finite(continuous.map(|model| [model.a.as_flattened(), &model.b].concat())));
            assert!(is_finite(discrete.map(|model| [model.a.as_flattened(), &model.b].concat())));
            assert!(is_finite(
                forces.map(|forces| { [forces.torques, forces.reaction, forces.elbow].concat() })
            ));
        });
    }
    in_every_arithmetic!(check);
}

/// Whatever encoders and a motor say, the estimate is a state of a machine.
#[test]
fn estimates_are_those_of_machines() {
    fn check<A: Tested>() {
        let any = || number::<A::Scalar>(Range::Any);
        let ticks = prop::collection::vec(([any(), any()], any()), 20);
        let noises = [-50.0..0.6_f64, -50.0..5.0_f64];
        holds(300, (params::<A>(Range::Any), noises, ticks), |(params, noises, ticks)| {
            let [angle, torque] = noises.map(|x| A::Scalar::from_f64(x.exp()));
            let noise = Noise { angle_std: angle, torque_std: torque };
            let mut of_state = match Estimator::<A>::new(params, noise) {
                Ok(estimator) => estimator,
                // Some motors turn link 2 by more than 1 rad in a step.
                Err(error) => return assert_eq!(error.name(), "torque_std"),
            };
            let std = ParameterStd {
                mass1: params.mass1,
                mass2: params.mass2,
                length1: params.length1,
                inertia1: params.inertia1,
                inertia2: params.inertia2,
                damping1: params.damping1,
                damping2: params.damping2,
                coulomb1: params.coulomb1,
                coulomb2: params.coulomb2,
                rotor: A::Scalar::from_f64(params.rotor.to_f64().abs()),
                zero1: A::Scalar::from_f64(0.1),
                zero2: A::Scalar::ZERO,
                torque_factor: A::Scalar::from_f64(0.2),
            };
            let mut of_params = ParameterEstimator::<A>::new(params, std, noise).unwrap();
            for (angles, torque) in ticks {
                of_state.correct(angles).unwrap();
                of_params.correct(angles).unwrap();
                let _ = (of_state.predict(torque), of_params.predict(torque));
                let deviations = [of_state.state_std(), of_params.state_std()];
                assert!(deviations.into_iter().flatten().flatten().all(|x| x.is_finite()));
                of_state.state().validate().unwrap();
                of_params.state().validate().unwrap();
                of_params.params().validate().unwrap();
                // None is farther from the given one than four deviations, which equal it here.
                let found = of_params.params().numbers().into_iter().zip(params.numbers());
                for ((name, found), (_, given)) in found {
                    let [found, given] = [found, given].map(A::Scalar::to_f64);
                    assert!(
                        (found - given).abs() <= 4.001 * given.abs(),
                        "{name}: {found} {given}"
                    );
                }
            }
        });
    }
    in_every_arithmetic!(check);
}

#[test]
fn no_recording_gives_nan() {
    let any = || number::<f64>(Range::Any);
    let sample = [any(), any(), any(), any()];
    let given = (prop::collection::vec(sample, 0..60), any(), any(), 0..4_usize, 0..20_usize);
    holds(2000, given, |(samples, dt, gravity, half, window)| {
        let sample = |[a, b, c, d]: [f64; 4]| Sample { angles: [a, b], torques: [c, d] };
        let samples: Vec<Sample> = samples.into_iter().map(sample).collect();
        let mut regression = Regression::EMPTY;
        let result = regression.add(&samples, dt, gravity, half, window);
        if !matches!(result, Err(Error::NotFinite { .. })) {
            assert_eq!(result.is_ok(), dt > 0.0 && half > 0 && window > 0);
        }
        let found = regression.fit();
        assert!(found.weakest.iter().all(|x| x.is_finite()));
        assert!(found.values.iter().all(|x| !x.is_nan()));
        assert!(found.std_errors.iter().all(|x| *x >= 0.0));
        assert_finite(calibrate(&samples, Params { dt, gravity, ..Params::SWINGUP }));
    });
}

fn assert_finite(result: Result<Calibration, Error>) {
    if let Ok(Calibration { params, fit, zeros, delay, prediction_error, angle_noise }) = result {
        params.validate().unwrap();
        let numbers = [&zeros[..], &[delay, prediction_error, angle_noise], &fit.values].concat();
        assert!(numbers.iter().all(|x| x.is_finite()));
    }
}

#[test]
fn calibrations_of_machines_are_finite_or_errors() {
    type A = Damped<Portable>;
    let torques = prop::collection::vec(-3.0..3.0, 0..80);
    let given = (0.2..2.0, 0.2..2.0, 0.005..0.02, torques);
    holds(50, given, |(mass1, mass2, dt, torques)| {
        let given = Params { mass1, mass2, dt, ..Params::SWINGUP };
        let mut pendulum = Pendulum::<A>::new(given, State::HANGING).unwrap();
        let sample = |i: usize| {
            let State { theta1, theta2, .. } = pendulum.state();
            let _ = pendulum.step(torques[i / 10]);
            Sample { angles: [theta1, theta2], torques: [0.0, torques[i / 10]] }
        };
        let samples: Vec<Sample> = (0..10 * torques.len()).map(sample).collect();
        assert_finite(calibrate(&samples, given));
    });
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
            let check = |gain: &[S], cost: [[S; 4]; 4]| {
                assert!(gain.iter().chain(cost.as_flattened()).all(|x| x.is_finite()));
                assert_eq!(cost, from_fn(|i| cost.map(|row| row[i])), "not symmetric");
            };
            let model = StepModel { a, b };
            let regulators = [dlqr(&model, &q, r), lqr(&LinearModel { a, b }, &q, r)];
            for regulator in regulators.into_iter().flatten() {
                check(&regulator.gain, regulator.cost_to_go);
            }
            if let Ok(filter) = dlqe(&model, &q, [r, b[0]]) {
                check(filter.gain.as_flattened(), filter.prior_covariance);
            }
        });
    }
    for range in [Range::Moderate, Range::Any] {
        check::<f32>(range);
        check::<f64>(range);
    }
}
