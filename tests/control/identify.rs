//! Recordings of angles and torques tell the parameters of a machine.

use acrobot::Params;
use acrobot::control::{Evidence, Sample};
use acrobot::numpy::{Pcg64, uniform};

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
    let mut turns = [0.0; 2];
    let mut before = [0.0; 2];
    for _ in 0..5000 {
        if left <= 0.0 {
            (torque, left) = (uniform(rng, -3.0, 3.0), uniform(rng, 0.05, 0.4));
        }
        left -= 0.002;
        let mut angles = machine.angles();
        for i in 0..2 {
            let jump = angles[i] - before[i];
            before[i] = angles[i];
            turns[i] -= (jump / std::f64::consts::TAU).round() * std::f64::consts::TAU;
            angles[i] += turns[i];
        }
        samples.push(Sample { angles, torques: [0.0, torque] });
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
    for (half, window) in
        [(1, 250), (2, 250), (3, 100), (3, 250), (5, 100), (5, 250), (10, 100), (10, 250)]
    {
        let mut rng = Pcg64::new(5);
        let mut worst = Vec::new();
        for seed in 0..20 {
            let truth = machine(&mut rng);
            let samples = record(truth, &mut rng, seed);
            let mut evidence = Evidence::NONE;
            evidence.add(&samples, 0.002, 9.81, half, window).unwrap();
            let found = evidence.solve();
            assert_eq!(found.undetermined, 0);
            let pairs = inertias(&truth).into_iter().zip(found.values);
            let error = pairs.map(|(truth, found)| (found / truth - 1.0).abs()).fold(0.0, f64::max);
            worst.push(error);
            if seed == 0 {
                println!(
                    "{:?} {:?}\n{:?} {:?}",
                    inertias(&truth),
                    truth.coulomb,
                    found.values,
                    found.errors
                );
            }
        }
        worst.sort_by(f64::total_cmp);
        println!("{half} {window}: median {:.4}, worst {:.4}", worst[10], worst[19]);
    }
}
