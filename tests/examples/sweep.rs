//! `sweep` counts every episode once.

use std::fs;

use super::{Folder, command, printed, rejected, run, svg};
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
        acrobot.inner_mut().set_params(params).unwrap();
        let end = loop {
            let against = acrobot.inner().state().dtheta1 > 0.0;
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
    let folder = Folder::new("sweep");
    let (csv, picture) = (folder.file("sweep.csv"), folder.file("sweep.svg"));
    let [one, two] = ["1", "2"].map(|threads| {
        // One of these episodes reaches the goal in its last step.
        let arguments = "--episodes 1800 --seed 7 --masses 0.1,1.5 --torques 0.001,0.1,0.3";
        let mut arguments: Vec<&str> = arguments.split(' ').collect();
        arguments.extend(["--csv", &csv, "--picture", &picture]);
        let mut sweep = command("sweep", &arguments);
        let output = sweep.env("RAYON_NUM_THREADS", threads).output().unwrap();
        assert!(printed(output).contains("1800 episodes"));
        (fs::read_to_string(&csv).unwrap(), svg(&picture))
    });
    assert!(one == two, "the number of threads changes a byte");

    let mut rows = one.0.lines();
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

/// The command beside the README's heat map draws it.
#[test]
#[cfg_attr(
    debug_assertions,
    ignore = "a million episodes, which need optimization"
)]
fn the_sweep_is_the_readmes_picture() {
    let folder = Folder::new("heat-map");
    let (csv, picture) = (folder.file("sweep.csv"), folder.file("sweep.svg"));
    printed(run("sweep", &["--csv", &csv, "--picture", &picture], ""));
    assert!(
        fs::read(&picture).unwrap() == include_bytes!("../../examples/sweep.svg"),
        "examples/sweep.svg differs"
    );
}

#[test]
fn the_sweep_rejects_before_it_writes() {
    let folder = Folder::new("rejected-sweep");
    let (csv, picture) = (folder.file("sweep.csv"), folder.file("sweep.svg"));
    let missing = folder.file("none/sweep.csv");
    for (option, value, reason) in [
        (
            "--episodes",
            "1001",
            "--episodes must be a multiple of the grid's 400 cells, from 400 to 400000000, got 1001",
        ),
        ("--episodes", "0", "from 400 to 400000000, got 0"),
        ("--episodes", "400000400", "to 400000000, got 400000400"),
        ("--episodes", "-400", "invalid value '-400' for '--episodes"),
        (
            "--seed",
            "-1",
            "seed must be a decimal integer of at least 0, got '-' as character 1",
        ),
        (
            "--masses",
            "1,0",
            "invalid value '0' for '--masses <KG>': must be finite and above 0 kg in f32",
        ),
        ("--masses", "", "must be finite and above 0 kg"),
        ("--masses", "nan", "must be finite and above 0 kg"),
        ("--masses", "1e-60", "must be finite and above 0 kg"),
        (
            "--torques",
            "inf,1",
            "invalid value 'inf' for '--torques <N_M>': must be finite and above 0 N m in f32",
        ),
        ("--torques", "-1", "must be finite and above 0 N m"),
        (
            "--csv",
            &missing,
            "must be a name that ends in .csv, in an existing folder",
        ),
        ("--csv", &picture, "must be a name that ends in .csv"),
        (
            "--picture",
            &csv,
            "must be a name that ends in .svg, in an existing folder",
        ),
    ] {
        let mut arguments = vec![option, value];
        for (other, valid) in [
            ("--episodes", "400"),
            ("--csv", &csv),
            ("--picture", &picture),
        ] {
            if other != option {
                arguments.extend([other, valid]);
            }
        }
        let errors = rejected("sweep", &arguments, "");
        assert!(errors.contains(reason), "{errors}");
        assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 0, "{arguments:?}");
    }
}
