//! Steps of any arithmetic, at every SIMD level and on all cores.

use std::num::NonZeroU32;

use acrobot::batch::{Autoreset, VecBatch};
use acrobot::numpy::{Pcg64, SeedSequence, uniform};
use acrobot::{Action, Fast};
use common::twins::Twins;
use common::{bits, draws};

/// `properties` tries the other arithmetics and widths: each takes seconds to compile.
#[test]
fn every_simd_level_equals_single_acrobots() {
    Twins::<Fast>::at_every_level();
}

#[test]
fn any_angle_steps_as_in_single_acrobots() {
    Twins::<Fast>::at_any_angle();
}

#[test]
fn threads_change_no_bit() {
    let (seed, len) = (SeedSequence::new(3), 20_003);
    let shared = VecBatch::<Fast>::new(seed.clone(), len).unwrap();
    let mut own = VecBatch::new(seed, len).unwrap();
    own.own_params().unwrap();
    own.set_draws(draws::<Fast>()).unwrap();
    own.reset();
    for mut one in [shared, own] {
        one.set_autoreset(Autoreset::SameStep);
        one.set_max_steps(NonZeroU32::new(4).unwrap());
        let mut many = one.clone();
        let mut rng = Pcg64::new(1);
        // This exceeds the limit of steps, with optimization often.
        for _ in 0..if cfg!(debug_assertions) { 3 } else { 30 } {
            let actions: Vec<u8> = (0..len).map(|_| Action::sample(&mut rng) as u8).collect();
            assert!(one.step(&actions) == many.par_step(&actions));
            let torques: Vec<f32> = (0..len).map(|_| uniform(&mut rng, -2.0, 2.0) as f32).collect();
            assert!(one.step(&torques) == many.par_step(&torques));
        }
        for i in (0..len).step_by(37) {
            let [one, many] = [&one, &many].map(|batch| batch.member(i).unwrap());
            assert_eq!(bits(one.state), bits(many.state), "acrobot {i}");
            assert_eq!(one, many, "acrobot {i}");
        }
    }
}
