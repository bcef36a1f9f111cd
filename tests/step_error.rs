//! Promise 1, Gymnasium's numbers: the error of `Portable`, `Fast` and `Micro` against them.

use std::f64::consts::PI;

use acrobot::arithmetic::{Arithmetic, Micro};
use acrobot::{Fast, Portable};
use common::{RECORDING, assert_says, distance, take_recorded_steps};

/// Upper ends of the bands of max(|θ̇1|, |θ̇2|) before a step, rad/s. The last band has all
/// remaining steps: up to the velocity bounds, and from the few initial states beyond them.
const BANDS: [f64; 5] = [3.0, 6.0, 12.0, 20.0, f64::INFINITY];

/// The promised error of a step in the slowest band: about ten roundings of numbers near 3, in
/// `f64` and in `f32`.
const PORTABLE_SLOW: f64 = 4e-15;
const FAST_SLOW: f64 = 4e-6;

/// The errors of single steps, each from Gymnasium's state, by band and sorted.
fn step_errors<A: Arithmetic>() -> [Vec<f64>; 5] {
    let mut errors = [const { Vec::new() }; 5];
    take_recorded_steps::<A>(|name, state, found, next| {
        // Single steps from angles of many turns test `wrap` only, because `f32` cannot represent
        // such a state.
        if name.starts_with("single") && state.theta1.abs().max(state.theta2.abs()) > PI {
            return;
        }
        let speed = state.dtheta1.abs().max(state.dtheta2.abs());
        let band = BANDS.iter().position(|&end| speed <= end).unwrap();
        errors[band].push(distance(found.cast(), next));
    });
    for band in &mut errors {
        band.sort_by(f64::total_cmp);
    }
    errors
}

#[test]
fn single_steps_are_as_close_as_the_docs_say() {
    let errors = [step_errors::<Portable>(), step_errors::<Fast>(), step_errors::<Micro>()];
    let largest = |sorted: &[f64]| sorted[sorted.len() - 1];
    assert!(largest(&errors[0][0]) <= PORTABLE_SLOW);
    assert!(largest(&errors[1][0]) <= FAST_SLOW);

    let names = ["up to 3", "3 to 6", "6 to 12", "12 to 20", "beyond"];
    let rows = names.iter().enumerate().map(|(band, name)| {
        let cells = errors.each_ref().map(|arithmetic| {
            let sorted = &arithmetic[band];
            // The 99.9th percentile and the maximum.
            format!("{:.1e}, {:.1e}", sorted[sorted.len() * 999 / 1000], largest(sorted))
        });
        format!("| {name} | {} | {} |", errors[0][band].len(), cells.join(" | "))
    });
    assert_says("docs/parity.md", &rows.collect::<Vec<_>>().join("\n"));
}

#[test]
fn whole_episodes_stay_as_close_as_the_docs_say() {
    let after = [100, 200, 500];
    let mut close = [0; 3];
    for episode in &RECORDING.episodes {
        let mut acrobot = episode.start::<Portable>();
        let mut worst = 0.0_f64;
        for (i, &action) in episode.actions.iter().enumerate() {
            acrobot.step(action);
            worst = worst.max(distance(acrobot.state(), episode.states[i + 1]));
            for (n, close) in after.into_iter().zip(&mut close) {
                *close += u32::from(i + 1 == n && worst <= 1e-6);
            }
        }
    }
    let all = RECORDING.episodes.len();
    assert_eq!(close[0], all as u32);
    assert_says(
        "docs/parity.md",
        &format!("all {all} after 100 steps, {} after 200 and {} after 500", close[1], close[2]),
    );
}
