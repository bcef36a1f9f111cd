//! Recordings of angles and torques tell the parameters of a machine.

use std::f64::consts::TAU;

use acrobot::arithmetic::Arithmetic as _;
use acrobot::control::{Evidence, Sample};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::Joints;
use acrobot::{Params, Portable};

use crate::estimator::{Machine, real};

/// RealAIGym's machine with other masses, inertias and friction.
fn machine(rng: &mut Pcg64) -> Params {
    let mut part = |x: f64| x * uniform(rng, 0.8, 1.25);
    let real = real();
    let mut params = Params {
        mass1: part(real.mass1),
        mass2: part(real.mass2),
        inertia1: part(real.inertia1),
        inertia2: part(real.inertia2),
        ..real
    };
    params.coulomb.joint1 = part(params.coulomb.joint1);
    params.coulomb.joint2 = part(params.coulomb.joint2);
    params
}

/// A sample each 2 ms for 10 s, under random torques of up to 3 N m.
fn record(params: Params, rng: &mut Pcg64, seed: u64) -> Vec<Sample> {
    let mut machine = Machine::new(params, seed);
    let (mut samples, mut torque, mut left) = (Vec::new(), 0.0, 0.0);
    let mut unwrapped = [0.0_f64; 2];
    for _ in 0..5000 {
        if left <= 0.0 {
            (torque, left) = (uniform(rng, -3.0, 3.0), uniform(rng, 0.05, 0.4));
        }
        left -= 0.002;
        for (last, angle) in unwrapped.iter_mut().zip(machine.angles()) {
            *last = angle + ((*last - angle) / TAU).round() * TAU;
        }
        samples.push(Sample { angles: unwrapped, torques: [0.0, torque] });
        machine.step(torque);
    }
    samples
}

/// The inertias: those of the whole arm, of link 2, and what couples them.
fn inertias(params: &Params) -> [f64; 3] {
    let Params { mass1, mass2, length1, center_of_mass1: lc1, center_of_mass2: lc2, .. } = *params;
    let upper = params.inertia1 + mass1 * lc1 * lc1 + mass2 * length1 * length1;
    let link2 = params.inertia2 + mass2 * lc2 * lc2;
    [upper + link2 - 2.0 * params.rotor, link2 - params.rotor, link2]
}

#[test]
fn ten_seconds_tell_the_inertias() {
    let mut rng = Pcg64::new(5);
    let mut worst = Vec::new();
    for seed in 0..20 {
        let truth = machine(&mut rng);
        let mut evidence = Evidence::NONE;
        evidence.add(&record(truth, &mut rng, seed), 0.002, 9.81, 2, 250).unwrap();
        let found = evidence.solve();
        assert_eq!(found.undetermined, 0);
        let params = found.params(truth).unwrap();
        let largest = |found: &[f64], truth: &[f64]| -> f64 {
            let errors = found.iter().zip(truth).map(|(x, y)| (x / y - 1.0).abs());
            errors.fold(0.0, f64::max)
        };
        worst.push(largest(&found.values[..3], &inertias(&truth)));
        assert!(largest(&inertias(&params), &found.values[..3]) < 1e-9);
        let Joints { joint1, joint2 } = truth.coulomb;
        assert!(largest(&found.values[8..], &[joint1, joint2]) < 0.2);
    }
    worst.sort_by(f64::total_cmp);
    assert!(worst[10] < 0.002 && worst[19] < 0.009, "{worst:?}");
}

/// With the elbow locked nothing tells how the links couple.
#[test]
fn what_a_recording_does_not_tell_is_counted() {
    let swing = |i: usize| Sample {
        angles: [Portable::sin_cos(i as f64 / 50.0).0, 0.0],
        ..Sample::default()
    };
    let samples: Vec<Sample> = (0..1000).map(swing).collect();
    let mut evidence = Evidence::NONE;
    evidence.add(&samples, 0.002, 9.81, 2, 250).unwrap();
    let found = evidence.solve();
    assert!(found.undetermined >= 4, "{found:?}");
    let unknown = |i: usize| found.errors[i].is_infinite();
    assert!([2, 5, 7, 9].into_iter().all(unknown) && ![3, 6, 8].into_iter().any(unknown));
    assert!(found.params(Params::DEFAULT).is_err());
}

#[test]
fn bad_recordings_are_rejected() {
    let add = |sample, dt, half| {
        let result = Evidence::NONE.clone().add(&[sample; 9], dt, 9.81, half, 2);
        result.unwrap_err().to_string()
    };
    let still = Sample::default();
    assert_eq!(add(still, 0.0, 1), "dt must be finite and above 0 s, got 0");
    assert_eq!(add(still, 0.002, 0), "half must be finite and above 0 samples, got 0");
    let bad = Sample { angles: [0.0, f64::NAN], ..still };
    assert_eq!(add(bad, 0.002, 1), "angles must be finite in each element, got NaN");
}
