//! Any bytes in place of a learner's weights: rejected without a change, or loaded unchanged.

#![no_main]

use acrobot::{Acrobot, Fast, TimeLimit};
use libfuzzer_sys::fuzz_target;

use learners::{Budget, Memory, QLambda};

/// Few, so that libFuzzer finds bytes of the right length.
const SLOTS: usize = 16;
type Small<'w> = QLambda<'w, SLOTS, 28>;

/// The checksum, FNV-1a. libFuzzer would not find it.
fn checksum(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0x811c_9dc5, |hash, &byte| {
        (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)
    })
}

fuzz_target!(|bytes: &[u8]| {
    let Some((&kind, bytes)) = bytes.split_first() else {
        return;
    };
    let mut memory = Memory::<SLOTS, 28, 8>::EMPTY;
    let mut learner: Small = QLambda::new(Budget::Episodes(1), &mut memory);
    let before: Vec<u8> = learner.save().collect();
    // The bytes are unchanged, or get a valid header, or a valid header and checksum.
    let mut bytes = bytes.to_vec();
    if kind % 3 > 0 {
        bytes.splice(..bytes.len().min(16), before[..16].iter().copied());
    }
    if kind % 3 > 1 {
        bytes.resize(Small::BYTES - 4, kind);
        bytes.extend(checksum(&bytes).to_le_bytes());
    }
    let loaded = learner.load(&bytes);
    let after: Vec<u8> = learner.save().collect();
    match loaded {
        Ok(()) => {
            assert_eq!(after, bytes);
            assert!(learner.weights().iter().flatten().all(|w| w.is_finite()));
        }
        Err(error) => {
            assert_eq!(after, before);
            assert!(!error.to_string().is_empty());
        }
    }
    let mut env = TimeLimit::new(Acrobot::<Fast>::new(0), 8.try_into().expect("not 0"));
    for _ in 0..2 {
        let _ = learner.greedy(&env.state());
        learner.learn(&mut env);
    }
});
