//! Plays the sixteen episodes of the crate's tests and compares every digest. Then it steps a batch, one acrobot at a time
//! and sixteen side by side.

#![no_std]
#![no_main]

#[path = "../../../../tests/common/digest.rs"]
mod digest;
#[path = "../../../../tests/common/episodes.rs"]
mod episodes;

use acrobot::arithmetic::{Arithmetic, Micro, Reference};
use acrobot::{Fast, Portable};
use cortex_m_rt::entry;
use semihosting::{println, process};

#[entry]
fn main() -> ! {
    let batch = episodes::batch::<1, 20>() == episodes::BATCH
        && episodes::batch::<16, 2>() == episodes::BATCH;
    println!("batch: {}", if batch { "bit-identical" } else { "differs" });
    let equal = [
        check::<Reference>("reference", &episodes::REFERENCE),
        check::<Portable>("portable", &episodes::PORTABLE),
        check::<Fast>("fast", &episodes::FAST),
        check::<Micro>("micro", &episodes::MICRO),
        batch,
    ];
    process::exit(if equal == [true; 5] { 0 } else { 1 })
}

fn check<A: Arithmetic>(name: &str, expected: &[u64; 16]) -> bool {
    let mut equal = 0;
    for (episode, &expected) in expected.iter().enumerate() {
        let found = episodes::digest::<A>(episode as u64);
        if found == expected {
            equal += 1;
        } else {
            println!(
                "{name} differs in episode {episode}: got {found:016x}, expected {expected:016x}"
            );
        }
    }
    println!("{name}: {equal} of 16 episodes are bit-identical");
    equal == 16
}
