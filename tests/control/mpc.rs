//! Machines swing up and are held, with delays, zeros and parameters that the controller does not
//! know; a broken encoder is found.

use std::f64::consts::TAU;

use acrobot::Params;
use acrobot::control::mpc::{Controller, Replanner, Settings};
use acrobot::numpy::{Pcg64, uniform};
use machine::{Hardware, Machine, Rehearsal};

/// The settings of a machine whose parameters are known.
fn known(hardware: &Hardware) -> Settings {
    Settings {
        params: hardware.params.cast(),
        limit: hardware.limit as f32,
        counts: hardware.counts,
        delay: (hardware.delay + hardware.lag) as f32,
        plan_timeout: f32::INFINITY,
    }
}

fn rehearsal(hardware: Hardware, settings: Settings, slice: u32, seed: u64) -> Rehearsal {
    Rehearsal::new(Machine::new(hardware, seed).unwrap(), settings, slice).unwrap()
}

/// A torque that comes 12 ms late, and acts by 0.9; zeros that are 1 degree off; wrong masses, and
/// no friction in the model.
#[test]
fn a_machine_is_held_with_delay_zeros_and_a_wrong_model() {
    let hardware = Hardware {
        delay: 0.010,
        lag: 0.002,
        zeros: [0.017, -0.017],
        torque_factor: 0.9,
        ..Hardware::realaigym()
    };
    let truth = hardware.params;
    let params = Params {
        mass1: 1.05 * truth.mass1,
        mass2: 0.97 * truth.mass2,
        damping1: 0.0,
        damping2: 0.0,
        coulomb1: 0.0,
        coulomb2: 0.0,
        ..truth
    };
    let settings = Settings { params: params.cast(), ..known(&hardware) };
    for seed in 0..3 {
        let mut rehearsal = rehearsal(hardware, settings, 15, seed);
        assert!(rehearsal.run(7.0, 0.1, 1.0).unwrap().is_some(), "{seed}");
        let mut rng = Pcg64::new(seed);
        rehearsal.machine.push([(); 2].map(|()| uniform(&mut rng, -6.0, 6.0)));
        assert!(rehearsal.run(7.0, 0.1, 1.0).unwrap().is_some(), "{seed}");
        let report = rehearsal.controller.report();
        for (found, zero) in report.zeros.into_iter().zip(hardware.zeros) {
            assert!((f64::from(found) - zero).abs() < 0.006, "{seed}: {found} rad");
        }
        assert!(report.plan_age < 0.3 && report.misses < 5.0, "{seed}: {report:?}");
        // If all forces grow alike, no angle tells.
        let (found, part) = (rehearsal.controller.params(), f64::from(report.torque_factor) / 0.9);
        for (found, truth, within) in [
            (found.mass1, truth.mass1, 0.04),
            (found.mass2, truth.mass2, 0.02),
            (found.coulomb1, truth.coulomb1, 0.1), // a push looks like friction at first
            (found.coulomb2, truth.coulomb2, 0.1),
        ] {
            let error = f64::from(found) / part - truth;
            assert!(error.abs() < within, "{seed}: {found} is not {truth}");
        }
    }
}

/// Frictions at their lower limit, 0, do not make the other parameters wander.
#[test]
fn a_machine_without_friction_is_known() {
    let mut hardware = Hardware::realaigym();
    let params = hardware.params;
    hardware.params =
        Params { damping1: 0.0, damping2: 0.0, coulomb1: 0.0, coulomb2: 0.0, ..params };
    for seed in 2..6 {
        let mut rehearsal = rehearsal(hardware, known(&hardware), 20, seed);
        rehearsal.run(7.0, 0.1, 1.0).unwrap();
        let found = rehearsal.controller.params();
        for (found, truth) in [(found.mass1, params.mass1), (found.mass2, params.mass2)] {
            assert!((f64::from(found) / truth - 1.0).abs() < 0.04, "{seed}: {found} kg");
        }
    }
}

/// An encoder that dies or sticks in motion is found within 0.7 s, from swinging and from upright.
#[test]
fn a_broken_encoder_is_an_error() {
    let hardware = Hardware::realaigym();
    for (after, broken, sticks) in
        [(0.6, 0, false), (0.6, 1, true), (5.0, 0, true), (5.0, 1, false)]
    {
        let mut rehearsal = rehearsal(hardware, known(&hardware), 10, 4);
        rehearsal.run(after, 0.1, 0.0).unwrap();
        rehearsal.machine.push([0.5, 6.0]);
        rehearsal.run(0.2, 0.1, 0.0).unwrap();
        let last = rehearsal.machine.counts()[broken];
        rehearsal.stuck[broken] = Some(if sticks { last } else { 0 });
        let error = rehearsal.run(0.7, 0.1, 0.0);
        assert!(error.is_err(), "after {after} s, encoder {broken}, sticks: {sticks}");
    }
}

/// The estimator alone believes in a link that stands, and in torques that hold it.
#[test]
fn an_encoder_that_does_not_count_while_the_other_joint_turns_is_an_error() {
    let settings = known(&Hardware::realaigym());
    for (first, turn) in [([0, 2000], [0, 1]), ([2000, 0], [1, 0]), ([-7, 2000], [0, -1])] {
        let mut controller = Controller::<100>::new(settings).unwrap();
        let at = |tick: i32| [first[0] + turn[0] * 10 * tick, first[1] + turn[1] * 10 * tick];
        let ticks = (0..200).take_while(|tick| controller.tick(at(*tick)).is_ok()).count() as f64;
        let turned = 10.0 * ticks / 4096.0 * TAU;
        assert!((1.0..2.05).contains(&turned), "{first:?}: {turned} rad");
        let misses = controller.report().misses;
        assert!(misses > 8.0, "{misses}");
    }
    // A count may begin again after a turn.
    let mut controller = Controller::<100>::new(settings).unwrap();
    for count2 in [2047, -2048, 2047] {
        controller.tick([0, count2]).unwrap();
    }
    assert!(controller.report().misses < 1.0);
}

/// Plans come half a second late.
#[test]
fn slow_planning_is_no_error() {
    let hardware = Hardware::realaigym();
    let mut rehearsal = rehearsal(hardware, known(&hardware), 250, 5);
    let torques = (0..2500).map(|_| rehearsal.tick().unwrap().abs());
    let most = torques.fold(0.0, f32::max);
    assert!(most > 2.0 && most <= 6.0, "{most}");
}

#[test]
fn an_old_plan_has_no_torque() {
    let hardware = Hardware::realaigym();
    let settings = Settings { plan_timeout: 0.2, ..known(&hardware) };
    let mut rehearsal = rehearsal(hardware, settings, 10, 6);
    for _ in 0..150 {
        rehearsal.tick().unwrap();
    }
    assert!(rehearsal.controller.report().plan_age < 0.1);
    // The main loop hangs.
    let torques: Vec<f32> = (0..200)
        .map(|_| {
            let torque = rehearsal.controller.tick(rehearsal.machine.counts()).unwrap();
            rehearsal.machine.step(torque);
            torque
        })
        .collect();
    assert!(torques[..50].iter().any(|torque| *torque != 0.0));
    assert!(torques[110..].iter().all(|torque| *torque == 0.0), "{torques:?}");
    assert!((rehearsal.controller.report().plan_age - 0.4).abs() < 0.1);
}

#[test]
fn without_plans_there_is_no_torque() {
    let mut controller = Controller::<100>::new(known(&Hardware::realaigym())).unwrap();
    for counts in [[0, 0], [i32::MIN, i32::MAX], [4096, -4096]] {
        assert_eq!(controller.tick(counts).unwrap(), 0.0);
    }
}

/// From exactly hanging left and right are alike.
#[test]
fn zeroed_encoders_do_not_stop_it() {
    let settings = known(&Hardware::realaigym());
    let mut controller = Controller::<100>::new(settings).unwrap();
    let mut replanner = Replanner::new(settings).unwrap();
    let mut most = 0.0_f32;
    for _ in 0..30 {
        let Ok(torque) = controller.tick([0, 0]) else { break };
        most = most.max(torque.abs());
        replanner.exchange(&mut controller);
        replanner.work();
    }
    assert!(most > 2.0, "{most} N m");
}

#[test]
fn bad_settings_are_rejected() {
    let good = known(&Hardware::realaigym());
    let params = Params { mass1: -1.0, ..good.params };
    // A tick so short that a decision has more than 2³² of them.
    let short = Params { dt: 1e-20, ..good.params };
    assert!(Controller::<100>::new(Settings { params: short, ..good }).is_ok());
    for (bad, rule) in [
        (
            Settings { counts: [4096, 0], ..good },
            "counts must be finite and above 0 for a turn, got 0",
        ),
        (Settings { limit: 0.0, ..good }, "limit must be finite and above 0 N m, got 0"),
        (Settings { params, ..good }, "mass1 must be finite and above 0 kg, got -1"),
        (Settings { delay: -0.5, ..good }, "delay must be finite and at least 0 s, got -0.5"),
        (
            Settings { delay: 0.25, ..good },
            "delay must be at most 14/22 of the machine's time, in s, got 0.25",
        ),
        (Settings { plan_timeout: 0.0, ..good }, "plan_timeout must be above 0 s, got 0"),
    ] {
        assert_eq!(Controller::<100>::new(bad).unwrap_err().to_string(), rule);
    }
}
