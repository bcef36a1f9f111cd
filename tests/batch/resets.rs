//! Resets, states and members that are set, and changes of the mode.

use acrobot::arithmetic::{Arithmetic, Host, Micro, Real, Reference};
use acrobot::batch::{Autoreset, VecBatch};
use acrobot::numpy::{Pcg64, SeedSequence, uniform};
use acrobot::physics::ResetBounds;
use acrobot::{Acrobot, Fast, Portable, ResetOptions, State, TimeLimit};

use common::twins::{Twins, equal};

#[test]
fn given_initial_states_equal_single_acrobots() {
    let mut rng = Pcg64::new(3);
    let mut twins = Twins::<Fast>::new(35, Autoreset::NextStep);
    // After 500 steps the resets of most are pending.
    for steps in [500, 3, 8] {
        twins.play_randomly(steps);
        let mut number = || uniform(&mut rng, -10.0, 10.0) as f32;
        let states = (0..35).map(|_| State::from([(); 4].map(|()| number())));
        twins.reset_to(&states.collect::<Vec<_>>());
    }
    twins.swing(520);
}

/// Each kind of reset equals that of the same name for every scalar twin. None changes the batch's bounds.
#[test]
fn resets_equal_those_of_single_acrobots() {
    let mut twins = Twins::<Fast>::new(35, Autoreset::NextStep);
    let bounds = ResetBounds::new(1.0, 2.0).unwrap();
    // After 500 steps most resets are pending. These resets replace them.
    for steps in [500, 3] {
        twins.play_randomly(steps);
        twins.batch.reset();
        twins.reset_alone(|_, alone| {
            alone.reset();
        });

        twins.play_randomly(steps);
        twins.batch.reset_with_seed(7);
        twins.reset_alone(|i, alone| {
            let child = SeedSequence::new(7).child(i as u64);
            *alone = TimeLimit::v1(Acrobot::with_rng(child.into()));
        });

        twins.play_randomly(steps);
        twins.reset(bounds.into());
        twins.play_randomly(steps);
        for seed in [Some(SeedSequence::new(8)), None] {
            let bounds = Some(bounds);
            twins.reset(ResetOptions { seed, bounds });
        }
    }
    assert_eq!(twins.batch.reset_bounds(), ResetBounds::DEFAULT);
}

/// With `Autoreset::Disabled`, `reset_masked` equals resets of single acrobots, at ends and after them.
#[test]
fn masked_resets_equal_resets_of_single_acrobots() {
    fn play<A: Arithmetic, const N: usize>() {
        let mut twins = Twins::<A, N>::new(35, Autoreset::Disabled);
        twins.set_noise(0.3);
        twins.set_bounds(-1.0, 1.0);
        let bounds = twins.batch.reset_bounds();
        let mut rng = Pcg64::new(7);
        let (mut ends, mut past) = (0, 0);
        let mut before = vec![false; 35];
        for step in 0..700 {
            let done = twins.step(&twins.swinging());
            ends += done.iter().filter(|done| **done).count();
            // Some acrobots step on after their end, and some are reset before it.
            let mask: Vec<bool> = done
                .iter()
                .map(|&done| uniform(&mut rng, 0.0, 1.0) < if done { 0.5 } else { 0.005 })
                .collect();
            past += before.iter().zip(&mask).filter(|(x, y)| **x && **y).count();
            before = done.iter().zip(&mask).map(|(x, y)| *x && !y).collect();
            // Every 50th reset has a seed, and acrobot i takes its i-th child.
            let seed = (step % 50 == 0).then(|| SeedSequence::new(step));
            let options = ResetOptions { seed, bounds: None };
            let rows = twins.batch.reset_masked(&mask, options.clone()).unwrap();
            let rows = rows.to_vec();
            twins.reset_alone(|i, alone| {
                if mask[i] {
                    let seed = options.seed.as_ref().map(|seed| seed.child(i as u64));
                    let bounds = Some(bounds);
                    alone.reset_with(ResetOptions { seed, bounds });
                }
                assert!(equal(&rows[i], &alone.inner().observation()));
            });
        }
        assert!(
            ends > 100 && past > 10,
            "{ends} ends, {past} resets after a step past the end"
        );
    }
    play::<Fast, 16>();
    play::<Micro, 16>();
    play::<Portable, 16>();
    play::<Host, 16>();
}

/// Acrobots whose reset is pending continue when the mode changes to `Disabled`.
#[test]
fn pending_resets_end_in_mode_disabled() {
    let mut twins = Twins::<Fast>::new(35, Autoreset::NextStep);
    twins.set_noise(0.3);
    for _ in 0..3 {
        twins.swing_until_pending();
        twins.batch.set_autoreset(Autoreset::Disabled);
        twins.pending.fill(false);
        twins.assert_equal();
        twins.swing(100);
        twins.batch.set_autoreset(Autoreset::NextStep);
        twins.swing(100);
    }
}

/// Setting the state of one acrobot keeps its episode, and changes no other acrobot.
#[test]
fn set_state_equals_that_of_a_single_acrobot() {
    fn check<A: Arithmetic, const N: usize>() {
        let mut twins = Twins::<A, N>::new(35, Autoreset::NextStep);
        twins.set_noise(0.3);
        let mut rng = Pcg64::new(3);
        for index in [Some(0), Some(15), Some(16), Some(34), None] {
            twins.swing(50);
            // The reset of the last one is pending, and remains so.
            let index = index.unwrap_or_else(|| twins.swing_until_pending());
            let numbers = [(); 4].map(|()| A::Scalar::from_f64(uniform(&mut rng, -10.0, 10.0)));
            let state = State::from(numbers);
            twins.batch.set_state(index, state).unwrap();
            twins.alone[index].set_state(state).unwrap();
            twins.assert_equal();
            let mut rows = [[0.0; 6]; 35];
            twins.batch.observe(&mut rows).unwrap();
            for (row, alone) in rows.iter().zip(&twins.alone) {
                assert!(equal(row, &alone.inner().observation()));
            }
        }
        twins.swing(100);
    }
    check::<Fast, 16>();
    check::<Micro, 16>();
    check::<Portable, 16>();
    check::<Reference, 16>();
    check::<Host, 16>();
}

/// The members are stored in the middle of episodes or just after their end, with noise.
#[test]
fn members_resume_in_another_batch() {
    let mut twins = Twins::<Fast>::new(35, Autoreset::NextStep);
    twins.set_noise(0.3);
    for steps in [70, 430] {
        twins.swing(steps);
        let members: Vec<_> = (0..35).map(|i| twins.batch.member(i).unwrap()).collect();
        assert!(members.iter().any(|member| member.elapsed > 0));
        twins.batch = VecBatch::new(SeedSequence::new(7), 35).unwrap();
        twins.batch.set_params(members[0].params).unwrap();
        for (index, member) in members.into_iter().enumerate() {
            twins.batch.set_member(index, member).unwrap();
        }
    }
    twins.play_randomly(600);
}

/// Gymnasium's `SyncVectorEnv` seeds environment `i` with `seed + i`.
#[test]
fn replaced_generators_equal_those_of_single_acrobots() {
    let mut twins = Twins::<Host>::new(19, Autoreset::NextStep);
    for (rng, i) in twins.batch.generators_mut().iter_mut().zip(0..) {
        *rng = Pcg64::new(7 + i);
    }
    twins.batch.reset();
    twins.reset_alone(|i, alone| {
        alone.reset_with_seed(7 + i as u64);
    });
    twins.swing(100);
}
