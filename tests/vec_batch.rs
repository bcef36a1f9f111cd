//! The batch that owns its memory: its results, and states that are set.

use acrobot::batch::{
    Autoreset, Batch, Block, Observations, SharedParams, StepBuffers, StepResults, VecBatch,
};
use acrobot::numpy::Pcg64;
use acrobot::{Acrobot, Fast, State};

/// The owning batch steps as the one that borrows its memory.
#[test]
fn a_batch_in_vecs_equals_one_in_arrays() {
    check_beside_arrays::<16>();
    check_beside_arrays::<3>();
}

fn check_beside_arrays<const N: usize>() {
    let mut owning = VecBatch::<Fast, SharedParams, N>::new(9, 20).unwrap();
    let mut arrays = Batch::<Fast, _, _>::new(9, [Block::EMPTY; 2], [Pcg64::UNSEEDED; 20]).unwrap();
    let (mut rewards, mut terminated, mut truncated) = ([0.0; 20], [false; 20], [false; 20]);
    let (mut observations, mut final_observations) = ([[0.0; 6]; 20], [[0.0; 6]; 20]);
    owning.set_limit(5.try_into().unwrap());
    owning.set_autoreset(Autoreset::SameStep);
    arrays.set_limit(5.try_into().unwrap());
    arrays.set_autoreset(Autoreset::SameStep);
    for _ in 0..30 {
        let buffers = StepBuffers {
            rewards: &mut rewards,
            terminated: &mut terminated,
            truncated: &mut truncated,
            observations: Observations::Rows(&mut observations),
            final_observations: Observations::Rows(&mut final_observations),
        };
        arrays.step(&[2_u8; 20], buffers).unwrap();
        let expected = StepResults {
            rewards: &rewards,
            terminated: &terminated,
            truncated: &truncated,
            observations: &observations,
            final_observations: &final_observations,
        };
        assert_eq!(owning.step(&[2_u8; 20]).unwrap(), expected);
    }
}

/// Episodes of some begin in given states. The others do not change.
#[test]
fn some_begin_in_given_states() {
    let mut batch = VecBatch::<Fast>::new(9, 35).unwrap();
    batch.step(&[2_u8; 35]).unwrap();
    let mask: Vec<bool> = (0..35).map(|i| i % 3 == 0).collect();
    let states: Vec<State<f32>> = (0..35)
        .map(|i| State::from([i as f32 / 35.0, 0.5, 0.0, 1.0]))
        .collect();
    let before = batch.clone();
    batch.reset_to_masked(&mask, &states).unwrap();
    for i in 0..35 {
        let member = batch.member(i).unwrap();
        if mask[i] {
            assert_eq!((member.state, member.elapsed), (states[i], 0));
        } else {
            assert_eq!(Some(member), before.member(i));
        }
    }
    let seen = batch.observations()[3];
    let mut alone = Acrobot::<Fast>::new(0);
    alone.set_state(states[3]).unwrap();
    assert_eq!(seen, alone.observation().to_array());

    let before = batch.clone();
    let mut infinite = states;
    infinite[1].theta1 = f32::INFINITY;
    assert!(batch.reset_to_masked(&mask, &infinite).is_err());
    assert!(batch.reset_to_masked(&mask[1..], &infinite[1..]).is_err());
    for i in 0..35 {
        assert_eq!(batch.member(i), before.member(i));
    }
}

#[test]
fn a_batch_that_does_not_fit_into_memory_is_rejected() {
    let new = |len| VecBatch::<Fast>::new(0, len).unwrap_err().to_string();
    assert_eq!(
        new(usize::MAX / 2),
        format!(
            "a batch must fit into memory, got {} acrobots",
            usize::MAX / 2
        )
    );
    assert_eq!(
        new(0),
        "a batch must have at least 1 acrobot, got 0 generators"
    );
}
