//! Recordings of angles and torques tell the parameters of a machine.

use std::f64::consts::TAU;
use std::{env, fs};

use acrobot::arithmetic::Arithmetic as _;
use acrobot::control::identify::{Fit, Regression, Sample, identify, prediction_error};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::{Params, Portable};

use crate::estimator::{Machine, base, real, scaled};

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
    params.coulomb1 = part(params.coulomb1);
    params.coulomb2 = part(params.coulomb2);
    params
}

/// A sample in each `dt` for 10 s, under random torques of up to 3 N m.
fn record(params: Params, rng: &mut Pcg64, seed: u64) -> Vec<Sample> {
    let mut machine = Machine::new(params, seed);
    let (mut samples, mut torque, mut left) = (Vec::new(), 0.0, 0.0);
    let mut unwrapped = [0.0_f64; 2];
    for _ in 0..(10.0 / params.dt).round() as u32 {
        if left <= 0.0 {
            (torque, left) = (uniform(rng, -3.0, 3.0), uniform(rng, 0.05, 0.4));
        }
        left -= params.dt;
        for (last, angle) in unwrapped.iter_mut().zip(machine.angles()) {
            *last = angle + ((*last - angle) / TAU).round() * TAU;
        }
        samples.push(Sample { angles: unwrapped, torques: [0.0, torque] });
        machine.step(torque);
    }
    samples
}

/// The elements of the mass matrix where θ2 is ±π/2.
fn inertias(params: &Params) -> [f64; 3] {
    let [upper, link2, ..] = base(params);
    [upper + link2 - 2.0 * params.rotor, link2 - params.rotor, link2]
}

/// Of twenty machines, or of as many as the variable `MACHINES` says.
#[test]
fn ten_seconds_tell_the_inertias() {
    let machines = env::var("MACHINES").map_or(20, |count| count.parse().unwrap());
    let mut rng = Pcg64::new(5);
    let (mut worst, mut friction) = (Vec::new(), Vec::new());
    for seed in 0..machines {
        let truth = machine(&mut rng);
        let (params, found) = identify(&[&record(truth, &mut rng, seed)], truth).unwrap();
        assert_eq!(found.rank_deficiency, 0);
        let largest = |found: &[f64], truth: &[f64]| -> f64 {
            let errors = found.iter().zip(truth).map(|(x, y)| (x / y - 1.0).abs());
            errors.fold(0.0, f64::max)
        };
        worst.push(largest(&found.values[..3], &inertias(&truth)));
        assert!(largest(&inertias(&params), &found.values[..3]) < 1e-9);
        friction.push(largest(&found.values[8..], &[truth.coulomb1, truth.coulomb2]));
    }
    worst.sort_by(f64::total_cmp);
    friction.sort_by(f64::total_cmp);
    println!("inertias {worst:.4?}, friction {friction:.3?}");
    let part = |errors: &[f64], percent| errors[errors.len() * percent / 100];
    let [middle, most] = if machines == 20 { [0.002, 0.009] } else { [0.0025, 0.025] };
    assert!(part(&worst, 50) < middle && part(&worst, 95) < most, "{worst:?}");
    assert!(part(&friction, 50) < 0.05, "{friction:?}");
}

/// The largest error of an inertia, relative to it.
fn error(found: &Fit, truth: &Params) -> f64 {
    let errors = found.values.iter().zip(inertias(truth)).map(|(x, y)| (x / y - 1.0).abs());
    errors.fold(0.0, f64::max)
}

/// At 10 kHz velocities follow from more angles: three machines, of 3 s each.
#[test]
fn a_high_rate_tells_no_less() {
    let mut rng = Pcg64::new(6);
    let errors = [0, 1, 2].map(|seed| {
        let truth = Params { dt: 1e-4, ..machine(&mut rng) };
        let (_, found) = identify(&[&record(truth, &mut rng, seed)[..30_000]], truth).unwrap();
        error(&found, &truth)
    });
    assert!(errors.iter().all(|error| *error < 0.005), "{errors:?}");
}

/// The law of scale: the same motion of a machine with other lengths and masses tells the same.
#[test]
fn a_machine_of_another_size_is_identified_alike() {
    let truth = Params { coulomb1: 0.0, coulomb2: 0.0, ..machine(&mut Pcg64::new(8)) };
    let samples = record(truth, &mut Pcg64::new(9), 9);
    let found = |a: f64, b: f64| {
        let machine = scaled(&truth, a, b, a.sqrt());
        let torques = |sample: &Sample| sample.torques.map(|torque| torque * a * b);
        let samples: Vec<_> =
            samples.iter().map(|x| Sample { torques: torques(x), ..*x }).collect();
        error(&identify(&[&samples], machine).unwrap().1, &machine)
    };
    let first = found(1.0, 1.0);
    assert!(first < 0.01, "{first}");
    for (a, b) in [(1.0 / 256.0, 1.0 / 64.0), (0.0625, 8.0), (16.0, 0.5), (64.0, 64.0)] {
        assert_eq!(found(a, b), first, "{a} {b}");
    }
}

/// `tests/data/by_hand/recordings.py` has their source. Those of the even places tell the machine,
/// which predicts the others, and better than the parameters that were published with them.
#[test]
fn recordings_of_the_real_machine_predict_others() {
    let read = |name: &str| -> Vec<Sample> {
        let bytes = fs::read(format!("tests/data/real/{name}.bin")).unwrap();
        let sample = |raw: &[u8; 8]| {
            let [angle1, angle2, torque1, torque2] =
                [0, 2, 4, 6].map(|i| f64::from(u16::from_le_bytes([raw[i], raw[i + 1]])));
            Sample {
                angles: [angle1, angle2].map(|x| x / 65535.0 * 25.0 - 12.5),
                torques: [torque1, torque2].map(|x| (x / 4095.0 * 2.0 - 1.0) * 12.0),
            }
        };
        bytes.as_chunks().0.iter().map(sample).collect()
    };
    let recordings = ["143339", "143601", "143747", "144003", "154220"].map(read);
    let given = Params { dt: 0.002001, ..real() };
    let (found, _) = identify(&recordings.each_ref().map(|x| &x[..]), given).unwrap();
    let others = ["143524", "143704", "143906", "144115", "154548"].map(read);
    let error = |params, steps| {
        let squares = others.iter().map(|x| prediction_error(params, x, steps).unwrap().powi(2));
        (squares.sum::<f64>() / 5.0).sqrt()
    };
    let errors = [50, 250].map(|steps| [error(found, steps), error(given, steps)]);
    println!("{errors:.4?} rad over 0.1 and 0.5 s; {found:?}");
    let [[short, theirs], [long, _]] = errors;
    assert!(short < 0.0125 && short < 0.6 * theirs && long < 0.26, "{errors:?}");
}

/// With the elbow locked nothing tells how the links couple.
#[test]
fn what_a_recording_does_not_tell_is_counted() {
    let swing = |i: usize| Sample {
        angles: [Portable::sin_cos(i as f64 / 50.0).0, 0.0],
        ..Sample::default()
    };
    let samples: Vec<Sample> = (0..1000).map(swing).collect();
    let mut regression = Regression::EMPTY;
    regression.add(&samples, 0.002, 9.81, 2, 250).unwrap();
    let found = regression.fit();
    assert!(found.rank_deficiency >= 4, "{found:?}");
    let unknown = |i: usize| found.std_errors[i].is_infinite();
    assert!([2, 5, 7, 9].into_iter().all(unknown) && ![3, 6, 8].into_iter().any(unknown));
    let rule =
        "must be determined by recordings in which both links move long enough, in kg m², got 0";
    let error = found.params(Params::DEFAULT).unwrap_err().to_string();
    assert!(error.starts_with("mass11 must be determined by"), "{error}");

    // Nor does one of a machine at rest, hanging or leaning, or one that is too short.
    let still = [Sample::default(); 5000];
    let leaning = [Sample { angles: [0.5, -0.2], torques: [0.0, 0.1] }; 5000];
    for recording in [&still[..], &leaning, &still[..9], &[]] {
        let error = identify(&[recording], real()).unwrap_err().to_string();
        assert_eq!(error, format!("mass11 {rule}"));
    }
}

#[test]
fn bad_recordings_are_rejected() {
    let add = |sample, dt, half| {
        let result = Regression::EMPTY.clone().add(&[sample; 9], dt, 9.81, half, 2);
        result.unwrap_err().to_string()
    };
    let still = Sample::default();
    assert_eq!(add(still, 0.0, 1), "dt must be finite and above 0 s, got 0");
    assert_eq!(add(still, 0.002, 0), "half must be finite and above 0 samples, got 0");
    let bad = Sample { angles: [0.0, f64::NAN], ..still };
    assert_eq!(add(bad, 0.002, 1), "angles must be finite in each element, got NaN");
}
