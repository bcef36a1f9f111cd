//! What depends on the versions of dependencies, and a program that a user of the crate writes.

#![cfg(test)]

use acrobot::Portable;
use acrobot::arithmetic::Arithmetic;
use acrobot::env::{Env, Space, make};
use acrobot::numpy::{Pcg64, uniform};

/// Here libm is the newest version that the crate allows. `Portable` calls its sines.
#[test]
fn the_newest_libm_has_the_sines_of_portables_recorded_bits() {
    let mut rng = Pcg64::new(0);
    let mut digest = 0xcbf2_9ce4_8422_2325_u64;
    for _ in 0..1_000_000 {
        let (sin, cos) = Portable::sin_cos(uniform(&mut rng, -100.0, 100.0));
        for y in [sin, cos] {
            digest = (digest ^ y.to_bits()).wrapping_mul(0x100_0000_01b3);
        }
    }
    assert_eq!(
        digest, 0xb387_b2f4_253a_40a4,
        "{digest:#018x}: see docs/determinism.md"
    );
}

/// An agent plays Gymnasium's environment.
#[test]
fn an_agent_plays_by_id() {
    let mut env = make("Acrobot-v1").unwrap();
    let mut rng = Pcg64::new(42);
    env.reset_with_seed(42);
    let mut total = 0.0;
    loop {
        let step = env.step(env.action_space().sample(&mut rng));
        total += step.reward;
        if step.done() {
            break;
        }
    }
    assert!(total >= -500.0);
}
