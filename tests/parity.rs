//! Promise 1, Gymnasium's numbers: `Host` replays recorded episodes bit for bit.

mod common;

use std::f64::consts::FRAC_PI_2;

use acrobot::arithmetic::{Arithmetic, Host};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::Gymnasium;
use acrobot::{Acrobot, Portable, State};
use common::{Digest, RECORDING, distance, is_recorded_library, recorded_steps};

/// With another C library each step from Gymnasium's state is at most this far off: twice what [`Libm`] needs.
const OTHER_LIBRARY: f64 = 4e-14;

/// The same for `Portable`, which does not round x − π/2. It is larger because angles can be dozens of turns.
const OTHER_SINES: f64 = 2.4e-13;

/// Gymnasium's order with the sines of `libm`, in place of another C library.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Libm;

impl Arithmetic for Libm {
    const NAME: &'static str = "libm";
    type Scalar = f64;
    type Form = Gymnasium;

    fn sin_cos(x: f64) -> (f64, f64) {
        libm::sincos(x)
    }

    fn cos_from_horizontal(x: f64, _: Option<f64>) -> f64 {
        libm::cos(x - FRAC_PI_2)
    }
}

fn bits(state: State) -> [u64; 4] {
    <[f64; 4]>::from(state).map(f64::to_bits)
}

#[test]
fn host_replays_gymnasium() {
    if !is_recorded_library() {
        return;
    }
    assert_eq!(RECORDING.episodes.len(), 72);
    let mut goals = 0;
    for (number, episode) in RECORDING.episodes.iter().enumerate() {
        let mut acrobot = episode.start::<Host>();
        let mut observations = Digest::new();
        assert_eq!(
            bits(acrobot.state()),
            bits(episode.states[0]),
            "initial state of episode {number}"
        );
        for (i, &action) in episode.actions.iter().enumerate() {
            let step = acrobot.step(action);
            let context = format!("step {} of episode {number}", i + 1);
            assert_eq!(
                bits(acrobot.state()),
                bits(episode.states[i + 1]),
                "{context}"
            );
            assert_eq!(step.reward, episode.rewards[i], "{context}");
            assert_eq!(step.terminated, episode.terminated[i], "{context}");
            goals += usize::from(step.terminated);
            for x in step.observation.to_array() {
                observations.add(x.to_bits().into());
            }
        }
        assert_eq!(
            observations, episode.observations,
            "observations of episode {number}"
        );
    }
    assert!(
        goals > 1000,
        "the recording should reach the goal often, and did {goals} times"
    );
}

/// Single steps with other parameters from states anywhere within the bounds, and from each state of the episodes.
fn single_steps<A: Arithmetic<Scalar = f64>>(exact: bool, tolerance: f64) {
    let check = |acrobot: &Acrobot<A>, next: State, context: &str| {
        if exact {
            assert_eq!(bits(acrobot.state()), bits(next), "{context}");
        }
        let error = distance(acrobot.state(), next);
        assert!(error <= tolerance, "{context}: {error:e}");
    };
    let steps = recorded_steps();
    assert_eq!(steps.len(), 2600);
    for (number, step) in steps.into_iter().enumerate() {
        let mut acrobot = Acrobot::new(0);
        acrobot.set_params(step.params).unwrap();
        acrobot.set_state(step.state).unwrap();
        acrobot.step(step.action);
        check(&acrobot, step.next, &format!("single step {number}"));
    }
    for (number, episode) in RECORDING.episodes.iter().enumerate() {
        let mut acrobot = episode.start();
        for (i, &action) in episode.actions.iter().enumerate() {
            acrobot.set_state(episode.states[i]).unwrap();
            acrobot.step(action);
            let context = format!("step {} of episode {number}", i + 1);
            check(&acrobot, episode.states[i + 1], &context);
        }
    }
}

#[test]
fn host_takes_gymnasiums_single_steps() {
    single_steps::<Host>(is_recorded_library(), OTHER_LIBRARY);
}

/// Another C library can meet its tolerance.
#[test]
fn another_library_takes_them_closely() {
    single_steps::<Libm>(false, OTHER_LIBRARY);
    single_steps::<Portable>(false, OTHER_SINES);
}

/// NumPy computes the sines of an initial state with its own `f32` code, and those of later steps with other code.
#[test]
fn initial_observations_are_within_one_ulp() {
    for (number, episode) in RECORDING.episodes.iter().enumerate() {
        let ours = episode.start::<Host>().observation().to_array();
        for (x, y) in ours.into_iter().zip(episode.start_observation) {
            let ulps = (i64::from(x.to_bits()) - i64::from(y.to_bits())).abs();
            assert!(ulps <= 1, "episode {number}: {x} and {y} are {ulps} apart");
        }
    }
}

/// `Host` calls C's `pow` only where it can differ from `x * x`. Elsewhere the two are equal.
#[test]
#[expect(clippy::disallowed_methods, reason = "the platform's function")]
fn hosts_square_is_the_platforms_power() {
    let two = std::hint::black_box(2.0);
    let mut rng = Pcg64::new(5);
    let mut differs = 0;
    for i in 0..3_000_000 {
        let size = if i % 10 == 0 { 300.0 } else { 3.0 };
        let x = uniform(&mut rng, -1.0, 1.0) * 10_f64.powf(uniform(&mut rng, -size, size));
        let power = x.powf(two);
        assert_eq!(Host::square(x).to_bits(), power.to_bits(), "{x:e}");
        differs += u32::from(power != x * x);
    }
    println!("{differs} of 3,000,000 powers differ from the product");
    for x in [0.0, -0.0, 1e-160, 5e-324, 1e160, f64::MAX, f64::INFINITY] {
        assert_eq!(Host::square(x).to_bits(), x.powf(two).to_bits(), "{x:e}");
    }
    assert!(Host::square(f64::NAN).is_nan());
}
