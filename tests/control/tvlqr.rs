//! Gains along a trajectory equal those that follow from its sum of costs, and converge to those of
//! the steady regulator.

use std::array::from_fn;

use acrobot::control::model::StepModel;
use acrobot::control::regulator::{Lqr, dlqr, tvlqr};
use acrobot::numpy::{Pcg64, uniform};

use crate::regulators::{IDENTITY, diagonal, upright};
use crate::{cast, relative};

fn apply(m: &[[f64; 4]; 4], x: [f64; 4]) -> [f64; 4] {
    m.map(|row| dot(&row, &x))
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// The first torques after x = e₁ to e₄, times −1, and the least costs: the sum of all costs is a
/// quadratic function of all torques, whose minimum is a system of linear equations.
fn least_squares(
    models: &[StepModel],
    q: &[[f64; 4]; 4],
    r: f64,
    end: &[[f64; 4]; 4],
) -> ([f64; 4], [f64; 4]) {
    // The states after each step of four motions without torques, and of those after each torque.
    let steps = models.len();
    let motion = |mut x: [f64; 4], torque: Option<usize>| -> Vec<[f64; 4]> {
        let step = |(i, StepModel { a, b }): (usize, &StepModel)| {
            x = apply(a, x);
            if torque == Some(i) {
                x = from_fn(|j| x[j] + b[j]);
            }
            x
        };
        models.iter().enumerate().map(step).collect()
    };
    let cost = |x: &[[f64; 4]], y: &[[f64; 4]]| -> f64 {
        let weights = |i: usize| if i + 1 < steps { q } else { end };
        (0..steps).map(|i| dot(&x[i], &apply(weights(i), y[i]))).sum()
    };
    let responses: Vec<_> = (0..steps).map(|i| motion([0.0; 4], Some(i))).collect();
    let results = IDENTITY.map(|start| {
        let free = motion(start, None);
        // Gaussian elimination of H u = −g.
        let mut rows: Vec<Vec<f64>> = (0..steps)
            .map(|i| {
                let weight = |j: usize| cost(&responses[i], &responses[j]);
                let mut row: Vec<f64> = (0..steps).map(weight).collect();
                row[i] += r;
                row.push(-cost(&responses[i], &free));
                row
            })
            .collect();
        let gradient: Vec<f64> = rows.iter().map(|row| -row[steps]).collect();
        for i in 0..steps {
            for j in 0..steps {
                if i != j {
                    let factor = rows[j][i] / rows[i][i];
                    rows[j] = rows[j].iter().zip(&rows[i]).map(|(x, y)| x - factor * y).collect();
                }
            }
        }
        let torques: Vec<f64> = (0..steps).map(|i| rows[i][steps] / rows[i][i]).collect();
        let least = dot(&start, &apply(q, start)) + cost(&free, &free) + dot(&gradient, &torques);
        (-torques[0], least)
    });
    (results.map(|(gain, _)| gain), results.map(|(_, cost)| cost))
}

#[test]
fn gains_are_those_of_the_least_sum() {
    let mut rng = Pcg64::new(3);
    for _ in 0..50 {
        let mut number = |low| uniform(&mut rng, low, 1.0);
        let mut weights = || diagonal(from_fn(|_| number(0.0)));
        let (q, end) = (weights(), weights());
        let r = number(0.1);
        let models: [StepModel; 8] = from_fn(|_| StepModel {
            a: from_fn(|_| from_fn(|_| number(-1.0))),
            b: from_fn(|_| number(-1.0)),
        });
        let mut gains = [[0.0; 4]; 8];
        let cost_to_go = tvlqr(&models, &q, r, &end, &mut gains).unwrap();
        for (i, gain) in gains.iter().enumerate() {
            let (expected, costs) = least_squares(&models[i..], &q, r, &end);
            assert!(relative(gain, &expected) < 1e-10, "{gain:?} {expected:?}");
            if i == 0 {
                let found: [f64; 4] = from_fn(|i| cost_to_go[i][i]);
                assert!(relative(&found, &costs) < 1e-10, "{found:?} {costs:?}");
            }
        }
    }
}

#[test]
fn a_long_time_has_the_gain_of_the_steady_regulator() {
    let Lqr { gain, cost_to_go } = dlqr(&upright(), &IDENTITY, 1.0).unwrap();
    let mut gains = [[0.0; 4]; 200];
    let cost = tvlqr(&[upright(); 200], &IDENTITY, 1.0, &diagonal([0.0; 4]), &mut gains).unwrap();
    assert!(relative(&gains[0], &gain) < 1e-10 && relative(&gains[199], &gain) > 0.1);
    assert!(relative(cost.as_flattened(), cost_to_go.as_flattened()) < 1e-10);

    // The steady cost stays.
    tvlqr(&[upright(); 200], &IDENTITY, 1.0, &cost_to_go, &mut gains).unwrap();
    assert!(gains.iter().all(|found| relative(found, &gain) < 1e-10));

    let cost = tvlqr(&[], &IDENTITY, 1.0, &cost_to_go, &mut []).unwrap();
    assert_eq!(cost, cost_to_go);
}

#[test]
fn wrong_arguments_are_rejected() {
    let message = |models: &[StepModel], r| {
        let mut gains = [[7.0; 4]; 2];
        let error = tvlqr(models, &IDENTITY, r, &IDENTITY, &mut gains).unwrap_err();
        assert_eq!(gains, [[7.0; 4]; 2], "changed");
        error.to_string()
    };
    let model = upright();
    for (r, got) in [(0.0, "0"), (-1.0, "-1"), (f64::NAN, "NaN"), (f64::INFINITY, "inf")] {
        let expected = format!("r must be finite and above 0 per (N m)², got {got}");
        assert_eq!(message(&[model; 2], r), expected);
    }
    assert_eq!(message(&[model; 3], 1.0), "gains must have 3 elements, got 2");
    assert_eq!(message(&[model; 1], 1.0), "gains must have 1 elements, got 2");

    let growing =
        StepModel { a: diagonal([1e15_f32; 4].map(f64::from)).map(cast), b: [0.0_f32; 4] };
    let identity = IDENTITY.map(cast);
    let error = tvlqr(&[growing; 2], &identity, 1.0, &identity, &mut [[0.0; 4]; 2]).unwrap_err();
    assert_eq!(error.to_string(), "cost_to_go must be finite in each element, got inf");
}
