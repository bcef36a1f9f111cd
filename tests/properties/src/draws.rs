//! Seeds, generators and draws.

use std::num::NonZeroU32;

use acrobot::Error;
use acrobot::numpy::{Pcg64, SeedSequence, integers, uniform};
use common::Repeating;
use proptest::prelude::*;
use rand_core::SeedableRng;

use crate::given::{Range, holds, number};

fn generator() -> impl Strategy<Value = Repeating> {
    let word = prop_oneof![Just(0), Just(u64::MAX), any::<u64>()];
    prop::collection::vec(word, 1..4).prop_map(Repeating::new)
}

#[test]
fn integers_are_below_their_bound_with_any_generator() {
    let n = prop_oneof![Just(1), 1..10_u32, any::<u32>()].prop_filter_map("0", NonZeroU32::new);
    holds(2000, (generator(), n), |(mut rng, n)| {
        assert!(integers(&mut rng, n) < n.get());
        assert!(integers(&mut Pcg64::new(rng.words[0]), n) < n.get());
    });
}

#[test]
fn uniform_draws_are_within_their_bounds() {
    let bounds = || number::<f64>(Range::Any);
    holds(5000, (generator(), bounds(), bounds()), |(mut rng, x, y)| {
        let (low, high) = (x.min(y), x.max(y));
        if (high - low).is_finite() {
            let drawn = uniform(&mut rng, low, high);
            assert!(low <= drawn && drawn <= high, "{drawn}");
        }
    });
}

#[test]
fn words_decimals_bytes_and_integers_are_the_same_seed() {
    holds(1000, (any::<u128>(), 0..128_u32), |(seed, shift)| {
        let seed = seed >> shift;
        let words = [0, 32, 64, 96].map(|shift| (seed >> shift) as u32);
        let sequence = SeedSequence::from_words(&words);
        assert_eq!(seed.to_string().parse(), Ok(sequence.clone()));
        assert_eq!(format!("000{seed}").parse(), Ok(sequence.clone()));
        if let Ok(seed) = u64::try_from(seed) {
            assert_eq!(SeedSequence::new(seed), sequence);
            assert_eq!(Pcg64::seed_from_u64(seed), Pcg64::new(seed));
        }
    });
    holds(200, any::<[u32; 8]>(), |words| {
        let bytes = words.map(u32::to_le_bytes).as_flattened().try_into();
        let sequence = SeedSequence::from_words(&words);
        assert_eq!(Pcg64::from_seed(bytes.unwrap()), Pcg64::from(sequence));
    });
    let letter = prop_oneof![4 => prop::char::range('0', '9'), 1 => any::<char>()];
    holds(1000, prop::collection::vec(letter, 0..5), |letters| {
        let text = String::from_iter(&letters);
        let other = letters.iter().position(|letter| !letter.is_ascii_digit());
        let parsed = text.parse::<SeedSequence>();
        if other.is_none() && !text.is_empty() {
            assert!(parsed.is_ok(), "{text:?}");
        } else {
            let position = other.unwrap_or(0);
            let (found, position) = (letters.get(position).copied(), position + 1);
            assert_eq!(parsed, Err(Error::MalformedSeed { found, position }));
        }
    });
}
