//! NumPy's PCG64.

use core::convert::Infallible;
use core::fmt;

use rand_core::{Rng, SeedableRng, TryRng};

use super::seed_sequence::SeedSequence;

/// NumPy's `PCG64`, the generator of every Gymnasium environment and space: PCG XSL-RR 128/64 (M.
/// E. O'Neill, *PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for
/// Random Number Generation*, 2014). Like NumPy, it takes two 32-bit draws from one 64-bit draw.
///
/// It is not `Copy`, so that no stream is drawn from twice by accident. With the `serde` feature it
/// is stored as the hash of the seed and the position, so any values make a valid generator.
#[derive(Clone)]
pub struct Pcg64(Stream);

/// `rand_pcg` cannot seed a generator in a `const`, so the first draw does.
#[derive(Clone)]
enum Stream {
    /// The hash of the seed.
    Seeded([u64; 4]),
    Running(Running),
}

#[derive(Clone)]
struct Running {
    pcg: rand_pcg::Pcg64,
    /// The high half of a 64-bit draw whose low half was used.
    half: Option<u32>,
    /// The hash of the seed, and the number of 64-bit draws since the seeding.
    #[cfg(feature = "serde")]
    origin: ([u64; 4], u64),
}

impl Pcg64 {
    /// A placeholder that a [`Batch`](crate::batch::Batch) seeds. Do not draw from it.
    pub const UNSEEDED: Self = Self::from_hash([0; 4]);

    /// NumPy's `default_rng(seed)`. For longer seeds: `Pcg64::from` a [`SeedSequence`].
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self::from_hash(SeedSequence::new(seed).generate_state())
    }

    /// The generator of a seed with this hash.
    const fn from_hash(hash: [u64; 4]) -> Self {
        Self(Stream::Seeded(hash))
    }

    fn running(&self) -> Running {
        match &self.0 {
            Stream::Seeded(hash) => Running::new(*hash),
            Stream::Running(running) => running.clone(),
        }
    }

    #[cold]
    #[inline(never)] // inlining costs 16 bytes of stack and 2 % of a reset
    fn start(&mut self) {
        self.0 = Stream::Running(self.running());
    }

    #[inline]
    fn draw<T>(&mut self, draw: impl Fn(&mut Running) -> T) -> T {
        loop {
            match &mut self.0 {
                Stream::Running(running) => return draw(running),
                Stream::Seeded(_) => self.start(),
            }
        }
    }
}

impl Running {
    fn new(hash: [u64; 4]) -> Self {
        let [state1, state0, stream1, stream0] = hash.map(u128::from);
        Self {
            pcg: rand_pcg::Pcg64::new(state1 << 64 | state0, stream1 << 64 | stream0),
            half: None,
            #[cfg(feature = "serde")]
            origin: (hash, 0),
        }
    }

    #[inline]
    fn next_u64(&mut self) -> u64 {
        #[cfg(feature = "serde")]
        {
            self.origin.1 = self.origin.1.wrapping_add(1);
        }
        self.pcg.next_u64()
    }

    /// The low half of a new 64-bit draw, or the high half left by the last call.
    #[inline]
    fn next_u32(&mut self) -> u32 {
        self.half.take().unwrap_or_else(|| {
            let both = self.next_u64();
            self.half = Some((both >> 32) as u32);
            both as u32
        })
    }
}

impl PartialEq for Pcg64 {
    /// Compares stream and position, whether or not the generators have been drawn from.
    fn eq(&self, other: &Self) -> bool {
        let (this, other) = (self.running(), other.running());
        (this.pcg, this.half) == (other.pcg, other.half)
    }
}

impl Eq for Pcg64 {}

impl fmt::Debug for Pcg64 {
    /// The next 64-bit draw, because `rand_pcg` hides its state, and the unused half of the last
    /// one.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut running = self.running();
        f.debug_struct("Pcg64")
            .field("next_u64", &running.next_u64())
            .field("half", &running.half)
            .finish()
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Pcg64 {
    fn format(&self, f: defmt::Formatter<'_>) {
        let mut running = self.running();
        let (next_u64, half) = (running.next_u64(), running.half);
        defmt::write!(f, "Pcg64 {{ next_u64: {}, half: {} }}", next_u64, half);
    }
}

impl From<SeedSequence> for Pcg64 {
    /// NumPy's `default_rng(sequence)`.
    fn from(sequence: SeedSequence) -> Self {
        Self::from_hash(sequence.generate_state())
    }
}

impl TryRng for Pcg64 {
    type Error = Infallible;

    #[inline]
    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        Ok(self.draw(Running::next_u32))
    }

    #[inline]
    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        Ok(self.draw(Running::next_u64))
    }

    // Not rand_core's `fill_bytes_via_next_word`, whose division some compilers keep a panic for.
    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        let (words, rest) = bytes.as_chunks_mut();
        for word in words {
            *word = self.next_u64().to_le_bytes();
        }
        if !rest.is_empty() {
            let last = self.next_u64().to_le_bytes();
            rest.iter_mut().zip(last).for_each(|(to, byte)| *to = byte);
        }
        Ok(())
    }
}

impl SeedableRng for Pcg64 {
    type Seed = [u8; 32];

    /// The generator seeded with the integer that has these bytes, the lowest first.
    fn from_seed(seed: Self::Seed) -> Self {
        let mut words = [0; 8];
        for (word, bytes) in words.iter_mut().zip(seed.as_chunks().0) {
            *word = u32::from_le_bytes(*bytes);
        }
        SeedSequence::from_words(&words).into()
    }

    /// [`Pcg64::new`]: NumPy's stream of this seed, not the one that `rand_core` would derive.
    fn seed_from_u64(seed: u64) -> Self {
        Self::new(seed)
    }
}

#[cfg(feature = "serde")]
mod snapshot {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::{Pcg64, Running, Stream};

    /// Only numbers that every format can hold: TOML has no integers above 2⁶³, JavaScript none
    /// above 2⁵³, and other formats none of 128 bits. Some formats omit optional fields.
    #[derive(Serialize, Deserialize)]
    #[serde(rename = "Pcg64")]
    struct Snapshot {
        /// The hash of the seed, in halves: the lower before the upper.
        seed: [u32; 8],
        position: u64,
        has_half: bool,
        half: u32,
    }

    impl Pcg64 {
        /// The largest size of a snapshot in postcard's format, bytes: 7 bits of an integer in a
        /// byte.
        pub(crate) const MAX_SNAPSHOT_SIZE: usize = 8 * 5 + 10 + 1 + 5;
    }

    impl Serialize for Pcg64 {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            let running = self.running();
            let ((hash, position), half) = (running.origin, running.half);
            let [a, b, c, d] = hash.map(|word| [word as u32, (word >> 32) as u32]);
            Snapshot {
                seed: [a[0], a[1], b[0], b[1], c[0], c[1], d[0], d[1]],
                position,
                has_half: half.is_some(),
                half: half.unwrap_or_default(),
            }
            .serialize(serializer)
        }
    }

    impl<'de> Deserialize<'de> for Pcg64 {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            let Snapshot { seed: [a, b, c, d, e, f, g, h], position, has_half, half } =
                Snapshot::deserialize(deserializer)?;
            let hash = [[a, b], [c, d], [e, f], [g, h]];
            let hash = hash.map(|[low, high]| u64::from(high) << 32 | u64::from(low));
            let mut running = Running::new(hash);
            running.pcg.advance(position.into());
            running.origin.1 = position;
            running.half = has_half.then_some(half);
            Ok(Self(Stream::Running(running)))
        }
    }
}
