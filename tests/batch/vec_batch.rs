//! The batch that owns its memory: another batch in its place, and members of one in another.

use acrobot::batch::{Batch, VecBatch};
use acrobot::task::{Draw, Draws};
use acrobot::{Acrobot, Fast, Params};

/// `DerefMut` gives access to the batch inside, so a batch of another length can replace it.
#[test]
fn replaced_batches_of_other_lengths_have_their_own_results() {
    let new = |len| VecBatch::<Fast>::new(len as u64, len).unwrap();
    let (mut first, mut second) = (new(5), new(40));
    std::mem::swap::<Batch<_, _, _>>(&mut first, &mut second);
    for (swapped, expected) in [(&mut first, &mut new(40)), (&mut second, &mut new(5))] {
        assert_eq!(swapped.observations(), expected.observations());
        let actions = vec![2_u8; expected.len()];
        assert_eq!(swapped.step(&actions), expected.step(&actions));
    }
    *first = (*second).clone();
    assert_eq!(first.step(&[1_u8; 5]).unwrap().rewards, [-1.0; 5]);
}

#[test]
fn a_batch_that_does_not_fit_into_memory_is_rejected() {
    let len = usize::MAX / 2;
    let error = VecBatch::<Fast>::new(0, len).unwrap_err().to_string();
    assert_eq!(error, format!("all acrobots must fit into memory, got {len}"));
}

/// The packages for C, Python and JavaScript compare with the same file.
#[test]
fn parameters_are_drawn_after_the_initial_state_in_the_order_of_the_fields() {
    let draws = Draws::new(Params {
        mass2: Draw::Uniform { low: 0.8, high: 1.2 },
        inertia1: Draw::LogUniform { low: 0.5, high: 2.0 },
        gravity: Draw::Normal { mean: 9.8, std: 0.1, low: 9.5, high: 10.1 },
        ..Draws::FIXED
    });
    let draws = draws.unwrap();
    let mut batch = VecBatch::<Fast>::new(0, 3).unwrap();
    batch.own_params().unwrap();
    batch.set_draws(draws).unwrap();
    batch.reset_with_seed(42);
    // Without draws the states are the same.
    let plain = VecBatch::<Fast>::new(42, 3).unwrap();
    for row in include_str!("../data/draws.csv").lines().skip(1) {
        let (seed, rest) = row.split_once(',').unwrap();
        let (child, numbers) = rest.split_once(',').unwrap();
        let (params, state) = if let Ok(child) = child.parse() {
            assert_eq!(plain.state(child), batch.state(child));
            (batch.params(child).unwrap(), batch.state(child).unwrap())
        } else {
            let mut acrobot = Acrobot::<Fast>::new(seed.parse::<u64>().unwrap());
            acrobot.draw_params(&draws).unwrap();
            (*acrobot.params(), acrobot.state())
        };
        let [theta1, theta2, dtheta1, dtheta2] = state.into();
        let Params { mass2, inertia1, gravity, .. } = params;
        let found = [mass2, inertia1, gravity, theta1, theta2, dtheta1, dtheta2];
        assert_eq!(found.map(|x| x.to_string()).join(","), numbers, "{row}");
    }
}
