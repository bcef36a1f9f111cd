//! Any bytes in place of a snapshot: rejected, or loaded as a valid one.

#![no_main]

use acrobot_fuzz::snapshots;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| snapshots::check(bytes));
