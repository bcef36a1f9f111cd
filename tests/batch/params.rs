//! Steps of batches in which each acrobot has its own parameters.

use acrobot::arithmetic::{Arithmetic, Host, Micro, Real, Reference};
use acrobot::batch::{Autoreset, VecBatch};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::{Dynamics, ResetBounds};
use acrobot::{Error, Fast, Params, Portable, ResetOptions};
use common::params_range;

use common::twins::{LEVELS, MODES, Twins};

/// Every other acrobot has the equations of the 1996 paper, and a third has no noise.
#[test]
fn every_arithmetic_and_mode_equals_single_acrobots() {
    fn play<A: Arithmetic>() {
        for level in LEVELS {
            for autoreset in MODES {
                let mut twins = Twins::<A>::with_own_params(37, autoreset);
                twins.batch.set_simd_level(level);
                twins.swing(50); // the default parameters
                let mut rng = Pcg64::new(5);
                let draw = |i: usize| {
                    let dynamics = [Dynamics::Book, Dynamics::Nips][i % 2];
                    let mut params = params_range(dynamics).draw(&mut rng);
                    if i.is_multiple_of(3) {
                        params.torque_noise = A::Scalar::ZERO;
                    }
                    params
                };
                let drawn: Vec<_> = (0..37).map(draw).collect();
                twins.set_params_of_each(&drawn);
                twins.swing(600);
                // Later resets keep these parameters.
                twins.reset(ResetOptions::default());
                twins.swing(50);
            }
        }
    }
    play::<Fast>();
    play::<Micro>();
    play::<Portable>();
    play::<Reference>();
    play::<Host>();
}

/// A reset seeds first, then draws the parameters, then the initial state. So do those within a step, and those that are
/// pending when the mode becomes `SameStep`.
#[test]
fn resets_that_draw_parameters_equal_those_of_single_acrobots() {
    let bounds = Some(ResetBounds::new(0.5, 0.6).unwrap());
    for autoreset in MODES {
        let mut twins = Twins::<Fast, 3>::with_own_params(37, autoreset);
        let range = params_range(Dynamics::Nips);
        twins.batch.set_params_range(Some(range)).unwrap();
        for seed in [Some(SeedSequence::new(7)), None] {
            twins.reset(ResetOptions { seed, bounds });
            twins.swing(300);
        }
    }
    let mut twins = Twins::<Fast>::with_own_params(37, Autoreset::NextStep);
    let range = params_range(Dynamics::Book);
    twins.batch.set_params_range(Some(range)).unwrap();
    twins.swing_until_pending();
    twins.batch.set_autoreset(Autoreset::SameStep);
    twins.reset_pending();
    // Without a range, resets keep the last draws.
    twins.batch.set_params_range(None).unwrap();
    twins.swing(300);
}

/// In both kinds `set_params` sets the parameters of all, also of those that had others.
#[test]
fn equal_parameters_equal_shared_ones() {
    let mut own = VecBatch::<Fast>::with_own_params(SeedSequence::new(3), 100).unwrap();
    let mut shared = VecBatch::<Fast>::new(SeedSequence::new(3), 100).unwrap();
    for dynamics in [Dynamics::Nips, Dynamics::Book] {
        let params = params_range(dynamics).draw(&mut Pcg64::new(1));
        shared.set_params(params).unwrap();
        if dynamics == Dynamics::Book {
            own.set_params(params).unwrap();
        } else {
            (0..100).for_each(|i| own.set_params_of(i, params).unwrap());
        }
        for i in 0..100 {
            assert_eq!(own.params_of(i), Some(params));
            assert_eq!(shared.params_of(i), Some(params));
        }
        for step in 0..600 {
            let actions = [step as u8 / 7 % 3; 100];
            assert_eq!(own.step(&actions).unwrap(), shared.step(&actions).unwrap());
        }
    }
}

#[test]
fn a_rejected_call_changes_nothing() {
    let shared = "a batch must have memory for the parameters of each acrobot";
    let seed = SeedSequence::new(3);
    let params = Params {
        mass1: 2.0,
        ..Params::DEFAULT
    };
    let negative = Params {
        mass1: -1.0,
        ..params
    };
    let range = params_range(Dynamics::Book);
    for (mut batch, in_shared) in [
        (VecBatch::<Fast>::new(seed.clone(), 20).unwrap(), true),
        (VecBatch::with_own_params(seed, 20).unwrap(), false),
    ] {
        let rejects = |result: Result<(), Error>, message| {
            assert_eq!(result.unwrap_err().to_string(), message);
        };
        let below = "member index must be below 20, got 20";
        rejects(batch.set_params_of(20, params), below);
        let positive = "mass1 must be finite and above 0 kg, got -1";
        rejects(batch.set_params_of(0, negative), positive);
        rejects(batch.set_params(negative), positive);
        let actions = "actions must have 20 elements, got 19";
        rejects(batch.step(&[1_u8; 19]).map(drop), actions);
        if in_shared {
            let member = batch.member(0).unwrap();
            let other = acrobot::batch::Member { params, ..member };
            rejects(batch.set_params_of(0, params), shared);
            rejects(batch.set_member(0, other), shared);
            rejects(batch.set_params_range(Some(range)), shared);
            batch.set_params_range(None).unwrap();
        }
        assert!((0..20).all(|i| batch.params_of(i) == Some(Params::DEFAULT)));
        assert_eq!(batch.params_range(), None);
        assert_eq!((batch.params_of(20), batch.elapsed(20)), (None, None));
    }
}
