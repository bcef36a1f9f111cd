//! The slices that a batch reads and writes: observations in either layout, and what is refused.

use std::num::NonZeroU32;

use acrobot::{
    Acrobot, Autoreset, Batch, Block, Error, Fast, Observations, Output, Params, Pcg64,
    SeedSequence, State, Vectors,
};

type Small<const BLOCKS: usize, const LEN: usize> = Batch<Fast, [Block; BLOCKS], [Pcg64; LEN]>;

/// A batch without a heap.
fn small<const BLOCKS: usize, const LEN: usize>() -> Result<Small<BLOCKS, LEN>, Error> {
    Batch::new(1, [Block::EMPTY; BLOCKS], [Pcg64::UNSEEDED; LEN])
}

#[test]
fn columns_are_the_rows() {
    let mut batch = small::<2, 20>().unwrap();
    batch.set_limit(NonZeroU32::MIN);
    let mut rows = [[0.0; 6]; 20];
    batch.observe(Observations::Rows(&mut rows)).unwrap();
    let mut columns = [[0.0; 20]; 6];
    batch
        .observe(Observations::Columns(
            columns.each_mut().map(|column| &mut column[..]),
        ))
        .unwrap();
    for (i, row) in rows.iter().enumerate() {
        assert_eq!(*row, columns.map(|column| column[i]));
        let alone = Acrobot::<Fast>::new(SeedSequence::from(1).child(i as u64));
        assert_eq!(*row, *alone.observation());
    }
}

/// By each kind of vectors, one after another; on one thread, for so few are not shared out.
#[test]
fn a_limit_truncates_each_of_its_steps() {
    let mut batch = small::<1, 3>().unwrap();
    batch.set_limit(NonZeroU32::new(2).unwrap());
    batch.set_autoreset(Autoreset::SameStep);
    for vectors in [Vectors::Baseline, Vectors::Avx2, Vectors::Avx512] {
        batch.set_vectors(vectors);
        for expected in [false, true] {
            let mut truncated = [!expected; 3];
            let output = Output {
                rewards: &mut [0.0; 3],
                terminated: &mut [false; 3],
                truncated: &mut truncated,
                observations: Observations::None,
                final_observations: Observations::None,
            };
            batch.par_step(&[1_u8; 3], output).unwrap();
            assert_eq!(truncated, [expected; 3]);
        }
    }
}

#[test]
fn an_episode_ends_once_where_the_goal_is_reached_on_its_last_step() {
    let mut batch = small::<1, 1>().unwrap();
    batch.set_limit(NonZeroU32::MIN);
    let upright = State {
        theta1: core::f32::consts::PI,
        ..State::default()
    };
    batch.reset_to(&[upright]).unwrap();
    let (mut terminated, mut truncated) = ([false], [false]);
    let output = Output {
        rewards: &mut [0.0],
        terminated: &mut terminated,
        truncated: &mut truncated,
        observations: Observations::None,
        final_observations: Observations::None,
    };
    batch.step(&[1_u8], output).unwrap();
    assert_eq!((terminated, truncated), ([true], [true]));
    assert!(batch.member(0).unwrap().ended);
}

#[test]
fn bad_input_is_refused_before_anything_is_stepped() {
    let refused = small::<1, 0>().unwrap_err();
    assert_eq!(
        refused.to_string(),
        "generators is 0 acrobots; allowed is 1 or more"
    );
    let refused = small::<1, 17>().unwrap_err();
    assert_eq!(refused.to_string(), "blocks has 1 elements; allowed is 2");

    let mut batch = small::<1, 3>().unwrap();
    let before = batch.state(1);
    let mut step = |actions: &[u8], lengths: [usize; 5]| {
        let [rewards, terminated, truncated, rows, finals] = lengths;
        batch.step(
            actions,
            Output {
                rewards: &mut vec![0.0; rewards],
                terminated: &mut vec![false; terminated],
                truncated: &mut vec![false; truncated],
                observations: Observations::Rows(&mut vec![[0.0; 6]; rows]),
                final_observations: Observations::Rows(&mut vec![[0.0; 6]; finals]),
            },
        )
    };
    for (actions, lengths, message) in [
        (&[0, 1][..], [3; 5], "actions has 2 elements; allowed is 3"),
        (
            &[0, 1, 2],
            [2, 3, 3, 3, 3],
            "rewards has 2 elements; allowed is 3",
        ),
        (
            &[0, 1, 2],
            [3, 0, 3, 3, 3],
            "terminated has 0 elements; allowed is 3",
        ),
        (
            &[0, 1, 2],
            [3, 3, 4, 3, 3],
            "truncated has 4 elements; allowed is 3",
        ),
        (
            &[0, 1, 2],
            [3, 3, 3, 1, 3],
            "observations has 1 elements; allowed is 3",
        ),
        (
            &[0, 1, 2],
            [3, 3, 3, 3, 4],
            "final_observations has 4 elements; allowed is 3",
        ),
        (
            &[0, 3, 1],
            [3; 5],
            "action is 3; allowed is 0 (negative torque), 1 (none) or 2 (positive)",
        ),
    ] {
        assert_eq!(step(actions, lengths).unwrap_err().to_string(), message);
    }
    assert_eq!(batch.state(1), before);
    assert_eq!(batch.state(3), None);
    let error = batch.set_params(Params {
        dt: 0.0,
        ..Params::default()
    });
    assert!(matches!(error, Err(Error::OutOfRange { name: "dt", .. })));
}

#[test]
fn vectors_are_what_the_machine_has() {
    #[cfg(target_arch = "x86_64")]
    let (avx2, avx512) = (
        is_x86_feature_detected!("avx2"),
        is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512bw")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512vl"),
    );
    #[cfg(not(target_arch = "x86_64"))]
    let (avx2, avx512) = (false, false);
    assert!(Vectors::Baseline.is_available());
    assert_eq!(Vectors::Avx2.is_available(), avx2);
    assert_eq!(Vectors::Avx512.is_available(), avx512);
    let widest = match (avx512, avx2) {
        (true, _) => Vectors::Avx512,
        (_, true) => Vectors::Avx2,
        _ => Vectors::Baseline,
    };
    assert_eq!(Vectors::widest(), widest);
}
