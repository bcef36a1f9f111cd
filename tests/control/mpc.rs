//! A machine whose friction the controller does not know swings up, is held, and survives pushes.

use acrobot::arithmetic::Damped;

use acrobot::control::mpc::{Controller, Replanner, Settings};
use acrobot::{Error, Params, Portable};
use machine::{Machine, realaigym};

const COUNTS: [i32; 2] = [4096, 4096];

fn settings(params: Params) -> Settings {
    Settings { params: params.cast(), limit: 6.0, counts: COUNTS, ticks: 5 }
}

/// The settings of a machine whose parameters are known.
fn known() -> Settings {
    settings(realaigym())
}

/// Controls a machine by a model for 5 s, and for 5 s after a push, with slices of so many ticks.
/// Returns the largest lean in the last second before the push and before the end, rad, the largest
/// torque, and the controller.
fn control(
    seed: u64,
    model: impl Fn(Params) -> Params,
    slice: u32,
) -> Result<([f64; 2], f32, Controller<100>), Error> {
    let mut machine = Machine::<Damped<Portable>>::new(realaigym(), COUNTS, 0, 0.02, seed)?;
    let settings = settings(model(machine.params()));
    let mut controller = Controller::new(settings)?;
    let mut replanner = Replanner::new(settings)?;
    let (mut leans, mut most) = ([0.0_f64; 2], 0.0_f32);
    for lean in &mut leans {
        for tick in 0..2500 {
            let torque = controller.tick(machine.counts())?;
            assert!(torque.abs() <= 6.0);
            most = most.max(torque.abs());
            if tick % slice == 0 {
                replanner.exchange(&mut controller);
                replanner.work();
            }
            machine.step(torque)?;
            if tick >= 2000 {
                *lean = lean.max(machine.lean());
            }
        }
        machine.push(6.0)?;
    }
    Ok((leans, most, controller))
}

#[test]
fn a_machine_is_held_without_friction_in_the_model_and_with_wrong_masses() {
    let wrong = |truth: Params| Params {
        mass1: 1.05 * truth.mass1,
        mass2: 0.97 * truth.mass2,
        damping1: 0.0,
        damping2: 0.0,
        coulomb1: 0.0,
        coulomb2: 0.0,
        ..truth
    };
    for seed in 0..3 {
        let (leans, _, controller) = control(seed, wrong, 15).unwrap();
        assert!(leans.iter().all(|lean| *lean < 0.1), "{seed}: {leans:?}");
        let Params { coulomb1, coulomb2, .. } = *controller.params();
        let errors = [coulomb1 - 0.16, coulomb2 - 0.12];
        assert!(errors.iter().all(|error| error.abs() < 0.05), "{seed}: {errors:?} N m");
    }
}

/// Plans come half a second late.
#[test]
fn slow_planning_is_no_error() {
    let (_, most, _) = control(5, |truth| truth, 250).unwrap();
    assert!(most > 2.0, "{most}");
}

#[test]
fn without_plans_there_is_no_torque() {
    let mut controller = Controller::<100>::new(known()).unwrap();
    for counts in [[0, 0], [i32::MIN, i32::MAX], [4096, -4096]] {
        assert_eq!(controller.tick(counts).unwrap(), 0.0);
    }
}

/// From exactly hanging left and right are alike.
#[test]
fn zeroed_encoders_do_not_stop_it() {
    let mut controller = Controller::<100>::new(known()).unwrap();
    let mut replanner = Replanner::new(known()).unwrap();
    let mut most = 0.0_f32;
    for _ in 0..100 {
        most = most.max(controller.tick([0, 0]).unwrap().abs());
        replanner.exchange(&mut controller);
        replanner.work();
    }
    assert!(most > 2.0, "{most} N m");
}

#[test]
fn bad_settings_are_rejected() {
    let good = known();
    let params = Params { mass1: -1.0, ..good.params };
    for (bad, rule) in [
        (
            Settings { counts: [4096, 0], ..good },
            "counts must be finite and above 0 for a turn, got 0",
        ),
        (Settings { limit: 0.0, ..good }, "limit must be finite and above 0 N m, got 0"),
        (Settings { ticks: 0, ..good }, "ticks must be finite and above 0 for a decision, got 0"),
        (Settings { params, ..good }, "mass1 must be finite and above 0 kg, got -1"),
    ] {
        assert_eq!(Controller::<100>::new(bad).unwrap_err().to_string(), rule);
    }
}
