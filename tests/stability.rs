//! Promise 2, the same bits everywhere: digests, which the program `bits` compares on other
//! targets. Changing one takes a breaking release.

use acrobot::arithmetic::{Damped, Micro, Reference};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::{Fast, Portable};
use bits::{Digest, episodes, plan, training};

/// Friction and the task are two things: the initial states, rewards and the goal stay Gymnasium's,
/// too.
#[test]
fn a_friction_of_0_changes_no_bit() {
    assert_eq!(episodes::sixteen::<Damped<Reference>>(), episodes::REFERENCE);
    assert_eq!(episodes::sixteen::<Damped<Fast>>(), episodes::FAST);
}

/// `Portable` calls the sines of the crate `libm`, in the version of the build.
#[test]
fn libm_has_the_sines_of_portables_digests() {
    let mut rng = Pcg64::new(0);
    let mut digest = Digest::default();
    for i in 0..1_000_000 {
        let reach = if i % 2 == 0 { 4.0 } else { 1e6 };
        let x = uniform(&mut rng, -reach, reach);
        let (sin, cos) = libm::sincos(x);
        for y in [sin, cos, libm::cos(x)] {
            digest.add(y.to_bits());
        }
    }
    assert_eq!(
        format!("{:016x}", digest.0),
        "30c8c9548cb4f32a",
        "this libm rounds sines differently from 0.2.16, so Portable's bits differ: see \
        docs/determinism.md"
    );
}

#[test]
fn the_shared_episodes_are_stable() {
    let found = [
        episodes::sixteen::<Reference>(),
        episodes::sixteen::<Portable>(),
        episodes::sixteen::<Fast>(),
        episodes::sixteen::<Micro>(),
    ];
    let expected = [episodes::REFERENCE, episodes::PORTABLE, episodes::FAST, episodes::MICRO];
    assert!(found == expected, "{found:#018x?}");
}

#[test]
fn subnormal_numbers_friction_and_other_tasks_are_stable() {
    let found =
        (episodes::subnormal(), episodes::damped(), episodes::swingup(), episodes::balance());
    let expected = (episodes::SUBNORMAL, episodes::DAMPED, episodes::SWINGUP, episodes::BALANCE);
    assert!(found == expected, "{found:#018x?}");
}

/// The program `bits` tries other widths.
#[test]
fn batches_are_stable() {
    let found = episodes::batches::<16, 2, 1>();
    assert!(found == episodes::BATCHES, "{found:#018x?}");
}

#[test]
fn the_shared_training_is_stable() {
    let found = training::weights();
    assert!(found == training::WEIGHTS, "{found:#018x}");
}

/// A plan and its gains, and the states of an acrobot that follows it.
#[test]
fn the_shared_plan_is_stable() {
    let found = plan::planned();
    assert!(found == plan::PLAN, "{found:#018x}");
}
