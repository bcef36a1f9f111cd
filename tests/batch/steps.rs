//! Steps of any arithmetic, at every SIMD level and on all cores.

use std::cell::Cell;
use std::num::NonZeroU32;
use std::rc::Rc;

use acrobot::batch::{Autoreset, Batch, Block, LaneParams, StepBuffers, VecBatch};
use acrobot::numpy::{Pcg64, SeedSequence, uniform};
use acrobot::task::Draws;
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
    let (seed, len) = (SeedSequence::new(3), 40_003);
    let shared = VecBatch::<Fast>::new(seed.clone(), len).unwrap();
    let mut own = VecBatch::new(seed, len).unwrap();
    own.own_params().unwrap();
    own.set_draws(draws::<Fast>()).unwrap();
    own.reset();
    for mut one in [shared, own] {
        one.set_autoreset(Autoreset::SameStep);
        one.set_max_steps(NonZeroU32::new(7).unwrap());
        let mut many = one.clone();
        let mut rng = Pcg64::new(1);
        // This exceeds the limit of steps, with optimization eight times.
        for _ in 0..if cfg!(debug_assertions) { 5 } else { 30 } {
            let actions: Vec<Action> = (0..len).map(|_| Action::sample(&mut rng)).collect();
            assert!(one.step(&actions) == many.par_step(&actions));
            let torques: Vec<f32> = (0..len).map(|_| uniform(&mut rng, -2.0, 2.0) as f32).collect();
            assert!(one.step(&torques) == many.par_step(&torques));
        }
        for i in 0..len {
            let [one, many] = [&one, &many].map(|batch| batch.member(i).unwrap());
            assert_eq!(bits(one.state), bits(many.state), "acrobot {i}");
            assert_eq!(one, many, "acrobot {i}");
        }
    }
}

/// `AsMut` of a user's memory can return other lengths than `AsRef` did. Steps on all cores and on
/// one then do the same.
#[test]
fn slices_that_change_their_length_cannot_panic() {
    /// The elements, how many are left later, and whether it is later.
    #[derive(Clone)]
    struct Fickle<T>(Vec<T>, usize, Rc<Cell<bool>>);

    impl<T> AsRef<[T]> for Fickle<T> {
        fn as_ref(&self) -> &[T] {
            &self.0
        }
    }

    impl<T> AsMut<[T]> for Fickle<T> {
        fn as_mut(&mut self) -> &mut [T] {
            let len = if self.2.get() { self.1 } else { self.0.len() };
            &mut self.0[..len]
        }
    }

    let len = 40_000_usize;
    let all = len.div_ceil(Block::<Fast>::LANES);
    for (own, [blocks, generators, lane_params]) in [
        (0, [all, 17, 0]),
        (0, [100, len, 0]),
        (0, [0, len, 0]),
        (all, [all, 17, all]),
        (all, [all, len, 100]),
        (all, [all, len, 0]),
    ] {
        let later = Rc::new(Cell::new(false));
        let memory = (
            Fickle(vec![Block::EMPTY; all], blocks, later.clone()),
            Fickle(vec![Pcg64::UNSEEDED; len], generators, later.clone()),
            Fickle(vec![LaneParams::default(); own], lane_params, later.clone()),
            Draws::NONE,
        );
        let mut batch = Batch::<Fast, _>::new(3, memory).unwrap();
        batch.set_max_steps(NonZeroU32::MIN);
        later.set(true);
        let [one, many] = [false, true].map(|parallel| {
            let mut batch = batch.clone();
            let mut rewards = vec![9.0; len];
            let mut ends = [vec![true; len], vec![true; len]];
            let [terminated, truncated] = &mut ends;
            for _ in 0..2 {
                let buffers = StepBuffers::new(&mut rewards, terminated, truncated);
                let torques = &vec![1.0; len];
                match parallel {
                    true => batch.par_step_into(torques, buffers).unwrap(),
                    false => batch.step_into(torques, buffers).unwrap(),
                }
            }
            (rewards, ends)
        });
        assert!(one == many);
    }
}
