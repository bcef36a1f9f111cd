//! Saved weights are loaded unchanged. Other bytes are rejected with the reason, and change
//! nothing.

use learners::{Budget, LoadError, Memory, Memory16, Memory32, Memory64, QLambda, training};

type Small = Memory<32, 16, 100>;

/// The weights of a learner that has learnt something.
fn learnt<const S: usize, const T: usize, const N: usize>(mut memory: Memory<S, T, N>) -> Vec<u8> {
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

#[test]
fn saved_weights_are_loaded() {
    let bytes = learnt(Small::EMPTY);
    assert_eq!(bytes.len(), QLambda::<32, 16>::BYTES);
    let mut memory = Small::EMPTY;
    let mut learner = QLambda::new(Budget::Episodes(3), &mut memory);
    learner.load(&bytes).unwrap();
    let used = learner.weights().as_flattened().iter();
    assert!(used.filter(|&&w| w != 0.0).count() > 30);
    assert!(learner.save().eq(bytes));
}

/// Weights that were saved once stay loadable: magic, version, size, and the fingerprint of the
/// tiles.
#[test]
fn the_header_is_stable() {
    let headers = [learnt(Memory16::EMPTY), learnt(Memory32::EMPTY), learnt(Memory64::EMPTY)];
    let expected = [
        b"TILE\x01\0\0\0\x14\x2c\0\0\xc7\xe8\xdb\x37",
        b"TILE\x01\0\0\0\x14\x5c\0\0\xe7\x67\x05\x43",
        b"TILE\x01\0\0\0\x14\xc0\0\0\x02\x5e\x61\x7d",
    ];
    for (bytes, expected) in headers.iter().zip(expected) {
        assert_eq!(bytes[..16], *expected);
    }
}

#[test]
fn damaged_bytes_are_rejected() {
    let good = learnt(Small::EMPTY);
    let with = |at: usize, value: u8| {
        let mut bytes = good.clone();
        bytes[at] = value;
        bytes
    };
    assert_eq!(rejected(&[]), LoadError::Magic);
    assert_eq!(rejected(&good[..3]), LoadError::Magic);
    assert_eq!(rejected(&with(0, b'X')), LoadError::Magic);
    let version = rejected(&with(4, 2));
    assert_eq!(version.to_string(), "weights must have version 1, got 2");
    let longer = [&good[..], &[0]].concat();
    for length in [4, 7, 8, 15, 16, 20, good.len() - 1, good.len() + 1] {
        let size = rejected(&longer[..length]);
        let reason = format!("weights must have 276 bytes, got {length}");
        assert_eq!(size.to_string(), reason);
    }
    // Any other byte, in the size, the weights and the checksum itself.
    for (at, byte) in good.iter().enumerate() {
        if at < 8 || (12..16).contains(&at) {
            continue;
        }
        assert_eq!(rejected(&with(at, byte ^ 1)), LoadError::Checksum, "{at}");
    }
}

#[test]
fn weights_of_other_tiles_are_rejected() {
    let bytes = learnt(Memory::<32, 20, 100>::EMPTY);
    assert_eq!(rejected(&bytes), LoadError::Features);
}

/// The checksum is computed after the damage, so it is right.
#[test]
fn weights_that_are_not_finite_are_rejected() {
    for number in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut bytes = learnt(Small::EMPTY);
        bytes.truncate(bytes.len() - 4);
        bytes[16 + 4 * 5..][..4].copy_from_slice(&number.to_le_bytes());
        let checksum = bytes.iter().fold(0x811c_9dc5, |hash: u32, &byte| {
            (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)
        });
        bytes.extend(checksum.to_le_bytes());
        let reason = rejected(&bytes).to_string();
        assert_eq!(reason, "weight 5 must be a finite number");
    }
}
