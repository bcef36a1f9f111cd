//! Bad input is rejected with its reason, and changes nothing.

use learners::{
    Budget, Dimension, Group, Learn as _, LoadError, Sarsa, Schedule, Settings, Symmetry, Table,
    TileCoder, displacement,
};
use rand_pcg::Pcg32;

const LINE: [Dimension; 1] = [Dimension::bounded(0.0, 1.0, 4)];

fn coder(
    line: [Dimension; 1],
    tilings: usize,
    table: Table,
) -> Result<TileCoder<1, 4>, learners::Error> {
    TileCoder::new(line, &[Group::new(&[0], tilings)], table, displacement)
}

const SETTINGS: Settings = Settings {
    gamma: 1.0,
    lambda: 0.9,
    alpha: Schedule::constant(0.5),
    epsilon: Schedule::constant(0.1),
    symmetry: Symmetry::None,
};

type Agent<'w> = Sarsa<'w, TileCoder<1, 4>, 32, 2, 1, 4>;

fn agent(weights: &mut [[f32; 2]; 32]) -> Agent<'_> {
    Sarsa::new(
        coder(LINE, 4, Table::Hashed(32)).unwrap(),
        SETTINGS,
        weights,
    )
    .unwrap()
}

#[test]
fn invalid_settings_are_rejected() {
    let ending = |end| Schedule {
        start: 0.5,
        end,
        over: Budget::Episodes(9),
    };
    let cases: [(Settings, &str); 10] = [
        (
            Settings {
                gamma: 1.01,
                ..SETTINGS
            },
            "gamma must be between 0 and 1, got 1.01",
        ),
        (
            Settings {
                lambda: -0.5,
                ..SETTINGS
            },
            "lambda must be between 0 and 1, got -0.5",
        ),
        (
            Settings {
                lambda: f32::NAN,
                ..SETTINGS
            },
            "lambda must be between 0 and 1, got NaN",
        ),
        (
            Settings {
                alpha: Schedule::constant(0.0),
                ..SETTINGS
            },
            "alpha must be above 0 and at most 1, got 0",
        ),
        (
            Settings {
                alpha: Schedule::constant(1.5),
                ..SETTINGS
            },
            "alpha must be between 0 and 1, got 1.5",
        ),
        (
            Settings {
                alpha: ending(1.5),
                ..SETTINGS
            },
            "alpha's end must be between 0 and 1, got 1.5",
        ),
        (
            Settings {
                epsilon: Schedule::constant(-1.0),
                ..SETTINGS
            },
            "epsilon must be between 0 and 1, got -1",
        ),
        (
            Settings {
                epsilon: ending(-1.0),
                ..SETTINGS
            },
            "epsilon's end must be between 0 and 1, got -1",
        ),
        (
            Settings {
                epsilon: ending(f32::NAN),
                ..SETTINGS
            },
            "epsilon's end must be between 0 and 1, got NaN",
        ),
        (
            Settings {
                symmetry: Symmetry::Mirror(1),
                ..SETTINGS
            },
            "the mirror's dimension must be below 1, got 1",
        ),
    ];
    for (settings, reason) in cases {
        let mut weights = [[7.0; 2]; 32];
        let error = Sarsa::new(
            coder(LINE, 4, Table::Direct).unwrap(),
            settings,
            &mut weights,
        )
        .expect_err(reason);
        assert_eq!(error.to_string(), reason);
        assert_eq!(weights, [[7.0; 2]; 32]);
    }
}

#[test]
fn invalid_sizes_are_rejected() {
    let mut few = [[0.0; 2]; 19];
    let direct = coder(LINE, 4, Table::Direct).unwrap();
    let error = Sarsa::new(direct.clone(), SETTINGS, &mut few).unwrap_err();
    assert_eq!(
        error.to_string(),
        "slots of the features must be from 1 to 19, got 20"
    );
    let mut none = [[0.0; 0]; 32];
    let error = Sarsa::new(direct, SETTINGS, &mut none).unwrap_err();
    assert_eq!(error.to_string(), "actions must be from 1 to 256, got 0");
}

#[test]
fn invalid_coders_are_rejected() {
    let reason = |line, tilings, table| coder(line, tilings, table).unwrap_err().to_string();
    for slots in [0, 1, (1 << 16) + 1] {
        assert_eq!(
            reason(LINE, 4, Table::Hashed(slots)),
            format!("slots must be from 2 to 65536, got {slots}")
        );
    }
    assert_eq!(
        reason(LINE, 0, Table::Direct),
        "tilings must be above 0 and equal to 4, got 0"
    );
    assert_eq!(
        reason(LINE, 5, Table::Direct),
        "tilings must be above 0 and equal to 4, got 5"
    );
    assert_eq!(
        reason([Dimension::bounded(0.0, 1.0, 0)], 4, Table::Direct),
        "intervals must be from 1 to 256, got 0"
    );
    assert_eq!(
        reason([Dimension::bounded(2.0, 1.0, 4)], 4, Table::Direct),
        "an upper bound must be finite and above the lower, got 1"
    );
    assert_eq!(
        reason([Dimension::cyclic(f32::NAN, 1.0, 4)], 4, Table::Direct),
        "a lower bound must be finite, got NaN"
    );
    let none = TileCoder::<1, 0>::new(LINE, &[], Table::Direct, displacement).unwrap_err();
    assert_eq!(
        none.to_string(),
        "tilings must be above 0 and equal to 0, got 0"
    );
    let beyond = TileCoder::<1, 4>::new(LINE, &[Group::new(&[1], 4)], Table::Direct, displacement);
    assert_eq!(
        beyond.unwrap_err().to_string(),
        "a dimension's index must be below 1, got 1"
    );
    let far = TileCoder::<1, 4>::new(LINE, &[Group::new(&[0], 4)], Table::Direct, |_| 1.0);
    assert_eq!(
        far.unwrap_err().to_string(),
        "an offset must be at least 0 and below 1 interval, got 1"
    );
    let wide = [Dimension::bounded(0.0, 1.0, 256); 2];
    let many = TileCoder::<2, 1>::new(wide, &[Group::new(&[0, 1], 1)], Table::Direct, displacement);
    assert_eq!(
        many.unwrap_err().to_string(),
        "tiles of a tiling must be at most 65536, got 66049"
    );
    let wide = [Dimension::cyclic(0.0, 1.0, 256); 2];
    let many = TileCoder::<2, 2>::new(wide, &[Group::new(&[0, 1], 2)], Table::Direct, displacement);
    assert_eq!(
        many.unwrap_err().to_string(),
        "slots must be at most 65536, got 131072"
    );
}

/// A learner that has learnt something.
fn learnt(weights: &mut [[f32; 2]; 32]) -> Vec<u8> {
    let mut agent = agent(weights);
    let mut rng = Pcg32::new(1, 1);
    for n in 0..20 {
        agent.start(&[n as f32 / 20.0], &mut rng);
        agent.end(-1.0 - n as f32);
    }
    agent.save().collect()
}

#[test]
fn saved_weights_are_loaded() {
    let mut weights = [[0.0; 2]; 32];
    let bytes = learnt(&mut weights);
    assert_eq!(bytes.len(), Agent::BYTES);
    assert_eq!(bytes.len(), 16 + 32 * 2 * 4 + 4);
    let mut other = [[0.0; 2]; 32];
    agent(&mut other).load(&bytes).unwrap();
    assert_eq!(weights, other);
    assert!(weights.iter().flatten().filter(|&&w| w != 0.0).count() > 10);
}

#[test]
fn damaged_bytes_are_rejected() {
    let mut weights = [[0.0; 2]; 32];
    let good = learnt(&mut weights);
    let rejected = |bytes: &[u8]| {
        let mut weights = [[0.0; 2]; 32];
        let mut agent = agent(&mut weights);
        let error = agent.load(bytes).expect_err("rejected");
        assert_eq!(agent.weights(), &[[0.0; 2]; 32], "{error}");
        error
    };
    let with = |at: usize, value: u8| {
        let mut bytes = good.clone();
        bytes[at] = value;
        bytes
    };
    assert_eq!(rejected(&[]), LoadError::Magic);
    assert_eq!(rejected(&good[..3]), LoadError::Magic);
    assert_eq!(rejected(&with(0, b'X')), LoadError::Magic);
    let version = rejected(&with(4, 2));
    assert_eq!(version.to_string(), "weights must have version 1, got 2");
    for length in [4, 7, 8, 15, 16, 20, good.len() - 1] {
        let size = rejected(&good[..length]);
        assert_eq!(
            size.to_string(),
            format!("weights must have 276 bytes, got {length}")
        );
    }
    let longer = [&good[..], &[0]].concat();
    assert_eq!(
        rejected(&longer).to_string(),
        "weights must have 276 bytes, got 277"
    );
    assert_eq!(
        rejected(&with(9, 2)).to_string(),
        "weights must have 276 bytes, got 532"
    );
    // Any other byte, in the weights and in the checksum itself.
    for (at, byte) in good.iter().enumerate().skip(16) {
        let error = rejected(&with(at, byte ^ 1));
        assert!(
            matches!(error, LoadError::Checksum { .. }),
            "byte {at}: {error}"
        );
    }
}

/// The weights have the same size, but belong to other tiles.
#[test]
fn weights_of_other_tiles_are_rejected() {
    let mut weights = [[0.0; 2]; 32];
    let good = learnt(&mut weights);
    let wider = coder([Dimension::bounded(0.0, 2.0, 4)], 4, Table::Hashed(32)).unwrap();
    let finer = coder([Dimension::bounded(0.0, 1.0, 5)], 4, Table::Hashed(32)).unwrap();
    let round = coder([Dimension::cyclic(0.0, 1.0, 4)], 4, Table::Hashed(32)).unwrap();
    let smaller = coder(LINE, 4, Table::Hashed(16)).unwrap();
    let moved = TileCoder::new(LINE, &[Group::new(&[0], 4)], Table::Hashed(32), |_| 0.0).unwrap();
    for coder in [wider, finer, round, smaller, moved] {
        let mut weights = [[0.0; 2]; 32];
        let mut agent: Agent = Sarsa::new(coder, SETTINGS, &mut weights).unwrap();
        let error = agent.load(&good).unwrap_err();
        assert!(matches!(error, LoadError::Features { .. }), "{error}");
        assert_eq!(weights, [[0.0; 2]; 32]);
    }
}

/// The checksum is computed after the damage, so it is right.
#[test]
fn weights_that_are_not_finite_are_rejected() {
    let mut weights = [[0.0; 2]; 32];
    let saved = learnt(&mut weights);
    for number in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut bytes = saved.clone();
        bytes[16 + 4 * 5..][..4].copy_from_slice(&number.to_le_bytes());
        let mut untouched = [[0.0; 2]; 32];
        let mut agent = agent(&mut untouched);
        let Err(LoadError::Checksum { expected, .. }) = agent.load(&bytes) else {
            panic!("the checksum matches {number}")
        };
        let end = bytes.len() - 4;
        bytes[end..].copy_from_slice(&expected.to_le_bytes());
        let error = agent.load(&bytes).unwrap_err();
        assert_eq!(error.to_string(), "weight 5 must be a finite number");
        assert_eq!(*agent.weights(), [[0.0; 2]; 32]);
    }
}

#[test]
fn tilings_whose_sum_overflows_are_rejected() {
    let groups = [Group::new(&[0], usize::MAX), Group::new(&[0], 5)];
    let coder = TileCoder::<1, 4>::new(LINE, &groups, Table::Direct, displacement);
    assert_eq!(
        coder.unwrap_err().to_string(),
        format!("tilings must be above 0 and equal to 4, got {}", usize::MAX)
    );
}
