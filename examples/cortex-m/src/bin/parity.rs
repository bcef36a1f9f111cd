//! Plays the sixteen episodes that the host's tests play, and compares every digest.

#![no_std]
#![no_main]

#[path = "../../../../tests/common/episodes.rs"]
mod episodes;

use acrobot::{Arithmetic, Fast, Micro, Portable};
use acrobot_cortex_m::end;
use cortex_m_rt::entry;
use cortex_m_semihosting::hprintln;

#[entry]
fn main() -> ! {
    let equal = [
        check::<Portable>("portable", &episodes::PORTABLE),
        check::<Fast>("fast", &episodes::FAST),
        check::<Micro>("micro", &episodes::MICRO),
    ];
    end(equal == [true; 3])
}

fn check<A: Arithmetic>(name: &str, expected: &[u64; 16]) -> bool {
    let mut equal = true;
    for (episode, &expected) in expected.iter().enumerate() {
        let found = episodes::digest::<A>(episode as u64);
        if found != expected {
            hprintln!(
                "{} differs in episode {}: {:016x} and not {:016x}",
                name,
                episode,
                found,
                expected
            );
            equal = false;
        }
    }
    if equal {
        hprintln!("{}: 16 episodes are equal to the bit", name);
    }
    equal
}
