//! Promise 2, the same bits everywhere: digests, which the program `bits` compares on other
//! targets. Changing one takes a breaking release.

use acrobot::Fast;
use acrobot::arithmetic::{Damped, Reference};
use acrobot::numpy::{Pcg64, uniform};
use bits::{Digest, episodes};

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

/// Of arithmetics, friction, tasks, batches, a training and a plan.
#[test]
fn the_shared_digests_are_stable() {
    bits::compare(|name, found, expected| assert!(found == expected, "{name}: {found:#018x?}"));
}
