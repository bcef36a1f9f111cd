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

use acrobot::arithmetic::{Micro, Reference};
use acrobot::{Fast, Portable};
use bits::episodes::*;
use bits::{plan, training};
#[cfg(target_os = "none")]
use semihosting::{println, process};
// Linked because it is named.
#[cfg(feature = "soft-floats")]
use soft_floats as _;

#[cfg_attr(all(target_os = "none", target_arch = "arm"), cortex_m_rt::entry)]
#[cfg_attr(all(target_os = "none", not(target_arch = "arm")), riscv_rt::entry)]
fn main() -> ! {
    let equal = [
        report("Reference", &[sixteen::<Reference>()], &[REFERENCE]),
        report("Portable", &[sixteen::<Portable>()], &[PORTABLE]),
        report("Fast", &[sixteen::<Fast>()], &[FAST]),
        report("Micro", &[sixteen::<Micro>()], &[MICRO]),
        report("subnormal numbers", &subnormal(), &SUBNORMAL),
        report("friction", &damped(), &DAMPED),
        report("swing-up", &swingup(), &SWINGUP),
        report("balance", &balance(), &BALANCE),
        report("batches of 1 lane", &batches::<1, 20, 8>(), &BATCHES),
        report("batches of 4 lanes", &batches::<4, 5, 2>(), &BATCHES),
        // More of them do not fit into 256 KiB of flash.
        report("batch of 8 lanes", &[shared_params::<8, 3>()], &BATCHES[..1]),
        // The learner and the plan do not fit into 16 KiB of RAM. The
        // firmware `learn` and `balance` compare them.
        cfg!(target_os = "none")
            || report("training", &[training::weights()], &[training::WEIGHTS]),
        cfg!(target_os = "none") || report("plan", &[plan::planned()], &[plan::PLAN]),
    ];
    process::exit(if equal == [true; 13] { 0 } else { 1 })
}

fn report(name: &str, found: &[u64], expected: &[u64]) -> bool {
    let equal = found == expected;
    println!("{name}: {}", if equal { "bit-identical" } else { "differs" });
    equal
}
