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

#[cfg(target_os = "none")]
use semihosting::{println, process};
// Linked because it is named.
#[cfg(feature = "soft-floats")]
use soft_floats as _;

#[cfg_attr(all(target_os = "none", target_arch = "arm"), cortex_m_rt::entry)]
#[cfg_attr(all(target_os = "none", not(target_arch = "arm")), riscv_rt::entry)]
fn main() -> ! {
    let mut all_equal = true;
    bits::compare(|name, found, expected| {
        let equal = found == expected;
        all_equal &= equal;
        println!("{name}: {}", if equal { "bit-identical" } else { "differs" });
    });
    process::exit(if all_equal { 0 } else { 1 })
}
