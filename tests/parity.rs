//! Promise 1, Gymnasium's numbers: `Host` replays recorded episodes bit for bit.

use acrobot::Portable;
use acrobot::arithmetic::{Arithmetic, Host, Reference};
use acrobot::numpy::{Pcg64, uniform};
use common::{
    Digest, RECORDING, STEPS, assert_says, bits, distance, is_recorded_library, take_recorded_steps,
};

/// The tolerance of a single step with another C library: twice the error of [`Reference`].
const OTHER_LIBRARY: f64 = 1.5e-14;

#[test]
fn host_replays_gymnasium() {
    if !is_recorded_library() {
        return;
    }
    let count = RECORDING.episodes.len();
    assert_eq!(count, 72, "episodes in tests/data/episodes.txt: edit this count");
    let mut goals = 0;
    for (number, episode) in RECORDING.episodes.iter().enumerate() {
        let mut acrobot = episode.start::<Host>();
        let mut observations = Digest::default();
        assert_eq!(
            bits(acrobot.state()),
            bits(episode.states[0]),
            "initial state of episode {number}"
        );
        for (i, &action) in episode.actions.iter().enumerate() {
            let step = acrobot.step(action);
            let context = format!("step {} of episode {number}", i + 1);
            assert_eq!(bits(acrobot.state()), bits(episode.states[i + 1]), "{context}");
            assert_eq!(step.reward, episode.rewards[i], "{context}");
            assert_eq!(step.terminated, episode.terminated[i], "{context}");
            goals += usize::from(step.terminated);
            for x in step.observation {
                observations.add(x.to_bits().into());
            }
        }
        assert_eq!(observations, episode.observations, "observations of episode {number}");
    }
    assert!(goals > 1000, "the recording must reach the goal often, and reaches it {goals} times");
}

fn single_steps<A: Arithmetic<Scalar = f64>>(exact: bool, tolerance: f64) {
    let mut worst = 0.0_f64;
    take_recorded_steps::<A>(|name, _, found, next| {
        if exact {
            assert_eq!(bits(found), bits(next), "{name}");
        }
        let error = distance(found, next);
        worst = worst.max(error);
        assert!(error <= tolerance, "{name}: {error:e}");
    });
    println!("{}: {worst:e}", A::NAME);
}

#[test]
fn host_takes_gymnasiums_single_steps() {
    single_steps::<Host>(is_recorded_library(), OTHER_LIBRARY);
}

/// Another C library can meet the tolerance, because `Reference` does.
#[test]
fn reference_takes_gymnasiums_single_steps_closely() {
    single_steps::<Reference>(false, OTHER_LIBRARY);
}

/// The shares of single steps that an arithmetic repeats bit for bit, under a random and under an
/// energetic policy, in percent.
fn repeated<A: Arithmetic<Scalar = f64>>() -> [f64; 2] {
    // One policy in each half of the first 64 episodes. The last eight begin outside the bounds.
    [0..32, 32..64].map(|episodes| {
        let mut equal = 0;
        for episode in &RECORDING.episodes[episodes] {
            let mut acrobot = episode.start::<A>();
            for (states, &action) in episode.states.windows(2).zip(&episode.actions) {
                acrobot.set_state(states[0]).unwrap();
                acrobot.step(action);
                equal += u32::from(bits(acrobot.state()) == bits(states[1]));
            }
        }
        f64::from(equal) / (32.0 * STEPS as f64) * 100.0
    })
}

/// This measures a table of docs/parity.md. CI measures its row without FMA.
#[test]
fn the_docs_say_how_much_of_gymnasium_is_repeated() {
    let row = |name: &str, [random, energetic]: [f64; 2]| {
        let row = format!("| {name} | {random:.2} % | {energetic:.2} % |");
        println!("{row}");
        row
    };
    let reference = repeated::<Reference>();
    assert!(reference.iter().all(|share| *share >= 99.5));
    let mut rows = vec![row("`Reference`", reference), row("`Portable`", repeated::<Portable>())];
    if is_recorded_library() {
        rows.push(row("`Host`", repeated::<Host>()));
    } else {
        row("`Host` without FMA", repeated::<Host>());
    }
    for row in rows {
        assert_says("docs/parity.md", &row);
    }
}

/// NumPy computes the sines of an initial state with its own `f32` code, and those of later steps
/// with other code.
#[test]
fn initial_observations_are_within_one_ulp() {
    for (number, episode) in RECORDING.episodes.iter().enumerate() {
        let ours = episode.start::<Host>().observation();
        for (x, y) in ours.into_iter().zip(episode.start_observation) {
            let ulps = (i64::from(x.to_bits()) - i64::from(y.to_bits())).abs();
            assert!(ulps <= 1, "episode {number}: {x} and {y} are {ulps} apart");
        }
    }
}

/// `Host` calls C's `pow` only where it can differ from `x * x`. Elsewhere the two are equal.
#[test]
#[expect(clippy::disallowed_methods, reason = "the platform's function")]
fn hosts_square_equals_the_platforms_power() {
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
