//! Promise 2, the same bits everywhere: digests of long runs. Changing one takes a breaking
//! release.

use acrobot::arithmetic::{Arithmetic, Damped, Micro, Real, Reference};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::Viscous;
use acrobot::{Acrobot, Action, Fast, Params, Portable, TimeLimit};
use bits::{Digest, balance, episodes, plan, training};

/// Every bit of the states, rewards and ends of random episodes with 64 seeds: about 100,000 steps.
fn digest<A: Arithmetic>(friction: Viscous<A::Scalar>) -> u64 {
    let mut digest = Digest::default();
    for seed in 0..64 {
        let params = Params { friction, ..Params::default() };
        let mut acrobot = TimeLimit::v1(Acrobot::<A>::with_params(seed, params).unwrap());
        let mut actions = Pcg64::new(seed);
        for _ in 0..3 {
            loop {
                let step = acrobot.step(Action::sample(&mut actions));
                episodes::add_seen(&mut digest, acrobot.inner(), step.observation);
                digest.add(
                    u64::from(step.reward.to_bits()) << 2
                        | u64::from(step.terminated) << 1
                        | u64::from(step.truncated),
                );
                if step.done() {
                    break;
                }
            }
            acrobot.reset();
        }
    }
    digest.0
}

fn damped<S: Real>() -> Viscous<S> {
    Viscous { joint1: S::from_f64(0.1), joint2: S::from_f64(0.05) }
}

#[test]
fn random_episodes_are_stable() {
    let found = [
        digest::<Reference>(Viscous::default()),
        digest::<Portable>(Viscous::default()),
        digest::<Fast>(Viscous::default()),
        digest::<Micro>(Viscous::default()),
    ];
    let expected = [
        0xd780_4061_b62e_8634,
        0x4c12_affb_6a85_0a1f,
        0x365b_8ce2_6c2b_114a,
        0x2b57_13d8_75b4_e5db,
    ];
    assert!(found == expected, "{found:#018x?}");

    let found = [
        digest::<Damped<Reference>>(damped()),
        digest::<Damped<Portable>>(damped()),
        digest::<Damped<Fast>>(damped()),
        digest::<Damped<Micro>>(damped()),
    ];
    let expected = [
        0x1682_6198_c856_23fb,
        0xdcd6_db2c_54dd_03bb,
        0xf2df_d1ad_10ab_8b1d,
        0x18d0_99fd_24fa_c2d7,
    ];
    assert!(found == expected, "with friction: {found:#018x?}");
}

/// Friction and the task are two things: the initial states, rewards and the goal stay Gymnasium's,
/// too.
#[test]
fn a_friction_of_0_changes_no_bit() {
    let damped = digest::<Damped<Reference>>(Viscous::default());
    assert_eq!(damped, digest::<Reference>(Viscous::default()));
    let damped = digest::<Damped<Fast>>(Viscous::default());
    assert_eq!(damped, digest::<Fast>(Viscous::default()));
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

/// The program `bits` compares the same episodes on other targets.
fn check_episodes<A: Arithmetic>(expected: [u64; 16]) {
    let found: Vec<u64> = (0..16).map(episodes::digest::<A>).collect();
    assert!(found == expected, "{:?}: {found:#018x?}", A::default());
}

#[test]
fn the_shared_episodes_are_stable() {
    check_episodes::<Reference>(episodes::REFERENCE);
    check_episodes::<Portable>(episodes::PORTABLE);
    check_episodes::<Fast>(episodes::FAST);
    check_episodes::<Micro>(episodes::MICRO);
}

#[test]
fn subnormal_numbers_friction_and_the_swing_up_are_stable() {
    let found = (episodes::subnormal(), episodes::damped(), episodes::swingup());
    let expected = (episodes::SUBNORMAL, episodes::DAMPED, episodes::SWINGUP);
    assert!(found == expected, "{found:#018x?}");
}

#[test]
fn a_users_task_is_stable() {
    assert!(balance::digest() == balance::DIGEST, "{:#018x}", balance::digest());
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
