//! The batch that owns its memory: another batch in its place, and members of one in another.

use acrobot::batch::{Autoreset, Batch, Block, VecBatch};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::task::{Draw, Draws};
use acrobot::{Acrobot, Error, Fast, Params, ResetOptions, State};

/// `DerefMut` gives access to the batch inside, so a batch of another length can replace it.
#[test]
fn replaced_batches_of_other_lengths_have_their_own_results() {
    let new = |len| {
        let mut batch = VecBatch::<Fast>::new(SeedSequence::new(len as u64), len).unwrap();
        batch.set_max_steps(3.try_into().unwrap());
        batch.set_autoreset(Autoreset::SameStep);
        batch
    };
    let (mut first, mut second) = (new(5), new(40));
    std::mem::swap::<Batch<_, _, _>>(&mut first, &mut second);
    for (swapped, expected) in [(&mut first, &mut new(40)), (&mut second, &mut new(5))] {
        let len = expected.len();
        assert_eq!(swapped.observations(), expected.observations());
        let mask: Vec<bool> = (0..len).map(|i| i % 2 == 0).collect();
        for batch in [&mut *swapped, &mut *expected] {
            batch.reset();
            batch.reset_masked(&mask, ResetOptions::default()).unwrap();
            assert_eq!(batch.observations().len(), len);
        }
        assert_eq!(swapped.observations(), expected.observations());
        for _ in 0..5 {
            let actions = vec![2_u8; len];
            assert_eq!(swapped.step(&actions), expected.step(&actions));
            let torques = vec![0.5; len];
            assert_eq!(swapped.step(&torques), expected.step(&torques));
        }
    }

    let shorter = (vec![Block::EMPTY], vec![Pcg64::UNSEEDED; 2], vec![], Draws::NONE);
    let shorter = Batch::new(3, shorter).unwrap();
    assert_eq!(std::mem::replace(&mut *first, shorter).len(), 40);
    assert_eq!(first.step(&[1_u8; 2]).unwrap().rewards, [-1.0; 2]);
    *first = (*second).clone();
    assert_eq!(first.observations().len(), 5);
}

#[test]
fn a_seed_repeats_initial_states_and_each_state_has_its_index() {
    let new = |seed| VecBatch::<Fast>::new(SeedSequence::new(seed), 40).unwrap();
    let expected = new(7).observations().to_vec();
    let mut batch = new(3);
    assert_ne!(batch.observations(), expected);
    batch.reset_with_seed(7);
    assert_eq!(batch.observations(), expected);
    batch.reset();
    assert_ne!(batch.observations(), expected);
    batch.reset_with_seed(7);
    assert_eq!(batch.observations(), expected);

    let state = |i: usize| State { dtheta1: i as f32 / 10.0, ..State::HANGING };
    (0..40).for_each(|i| batch.set_state_of(i, state(i)).unwrap());
    assert!((0..40).all(|i| batch.state_of(i) == Some(state(i))));
    assert_eq!(batch.state_of(40), None);
}

#[test]
fn a_batch_that_does_not_fit_into_memory_is_rejected() {
    let new = |len| VecBatch::<Fast>::new(SeedSequence::new(0), len).unwrap_err().to_string();
    assert_eq!(
        new(usize::MAX / 2),
        format!("a batch must fit into memory, got {} acrobots", usize::MAX / 2)
    );
    assert_eq!(new(0), "a batch must have at least 1 acrobot, got 0 generators");
}

/// A member whose reset is pending draws its own parameters, in any block.
#[test]
fn a_replaced_member_is_reset_with_its_own_parameters() {
    let mut batch = VecBatch::<Fast>::new(SeedSequence::new(3), 40).unwrap();
    batch.own_params().unwrap();
    batch.set_draws(common::draws::<Fast>()).unwrap();
    batch.set_max_steps(1.try_into().unwrap());
    batch.step(&[1_u8; 40]).unwrap();
    let pending = (0..40).map(|i| batch.member(i).unwrap()).collect::<Vec<_>>();
    batch.set_autoreset(Autoreset::SameStep);
    let expected = batch.clone();
    for (i, member) in pending.into_iter().enumerate() {
        batch.set_member(i, member).unwrap();
        assert_eq!(batch.member(i), expected.member(i));
    }
}

/// Where all share their parameters, a member's must have the same bits.
#[test]
fn a_member_with_another_zero_than_all_share_is_rejected() {
    let with_gravity = |gravity| {
        let mut batch = VecBatch::<Fast>::new(SeedSequence::new(3), 2).unwrap();
        let params = Params { gravity, ..Params::DEFAULT };
        batch.set_params(params).unwrap();
        batch
    };
    for gravity in [0.0, -0.0] {
        let mut batch = with_gravity(gravity);
        let own = batch.member(0).unwrap();
        batch.set_member(1, own).unwrap();
        let other = with_gravity(-gravity).member(0).unwrap();
        assert_eq!(batch.set_member(1, other), Err(Error::SharedParams));
    }
}

/// The packages for C, Python and JavaScript compare with the same file.
#[test]
fn parameters_are_drawn_after_the_initial_state_in_the_order_of_the_fields() {
    let draws = Draws::new(Params {
        mass2: Draw::Uniform { low: 0.8, high: 1.2 },
        inertia1: Draw::LogUniform { low: 0.5, high: 2.0 },
        inertia2: Draw::AsBefore,
        gravity: Draw::Normal { mean: 9.8, std: 0.1, low: 9.5, high: 10.1 },
        ..Draws::FIXED
    });
    let draws = draws.unwrap();
    let mut batch = VecBatch::<Fast>::new(SeedSequence::new(0), 3).unwrap();
    batch.own_params().unwrap();
    batch.set_draws(draws).unwrap();
    batch.reset_with(SeedSequence::new(42).into());
    // Without draws the states are the same.
    let plain = VecBatch::<Fast>::new(SeedSequence::new(42), 3).unwrap();
    for row in include_str!("../data/draws.csv").lines().skip(1) {
        let (seed, rest) = row.split_once(',').unwrap();
        let (child, numbers) = rest.split_once(',').unwrap();
        let (params, state) = if let Ok(child) = child.parse() {
            assert_eq!(plain.state_of(child), batch.state_of(child));
            (batch.params_of(child).unwrap(), batch.state_of(child).unwrap())
        } else {
            let mut acrobot = Acrobot::<Fast>::new(seed.parse().unwrap());
            acrobot.draw_params(&draws).unwrap();
            (*acrobot.params(), acrobot.state())
        };
        let [theta1, theta2, dtheta1, dtheta2] = state.into();
        let Params { mass2, inertia1, inertia2, gravity, .. } = params;
        let found = [mass2, inertia1, inertia2, gravity, theta1, theta2, dtheta1, dtheta2];
        assert_eq!(found.map(|x| x.to_string()).join(","), numbers, "{row}");
    }
}
