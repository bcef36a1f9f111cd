//! Steps of any arithmetic, at every SIMD level and on all cores.

use std::cell::Cell;
use std::num::NonZeroU32;
use std::rc::Rc;

use acrobot::batch::{Autoreset, Batch, Block, LaneParams, StepBuffers, StepResults, VecBatch};
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

fn bits_of(results: &StepResults) -> [Vec<u32>; 5] {
    let bits = |xs: &[f32]| xs.iter().map(|x| x.to_bits()).collect();
    let ends = |xs: &[bool]| xs.iter().map(|x| u32::from(*x)).collect();
    [
        bits(&results.rewards),
        ends(&results.terminated),
        ends(&results.truncated),
        bits(results.observations.as_flattened()),
        bits(results.final_observations.as_flattened()),
    ]
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
            let alone = bits_of(one.step(&actions).unwrap());
            assert!(alone == bits_of(many.par_step(&actions).unwrap()));
            let torques = (0..len).map(|_| uniform(&mut rng, -2.0, 2.0) as f32);
            let torques: Vec<f32> = torques.collect();
            let alone = bits_of(one.step(&torques).unwrap());
            assert!(alone == bits_of(many.par_step(&torques).unwrap()));
        }
        for i in 0..len {
            let [one, many] = [&one, &many].map(|batch| batch.member(i).unwrap());
            assert_eq!(bits(one.state), bits(many.state), "acrobot {i}");
            assert_eq!(one, many, "acrobot {i}");
        }
    }
}

/// A user's slices can differ in length from one call to the next. Steps on all cores and on one
/// then do the same.
#[test]
fn slices_that_change_their_length_cannot_panic() {
    #[derive(Clone)]
    struct Fickle<T> {
        all: Vec<T>,
        changed: Rc<Cell<usize>>,
    }

    impl<T> AsRef<[T]> for Fickle<T> {
        fn as_ref(&self) -> &[T] {
            &self.all
        }
    }

    impl<T> AsMut<[T]> for Fickle<T> {
        fn as_mut(&mut self) -> &mut [T] {
            &mut self.all[..self.changed.get()]
        }
    }

    let len = 40_000_usize;
    let all = len.div_ceil(Block::<Fast>::LANES);
    for (own, changed) in [
        (0, [all, 17, 0]),
        (0, [all, 0, 0]),
        (0, [100, len, 0]),
        (0, [0, len, 0]),
        (0, [all, len, 0]),
        (all, [all, 17, all]),
        (all, [100, len, all]),
        (all, [all, len, 100]),
        (all, [all, len, 0]),
        (all, [all, len, all]),
    ] {
        let lengths = [all, len, own].map(|len| Rc::new(Cell::new(len)));
        let [blocks, generators, lane_params] = lengths.clone();
        let memory = (
            Fickle { all: vec![Block::EMPTY; all], changed: blocks },
            Fickle { all: vec![Pcg64::UNSEEDED; len], changed: generators },
            Fickle { all: vec![LaneParams::default(); own], changed: lane_params },
            Draws::NONE,
        );
        let mut one = Batch::<Fast, _>::new(3, memory).unwrap();
        one.set_max_steps(NonZeroU32::MIN);
        let mut many = one.clone();
        for (len, changed) in lengths.iter().zip(changed) {
            len.set(changed);
        }
        let step = |batch: &mut Batch<_, _>, parallel| {
            let mut rewards = vec![9.0; len];
            let mut ends = [vec![true; len], vec![true; len]];
            let mut rows = vec![[9.0; 6]; len];
            let [terminated, truncated] = &mut ends;
            let buffers =
                StepBuffers::new(&mut rewards, terminated, truncated).with_observations(&mut rows);
            let torques = &vec![1.0; len];
            match parallel {
                true => batch.par_step_into(torques, buffers).unwrap(),
                false => batch.step_into(torques, buffers).unwrap(),
            }
            (rewards, ends, rows)
        };
        for _ in 0..2 {
            assert!(step(&mut one, false) == step(&mut many, true));
        }
    }
}
