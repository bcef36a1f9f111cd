//! Compares the bits of one target with the recorded digests. Exits with status 0 if all are equal:
//!
//! ```text
//! cargo run --release -p bits
//! cargo run --release -p bits --target thumbv7em-none-eabihf     # in QEMU
//! cargo run --release -p bits --target wasm32-wasip1             # in Node
//! ```

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
use std::process;

use acrobot::arithmetic::{Arithmetic, Micro, Reference};
use acrobot::{Fast, Portable};
use bits::{episodes, training};
#[cfg(target_os = "none")]
use semihosting::{println, process};
// Linked because it is named.
#[cfg(feature = "soft-floats")]
use soft_floats as _;

#[cfg_attr(all(target_os = "none", target_arch = "arm"), cortex_m_rt::entry)]
#[cfg_attr(all(target_os = "none", not(target_arch = "arm")), riscv_rt::entry)]
fn main() -> ! {
    let equal = [
        check::<Reference>(&episodes::REFERENCE),
        check::<Portable>(&episodes::PORTABLE),
        check::<Fast>(&episodes::FAST),
        check::<Micro>(&episodes::MICRO),
        report(
            "subnormal numbers",
            episodes::subnormal() == episodes::SUBNORMAL,
        ),
        report(
            "subnormal numbers in a batch of 4 lanes",
            episodes::subnormal_batch::<4, 5>() == episodes::SUBNORMAL_BATCH,
        ),
        report("friction", episodes::damped() == episodes::DAMPED),
        report("swing-up", episodes::swingup() == episodes::SWINGUP),
        report(
            "batch of 1 lane",
            episodes::shared_params::<1, 20>() == episodes::SHARED_PARAMS,
        ),
        report(
            "batch of 4 lanes",
            episodes::shared_params::<4, 5>() == episodes::SHARED_PARAMS,
        ),
        report(
            "batch of 16 lanes",
            episodes::shared_params::<16, 2>() == episodes::SHARED_PARAMS,
        ),
        report(
            "batch of 4 lanes with own parameters",
            episodes::own_params::<4, 2>() == episodes::OWN_PARAMS,
        ),
        // The learner and the stack do not fit into 16 KiB of RAM. The firmware `learn` compares them.
        cfg!(target_os = "none") || report("training", training::weights() == training::WEIGHTS),
    ];
    process::exit(if equal == [true; 13] { 0 } else { 1 })
}

fn check<A: Arithmetic>(expected: &[u64; 16]) -> bool {
    let equal = episodes::equal::<A>(expected);
    println!("{}: {equal} of 16 episodes are bit-identical", A::NAME);
    equal == 16
}

fn report(name: &str, equal: bool) -> bool {
    println!(
        "{name}: {}",
        if equal { "bit-identical" } else { "differs" }
    );
    equal
}
