//! Hostile bytes in place of a snapshot: refused, or as good as one that was saved.

#![no_main]

use acrobot_fuzz::snapshots;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| snapshots::check(bytes));
