//! A recording tells the zeros of the encoders, the delay and the parameters, or what is wrong.

use std::env;
use std::f64::consts::{PI, TAU};

use acrobot::control::identify::{Calibration, Sample, calibrate};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::{Error, Params};
use machine::{Hardware, Machine, Random};

fn record(hardware: &Hardware, seconds: f64, seed: u64) -> Vec<Sample> {
    let ticks = (seconds / hardware.params.dt) as usize;
    Machine::new(*hardware, seed).unwrap().shake(seed).take(ticks).collect()
}

/// The lengths, the centres of mass and `dt`. No mass, inertia or friction is known.
fn drawn(hardware: &Hardware) -> Params {
    let Params { length1, center_of_mass1, center_of_mass2, dt, .. } = hardware.params;
    Params { length1, center_of_mass1, center_of_mass2, dt, gravity: 9.81, ..Params::SWINGUP }
}

/// Of eight machines with zeros of up to 0.1 rad, or of as many as the variable `MACHINES` says.
#[test]
fn a_recording_tells_the_zeros_the_delay_and_the_machine() {
    let machines = env::var("MACHINES").map_or(8, |count| count.parse().unwrap());
    let (mut in_time, mut at_zero, mut rejected) = (0, 0, 0);
    let (mut masses, mut predicted) = (Vec::new(), Vec::new());
    let mut rng = Pcg64::new(1);
    for seed in 5000..5000 + machines {
        let mut hardware = Random::new(seed).hardware;
        hardware.zeros = [(); 2].map(|()| uniform(&mut rng, -0.1, 0.1));
        let found = match calibrate(&record(&hardware, 10.0, seed), drawn(&hardware)) {
            Ok(found) => found,
            Err(error @ Error::OutOfRange { rule, .. }) if rule.starts_with("known within 3") => {
                let Params { length1, length2, .. } = hardware.params;
                println!("{seed}: {error}; link 1 / link 2 is {:.1}", length1 / length2);
                rejected += 1;
                continue;
            }
            Err(error) => panic!("{seed}: {error}"),
        };
        let Calibration { params, zeros, delay, prediction_error, .. } = found;
        in_time += u32::from((delay - hardware.delay - hardware.lag).abs() < 0.001);
        let off = |i: usize| (zeros[i] - hardware.zeros[i]).abs() * 4096.0 / TAU;
        at_zero += u32::from(off(0).max(off(1)) < 4.0);
        masses.push((params.mass2 * hardware.torque_factor / hardware.params.mass2 - 1.0).abs());
        predicted.push(prediction_error);
    }
    masses.sort_by(f64::total_cmp);
    predicted.sort_by(f64::total_cmp);
    println!(
        "{in_time} delays, {at_zero} zeros, {rejected} not known; {masses:.3?} {predicted:.3?}"
    );
    let accepted = masses.len() as f64;
    assert!(f64::from(in_time) >= 0.9 * accepted && f64::from(at_zero) >= 0.85 * accepted);
    assert!(rejected <= machines / 8);
    let part = |sorted: &[f64], part: usize| sorted[sorted.len() * part / 10];
    assert!(part(&masses, 5) < 0.01 && part(&masses, 9) < 0.05 && part(&predicted, 5) < 0.04);
}

type Change<'a> = &'a dyn Fn(&mut Sample);

/// On a recording of RealAIGym's machine, of 10 s. The variable `MACHINES` says how many, up to 10.
#[test]
fn what_is_wrong_with_a_recording_is_named() {
    let machines = env::var("MACHINES").map_or(1, |count| count.parse().unwrap());
    let errors: Vec<_> = (0..machines).map(|i| named((i + 7) % 10)).collect();
    let medians = [0, 1, 2].map(|i| {
        let mut errors: Vec<f64> = errors.iter().map(|errors| errors[i]).collect();
        errors.sort_by(f64::total_cmp);
        errors[errors.len() / 2]
    });
    println!("prediction errors {medians:.3?} rad");
    assert!(medians[0] < 0.02, "{medians:?}");
}

/// Returns the prediction errors of a recording, and of the same if each thousandth and each 300th
/// line is lost.
fn named(seed: u64) -> [f64; 3] {
    let hardware = Hardware { zeros: [0.05, -0.03], ..Hardware::realaigym() };
    let recording = record(&hardware, 10.0, seed);
    let calibrated = |change: Change| {
        let mut recording = recording.clone();
        recording.iter_mut().for_each(change);
        calibrate(&recording, drawn(&hardware))
    };
    let found = calibrated(&|_| ()).unwrap();
    assert!(found.delay < 0.001 && found.prediction_error < 0.06, "{seed}: {found:?}");
    let rounding = TAU / 4096.0 / 12.0_f64.sqrt(); // its standard deviation, rad
    assert!((found.angle_noise / rounding - 1.0).abs() < 0.1, "{seed}: {found:?}");
    let (report, ratio) = (found.to_string(), found.prediction_error / found.angle_noise);
    println!("{report}");
    assert!(report.contains(&format!("rad: {ratio:.0} times the noise")), "{seed}: {report}");
    assert!(!report.contains("coulomb1 is not told"), "{seed}: {report}");
    let is_told = found.fit.values[6] >= 5.0 * found.fit.std_errors[6];
    let untold = report.contains("damping1 is not told, only that it is below 0.0");
    assert_ne!(is_told, untold, "{seed}: {report}"); // both happen

    let [unexplained, wrong] = ["unexplained torque must be at most 3 %", "must be 1"];
    let mass = "mass1 + mass2 must be from 1/30 to 30 times that of the given ones (are torques in";
    let turned = |angle: f64| angle - (angle / TAU).round() * TAU;
    let cases: [(&str, Change); 14] = [
        (&format!("sign of angle1 {wrong} (counterclockwise), got -1"), &|x| x.angles[0] *= -1.0),
        (&format!("sign of angle2 {wrong} (counterclockwise), got -1"), &|x| x.angles[1] *= -1.0),
        (&format!("sign of torque {wrong} (θ2 grows), got -1"), &|x| x.torques[1] *= -1.0),
        ("angle1 in angle2 must be 0 (measure θ2 from link 1), got 1", &|x| {
            x.angles[1] += x.angles[0];
        }),
        ("zero1 must be between -0.5 and 0.5 rad, got 0.5", &|x| x.angles[0] += 0.455),
        ("length1 must be finite and above 0 m", &|x| x.angles[0] += PI),
        ("mass2 must be finite and above 0 kg", &|x| x.angles[1] += PI),
        (unexplained, &|x| x.angles[0] += 0.6),
        (unexplained, &|x| x.angles = x.angles.map(|angle| 1.02 * angle)),
        (unexplained, &|x| x.angles = x.angles.map(turned)),
        (unexplained, &|x| x.angles.swap(0, 1)),
        (unexplained, &|x| x.torques = [0.0; 2]),
        (mass, &|x| x.torques[1] *= 1e3),
        (mass, &|x| x.torques[1] /= 100.0),
    ];
    for (expected, change) in cases {
        let error = calibrated(change).unwrap_err().to_string();
        assert!(error.starts_with(expected), "{seed}: {expected}: {error}");
    }
    let dead = calibrated(&|x| x.angles[1] = 0.1).unwrap_err().to_string();
    let expected = "range of angle2 must be at least 0.2 (link 2 hardly moved, or its encoder is";
    assert!(dead.starts_with(expected), "{seed}: {dead}");
    let weak = record(&Hardware { limit: 0.5, ..hardware }, 10.0, seed);
    let weak = calibrate(&weak, drawn(&hardware)).unwrap_err().to_string();
    assert!(weak.starts_with("range of angle"), "{seed}: {weak}");

    // Torques late by so many samples.
    let late = |samples: usize| {
        let mut recording = recording.clone();
        let torques = recording.clone().into_iter().skip(samples).map(|sample| sample.torques);
        recording.iter_mut().zip(torques).for_each(|(sample, torques)| sample.torques = torques);
        recording
    };
    let delay = calibrate(&late(10), drawn(&hardware)).unwrap().delay;
    assert!((delay - found.delay - 0.020).abs() < 0.001, "{delay}");
    let early = recording.iter().skip(10).zip(&recording);
    let early = early.map(|(sample, before)| Sample { torques: before.torques, ..*sample });
    let lost = [&recording[..1000], &recording[1100..]].concat();
    let mut rng = Pcg64::new(1);
    let missing = "lost samples must be at most 0.5 (both angles turn twice as far as before and";
    let mut often_lost =
        |part| recording.iter().copied().filter(|_| uniform(&mut rng, 0.0, 1.0) >= part).collect();
    let mut sticks = recording.clone();
    let half = sticks.len() / 2;
    let stuck = sticks[half].angles[1];
    sticks[half..].iter_mut().for_each(|sample| sample.angles[1] = stuck);
    let rejected = [
        (lost, unexplained),
        (often_lost(0.01), missing),
        (often_lost(0.05), missing),
        (sticks, unexplained),
        (late(55), "delay must be below √((length1 + center_of_mass2) / gravity) / 2, in s"),
        (late(80), unexplained),
        (
            early.collect(),
            "delay must be at least 0 (record a torque before it acts), in s, got -0",
        ),
        (recording[..300].to_vec(), "mass11 must be "),
        (vec![], "mass11 must be determined by recordings in which both"),
    ];
    for (recording, expected) in rejected {
        let error = calibrate(&recording, drawn(&hardware)).unwrap_err().to_string();
        assert!(error.starts_with(expected), "{seed}: {expected}: {error}");
    }
    [usize::MAX, 1000, 300].map(|each| {
        let left = recording.iter().enumerate().filter(|(i, _)| (i + 1) % each != 0);
        let left: Vec<_> = left.map(|(_, sample)| *sample).collect();
        calibrate(&left, drawn(&hardware)).unwrap().prediction_error
    })
}
