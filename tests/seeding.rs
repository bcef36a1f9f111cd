//! Promise 1, Gymnasium's numbers: seeds, streams and draws are NumPy's.

use std::fmt::Debug;
use std::num::NonZeroU32;
use std::str::FromStr;

use acrobot::env::{Env, Space};
use acrobot::{Acrobot, Fast, Pcg64, Portable, SeedSequence, integers, uniform};
use rand_core::{Rng, SeedableRng};

/// The rows of `data/seeds.txt` of one kind, without the kind.
fn rows(kind: &str) -> impl Iterator<Item = Vec<&'static str>> {
    let lines = include_str!("data/seeds.txt").lines();
    let rows: Vec<Vec<_>> = lines
        .filter_map(|line| line.strip_prefix(kind)?.strip_prefix(' '))
        .map(|row| row.split(' ').collect())
        .collect();
    assert!(rows.len() >= 20, "{} rows of {kind}", rows.len());
    // Miri takes a thousand times as long.
    rows.into_iter().step_by(if cfg!(miri) { 10 } else { 1 })
}

fn seed(decimal: &str) -> SeedSequence {
    decimal.parse().unwrap()
}

fn numbers<T: FromStr<Err: Debug>>(row: &[&str]) -> Vec<T> {
    row.iter().map(|number| number.parse().unwrap()).collect()
}

fn hexes(row: &[&str]) -> Vec<u64> {
    row.iter()
        .map(|word| u64::from_str_radix(word, 16).unwrap())
        .collect()
}

#[test]
fn starts_are_gymnasiums() {
    for row in rows("reset") {
        let portable = Acrobot::<Portable>::new(seed(row[0])).state();
        let fast = Acrobot::<Fast>::new(seed(row[0])).state();
        let bits = <[f32; 4]>::from(fast).map(|x| u64::from(x.to_bits()));
        assert_eq!(bits.to_vec(), hexes(&row[1..]), "seed {}", row[0]);
        assert_eq!(portable, fast.cast());
    }
}

#[test]
fn samples_are_gymnasiums() {
    for row in rows("sample") {
        let mut space = Pcg64::new(seed(row[0]));
        let n: NonZeroU32 = row[1].parse().unwrap();
        let drawn: Vec<u32> = (0..20).map(|_| integers(&mut space, n)).collect();
        assert_eq!(drawn, numbers::<u32>(&row[2..]), "seed {}, n {n}", row[0]);
    }
}

#[test]
fn box_samples_are_gymnasiums() {
    let acrobot = Acrobot::<Fast>::new(0);
    for row in rows("box") {
        let space = acrobot.observation_space();
        let mut rng = Pcg64::new(seed(row[0]));
        let drawn: Vec<u64> = (0..3)
            .flat_map(|_| *space.sample(&mut rng))
            .map(|x: f32| x.to_bits().into())
            .collect();
        assert_eq!(drawn, hexes(&row[1..]), "seed {}", row[0]);
    }
}

/// The half that a 32-bit draw leaves outlives draws of 64 bits.
#[test]
fn mixed_draws_are_numpys() {
    let [three, five] = [3, 5].map(|n| NonZeroU32::new(n).unwrap());
    for row in rows("mixed") {
        let mut rng = Pcg64::new(seed(row[0]));
        for words in row[1..].chunks(3) {
            assert_eq!(integers(&mut rng, three), words[0].parse().unwrap());
            assert_eq!(
                uniform(&mut rng, -1.0, 2.0).to_bits(),
                hexes(&words[1..2])[0]
            );
            assert_eq!(integers(&mut rng, five), words[2].parse().unwrap());
        }
    }
}

#[test]
fn descendants_are_numpys() {
    for row in rows("spawn") {
        let path = if row[1] == "-" {
            vec![]
        } else {
            numbers::<u64>(&row[1].split('/').collect::<Vec<_>>())
        };
        let descendant = path
            .iter()
            .fold(seed(row[0]), |parent, &index| parent.child(index));
        assert_eq!(
            descendant.generate_state::<4>().to_vec(),
            hexes(&row[2..]),
            "seed {} path {}",
            row[0],
            row[1]
        );
    }
}

#[test]
fn spawn_goes_on_where_it_stopped() {
    let mut seed = SeedSequence::from(42);
    let parent = seed.clone();
    let first: Vec<_> = seed.spawn(3).collect();
    let second: Vec<_> = seed.spawn(2).collect();
    assert_eq!(first, [0, 1, 2].map(|i| parent.child(i)));
    assert_eq!(second, [3, 4].map(|i| parent.child(i)));
    assert_eq!(
        seed.generate_state::<4>(),
        parent.generate_state::<4>(),
        "a parent's own stream stays"
    );
}

#[test]
fn integers_of_every_kind_are_seeds() {
    assert_eq!(SeedSequence::from(5), SeedSequence::from_words(&[5]));
    assert_eq!(SeedSequence::from(u64::MAX), seed("18446744073709551615"));
    assert_eq!(
        SeedSequence::from_words(&[5, 0, 0, 0, 0, 0]),
        SeedSequence::from(5)
    );
    assert_eq!(Pcg64::seed_from_u64(42), Pcg64::new(42));
    let mut bytes = [0; 32];
    bytes[16] = 1;
    assert_eq!(
        Pcg64::from_seed(bytes),
        Pcg64::new(seed("340282366920938463463374607431768211456"))
    );
}

#[test]
fn a_reset_without_a_seed_continues_the_stream() {
    let mut acrobot = Acrobot::<Portable>::new(42);
    let mut rng = Pcg64::new(42);
    let mut draw = || [(); 4].map(|()| f64::from(uniform(&mut rng, -0.1, 0.1) as f32));
    let first = draw();
    assert_eq!(acrobot.state(), first.into());
    acrobot.reset();
    let second = draw();
    assert_eq!(acrobot.state(), second.into());
    assert_ne!(first, second);
}

/// A generator of the user's own: here one that always says the same.
struct Constant(u64);

impl rand_core::TryRng for Constant {
    type Error = core::convert::Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Self::Error> {
        Ok(self.0 as u32)
    }

    fn try_next_u64(&mut self) -> Result<u64, Self::Error> {
        Ok(self.0)
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Self::Error> {
        bytes.fill(self.0 as u8);
        Ok(())
    }
}

#[test]
fn another_generator_serves_too() {
    let lowest = Acrobot::<Portable, _>::with_rng(Constant(0)).state();
    assert_eq!(<[f64; 4]>::from(lowest), [f64::from(-0.1_f32); 4]);
    // Every draw of 0 must be rejected for n = 3, and still there is an end.
    assert_eq!(integers(&mut Constant(0), NonZeroU32::new(3).unwrap()), 0);
}

/// Against another implementation of the generator underneath, over draws of every width.
#[test]
fn the_generator_is_rand_pcgs() {
    for seed in 0..100 {
        let [state1, state0, stream1, stream0] =
            SeedSequence::from(seed).generate_state().map(u128::from);
        let mut theirs = rand_pcg::Pcg64::new(state1 << 64 | state0, stream1 << 64 | stream0);
        let mut ours = Pcg64::new(seed);
        for _ in 0..100 {
            let next = theirs.next_u64();
            let mut again = ours.clone();
            assert_eq!(
                [again.next_u32(), again.next_u32()],
                [next as u32, (next >> 32) as u32]
            );
            assert_eq!(ours.next_u64(), next);
        }
        let mut bytes = [[0; 13]; 2];
        theirs.fill_bytes(&mut bytes[0]);
        ours.fill_bytes(&mut bytes[1]);
        assert_eq!(bytes[0], bytes[1]);
    }
}
