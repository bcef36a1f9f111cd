//! With the reset by the step that ends an episode none waits for it, however it came into the batch.

use acrobot::{
    Autoreset, Batch, Block, Fast, Member, Observations, Output, Params, Pcg64, StartBounds,
};

type One = Batch<Fast, [Block; 1], [Pcg64; 1]>;

/// One with noise, within bounds that starts can be known by.
fn one(autoreset: Autoreset) -> One {
    let mut batch = One::new(42, [Block::EMPTY], [Pcg64::UNSEEDED]).unwrap();
    let noisy = Params {
        torque_noise: 1.0,
        ..Params::default()
    };
    batch.set_params(noisy).unwrap();
    batch.set_start_bounds(StartBounds::new(0.5, 0.6).unwrap());
    batch.set_autoreset(autoreset);
    batch
}

fn waiting() -> Member {
    Member {
        ended: true,
        elapsed: 7,
        ..one(Autoreset::NextStep).member(0).unwrap()
    }
}

/// It is at a start, and draws its noise from there on.
fn assert_begun(mut batch: One) {
    let start = batch.member(0).unwrap();
    assert!((0.5..0.6).contains(&start.state.theta1), "{start:?}");
    assert_eq!((start.elapsed, start.ended), (0, false));
    let output = Output {
        rewards: &mut [0.0],
        terminated: &mut [false],
        truncated: &mut [false],
        observations: Observations::None,
        final_observations: Observations::None,
    };
    batch.step(&[1_u8], output).unwrap();
    let stepped = batch.member(0).unwrap();
    assert_eq!((stepped.elapsed, stepped.ended), (1, false));
    assert_ne!(stepped.rng, start.rng, "no noise was drawn");
}

#[test]
fn one_that_waits_is_reset_where_it_is_put() {
    let mut batch = one(Autoreset::SameStep);
    batch.set_member(0, waiting()).unwrap();
    assert_begun(batch);

    let mut batch = one(Autoreset::NextStep);
    batch.set_member(0, waiting()).unwrap();
    assert_eq!(batch.member(0), Some(waiting()));
}

#[test]
fn one_that_waits_is_reset_when_the_mode_changes() {
    let mut batch = one(Autoreset::NextStep);
    batch.set_member(0, waiting()).unwrap();
    batch.set_autoreset(Autoreset::SameStep);
    assert_begun(batch);
}
