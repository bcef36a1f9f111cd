//! Promise 1, Gymnasium's numbers: seeds, streams and draws are NumPy's.

use std::fmt::Debug;
use std::num::NonZeroU32;
use std::str::FromStr;

use acrobot::batch::{Batch, BatchMemory, Block};
use acrobot::env::Env;
use acrobot::numpy::{Pcg64, SeedSequence, integers, uniform};
use acrobot::{Acrobot, Fast, Portable};
use common::lines;
use rand_core::Rng;

/// The rows of `data/seeds.txt` of one kind, without the kind.
fn rows(kind: &'static str) -> impl Iterator<Item = Vec<&'static str>> {
    let rows = lines(include_str!("data/seeds.txt"), kind);
    let rows: Vec<Vec<_>> = rows.map(|row| row.split(' ').collect()).collect();
    assert!(rows.len() >= 20, "tests/data/seeds.txt has {} rows of {kind}", rows.len());
    rows.into_iter()
}

fn seed(decimal: &str) -> SeedSequence {
    decimal.parse().unwrap()
}

fn generator(decimal: &str) -> Pcg64 {
    seed(decimal).into()
}

fn numbers<T: FromStr<Err: Debug>>(row: &[&str]) -> Vec<T> {
    row.iter().map(|number| number.parse().unwrap()).collect()
}

fn hexes(row: &[&str]) -> Vec<u64> {
    row.iter().map(|word| u64::from_str_radix(word, 16).unwrap()).collect()
}

#[test]
fn initial_states_equal_gymnasiums() {
    for row in rows("reset") {
        let portable = Acrobot::<Portable>::with_rng(generator(row[0])).state();
        let fast = Acrobot::<Fast>::with_rng(generator(row[0])).state();
        let bits = <[f32; 4]>::from(fast).map(|x| u64::from(x.to_bits()));
        assert_eq!(bits.to_vec(), hexes(&row[1..]), "seed {}", row[0]);
        assert_eq!(portable, fast.cast());
    }
}

#[test]
fn samples_equal_gymnasiums() {
    for row in rows("sample") {
        let mut space = generator(row[0]);
        let n: NonZeroU32 = row[1].parse().unwrap();
        let drawn: Vec<u32> = (0..20).map(|_| integers(&mut space, n)).collect();
        assert_eq!(drawn, numbers::<u32>(&row[2..]), "seed {}, n {n}", row[0]);
    }
}

#[test]
fn box_samples_equal_gymnasiums() {
    let space = Acrobot::<Fast>::new(0).observation_space();
    for row in rows("box") {
        let mut rng = generator(row[0]);
        let drawn: Vec<u64> =
            (0..3).flat_map(|_| space.sample(&mut rng)).map(|x| x.to_bits().into()).collect();
        assert_eq!(drawn, hexes(&row[1..]), "seed {}", row[0]);
    }
}

/// A 32-bit draw takes half of a word. The other half stays through 64-bit draws.
#[test]
fn mixed_draws_equal_numpys() {
    let [three, five] = [3, 5].map(|n| NonZeroU32::new(n).unwrap());
    for row in rows("mixed") {
        let mut rng = generator(row[0]);
        for words in row[1..].chunks(3) {
            assert_eq!(integers(&mut rng, three), words[0].parse().unwrap());
            assert_eq!(uniform(&mut rng, -1.0, 2.0).to_bits(), hexes(&words[1..2])[0]);
            assert_eq!(integers(&mut rng, five), words[2].parse().unwrap());
        }
    }
}

#[test]
fn descendants_equal_numpys() {
    for row in rows("spawn") {
        let path = if row[1] == "-" {
            vec![]
        } else {
            numbers::<u64>(&row[1].split('/').collect::<Vec<_>>())
        };
        let descendant = path.iter().fold(seed(row[0]), |parent, &index| parent.child(index));
        assert_eq!(
            descendant.generate_state::<4>().to_vec(),
            hexes(&row[2..]),
            "seed {} path {}",
            row[0],
            row[1]
        );
    }
}

/// Children never run out: a batch takes the next ones, even after 2⁶⁴.
#[test]
fn there_is_always_a_next_child() {
    let mut seed = SeedSequence::new(42);
    let mut all = seed.spawn(u64::MAX);
    assert_eq!(all.next(), Some(seed.child(0)));
    let last = seed.spawn(1).next().unwrap();
    assert_eq!(last, seed.child(u64::MAX));
    assert_eq!(seed.spawn(5).count(), 5);
    let next = seed.clone().spawn(1).next().unwrap();
    // np.random.SeedSequence(42, spawn_key=(2**64 + 5,)).generate_state(2, np.uint64)
    let words = [0xc75e_27e1_5183_9fa7, 0x22de_3ff0_2e47_cbe8];
    assert_eq!(next.generate_state(), words);

    let (blocks, generators) = ([Block::EMPTY; 1], [Pcg64::UNSEEDED; 1]);
    let memory = BatchMemory { blocks, generators, own: () };
    let batch = Batch::<Fast, _>::new(seed, memory).unwrap();
    let alone = Acrobot::<Fast>::new(next);
    assert_eq!(batch.state(0), Ok(alone.state()));
}

/// A text of up to 4300 digits is a seed. A longer one is rejected at once.
#[test]
fn long_texts_are_seeds_up_to_a_limit() {
    // np.random.SeedSequence(10**4300 - 1).generate_state(2, np.uint64)
    let words = [0x0db9_182d_a261_8a7e, 0x23df_384a_98ce_fb0a];
    assert_eq!(seed(&"9".repeat(4300)).generate_state(), words);
    let error = "9".repeat(50_000_000).parse::<SeedSequence>().unwrap_err();
    assert_eq!(
        error.to_string(),
        "seed must be a number of 1 to 4300 decimal digits, got '9' as character 4301"
    );
}

/// Bytes are those of the next words, and 32-bit draws their halves, the lower one first.
#[test]
fn draws_of_other_widths_are_parts_of_words() {
    let (mut words, mut rng) = (Pcg64::new(42), Pcg64::new(42));
    let next = [(); 3].map(|()| words.next_u64().to_le_bytes());
    let halves = [rng.next_u32(), rng.next_u32()].map(u32::to_le_bytes);
    let mut bytes = [0; 13];
    rng.fill_bytes(&mut bytes);
    let found = [halves.as_flattened(), &bytes].concat();
    assert_eq!(found, next.as_flattened()[..21]);
}

/// Whether they have drawn before or not.
#[test]
fn generators_compare_and_print_by_their_next_draws() {
    let new = Pcg64::new(42);
    let (mut started, mut halved) = (new.clone(), new.clone());
    let (next, _) = (started.next_u64(), halved.next_u32());
    assert_ne!(started, new);
    assert_ne!(halved, started, "one has half a draw left");
    assert_eq!(format!("{new:?}"), format!("Pcg64 {{ next_u64: {next}, half: None }}"));
    let (second, half) = (started.next_u64(), next >> 32);
    let expected = format!("Pcg64 {{ next_u64: {second}, half: Some({half}) }}");
    assert_eq!(format!("{halved:?}"), expected);
}
