//! `sweep` counts every episode once.

use super::{Folder, printed};
use acrobot::numpy::SeedSequence;
use acrobot::{Acrobot, Action, Fast, Params, TimeLimit};

/// The row of a cell, from episodes of single acrobots.
fn sweep_row(seed: u64, episodes: u64, mass: f32, torque: f32) -> String {
    let (mut reached, mut steps) = (0_u64, 0_u64);
    for seed in SeedSequence::new(seed).spawn(episodes) {
        let mut acrobot = TimeLimit::v1(Acrobot::<Fast>::with_rng(seed.into()));
        let params = Params {
            mass1: mass,
            mass2: mass,
            torques: [-torque, 0.0, torque],
            ..Params::default()
        };
        acrobot.set_params(params).unwrap();
        let end = loop {
            let against = acrobot.state().dtheta1 > 0.0;
            let step = acrobot.step(if against {
                Action::Negative
            } else {
                Action::Positive
            });
            if step.done() {
                break step;
            }
        };
        if end.terminated {
            reached += 1;
            steps += u64::from(acrobot.elapsed());
        }
    }
    let share = reached as f64 / episodes as f64;
    let mean = match reached {
        0 => String::new(),
        _ => format!("{:.3}", steps as f64 / reached as f64),
    };
    format!("{mass},{torque},{episodes},{reached},{share:.4},{steps},{mean}")
}

#[test]
fn the_sweep_counts_every_episode_once() {
    let folder = Folder::new();
    let [one, two] = ["1", "2"].map(|threads| {
        // One of these episodes reaches the goal in its last step.
        let line = "sweep --episodes 1800 --seed 7 --masses 0.1,1.5 --torques 0.001,0.1,0.3";
        let text = printed(folder.command(line).env("RAYON_NUM_THREADS", threads));
        assert!(text.contains("1800 episodes"));
        (folder.read("sweep.csv"), folder.svg("sweep.svg"))
    });
    assert!(one == two, "the number of threads changes a byte");

    let csv = String::from_utf8(one.0).unwrap();
    let mut rows = csv.lines();
    assert_eq!(
        rows.next().unwrap(),
        "mass_kg,torque_n_m,episodes,reached,share,steps_of_reached,mean_steps_of_reached"
    );
    let mut shares = Vec::new();
    for mass in [0.1, 1.5] {
        for torque in [0.001, 0.1, 0.3] {
            let row = rows.next().unwrap();
            assert_eq!(row, sweep_row(7, 300, mass, torque));
            shares.push(row.split(',').nth(4).unwrap().parse::<f64>().unwrap());
        }
    }
    assert_eq!(rows.next(), None);
    assert!(
        [0.0, 1.0].iter().all(|share| shares.contains(share))
            && shares.iter().any(|&share| 0.0 < share && share < 1.0),
        "cells in which none, some and all reach the goal: {shares:?}"
    );
}

/// The command of docs/benchmarks.md draws the committed heat map.
#[test]
#[cfg_attr(
    debug_assertions,
    ignore = "a million episodes, which need optimization"
)]
fn the_sweep_equals_the_readmes_picture() {
    let folder = Folder::new();
    printed(&mut folder.command("sweep"));
    let recorded = include_bytes!("../../examples/sweep.svg");
    assert!(
        folder.read("sweep.svg") == recorded,
        "examples/sweep.svg differs"
    );
}
