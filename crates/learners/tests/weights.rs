//! Saved weights are loaded unchanged. Other bytes are rejected with the reason, and change
//! nothing.

use learners::{Budget, LoadError, Memory, QLambda, training};

type Small = Memory<32, 16, 100>;

/// The weights of a learner that has learnt something.
fn learnt() -> Vec<u8> {
    let mut memory = Small::EMPTY;
    let mut learner = QLambda::new(Budget::Episodes(3), &mut memory);
    learner.learn(&mut training(1.into()));
    learner.save().collect()
}

/// The reason why a learner rejects the bytes.
fn rejected(bytes: &[u8]) -> LoadError {
    let mut memory = Small::EMPTY;
    let mut learner = QLambda::new(Budget::Episodes(3), &mut memory);
    let error = learner.load(bytes).expect_err("rejected");
    assert_eq!(learner.weights(), &[[0.0; 2]; 32], "{error}");
    error
}

/// Also those that were saved once: the header is stable.
#[test]
fn saved_weights_are_loaded() {
    let bytes = learnt();
    assert_eq!(bytes.len(), QLambda::<32, 16>::BYTES);
    assert!(bytes.starts_with(b"TILE\x01\0\0\0\x14\x01\0\0\x10\0\0\0"));
    let mut memory = Small::EMPTY;
    let mut learner = QLambda::new(Budget::Episodes(3), &mut memory);
    learner.load(&bytes).unwrap();
    let used = learner.weights().as_flattened().iter();
    assert!(used.filter(|&&w| w != 0.0).count() > 30);
    assert!(learner.save().eq(bytes));
}

#[test]
fn damaged_bytes_are_rejected() {
    let good = learnt();
    let longer = [&good[..], &[0]].concat();
    for length in 0..=longer.len() {
        let expected = match length {
            0..8 => LoadError::Magic,
            276 => continue,
            _ => LoadError::Size { found: length, expected: 276 },
        };
        assert_eq!(rejected(&longer[..length]), expected);
    }
    for at in 0..good.len() {
        let mut bytes = good.clone();
        bytes[at] ^= 4;
        let expected = match at {
            0..8 => LoadError::Magic,
            12..16 => LoadError::Features,
            _ => LoadError::Checksum,
        };
        assert_eq!(rejected(&bytes), expected, "{at}");
    }
}

/// The checksum is computed after the damage, so it is right.
#[test]
fn weights_that_are_not_finite_are_rejected() {
    let mut bytes = learnt();
    bytes.truncate(bytes.len() - 4);
    bytes[16 + 4 * 5..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    let checksum = bytes
        .iter()
        .fold(0x811c_9dc5, |hash: u32, &byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193));
    bytes.extend(checksum.to_le_bytes());
    assert_eq!(rejected(&bytes), LoadError::NotFinite(5));
}
