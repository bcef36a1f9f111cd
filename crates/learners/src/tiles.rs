//! Tile coding (Sutton & Barto 9.5.4): a state activates one tile in each of several offset grids.

use core::f32::consts::PI;

/// How one number of the state, from `-high` to `high`, is divided.
#[derive(Clone, Debug)]
struct Dimension {
    high: f32,
    intervals: u16,
    /// Whether `high` equals `-high`. Otherwise a number outside counts as the nearest bound, and
    /// there is one more interval beyond the bounds, because tilings are offset.
    cyclic: bool,
    /// Intervals for each unit of the state.
    per_unit: f32,
}

impl Dimension {
    fn new(high: f32, intervals: u16, cyclic: bool) -> Self {
        Self { high, intervals, cyclic, per_unit: f32::from(intervals) / (high + high) }
    }

    /// The number of coordinates that a tile can have.
    fn tiles(&self) -> u16 {
        self.intervals + u16::from(!self.cyclic)
    }

    /// The interval of `x` before any offset, the next one, and how far `x` is between them, in
    /// 2⁻¹⁶ intervals.
    #[inline]
    fn locate(&self, x: f32) -> [u16; 3] {
        let mut x = (x + self.high) * self.per_unit;
        if self.cyclic && x >= f32::from(self.intervals) {
            x = 0.0;
        }
        // Casts saturate, and NaN is 0.
        let whole = (x as u16).min(self.intervals - 1);
        let fraction = ((x - f32::from(whole)) * 65536.0) as u32;
        let next = whole + 1;
        let next = if next == self.tiles() { 0 } else { next };
        [whole, next, fraction.min(65535) as u16]
    }
}

/// The dimensions of a group of tilings, a bit for each: all four, pairs and triples.
const GROUPS: [u8; 9] = [0b1111, 0b0011, 0b1100, 0b0101, 0b1010, 0b0111, 0b1011, 0b1101, 0b1110];

/// The stride from tile to tile of a tiling. Its multiples modulo 2¹⁶ lie far apart (Knuth 6.4): it
/// is the only factor whose continued fraction over 2¹⁶ has no quotient above 2.
const FACTOR: u16 = 0xb3f9;

/// The stride from tiling to tiling: 2¹⁶ over the golden ratio.
const GOLDEN: u16 = 0x9e37;

/// `T` tilings over two angles, in rad from −π to π, and two velocities, in rad/s. All tiles share
/// `S` slots.
///
/// A tile's slot is linear in its coordinates, in 16 bits, so that eight tilings fit in the
/// smallest vector register.
#[derive(Clone, Debug)]
pub struct TileCoder<const S: usize, const T: usize> {
    dimensions: [Dimension; 4],
    /// The offset of each tiling, in 2⁻¹⁶ intervals.
    offsets: [[u16; T]; 4],
    /// How much the slot grows from one coordinate to the next; 0 in dimensions that a tiling
    /// ignores.
    strides: [[u16; T]; 4],
    /// The slot of each tiling's first tile.
    bases: [u16; T],
}

impl<const S: usize, const T: usize> TileCoder<S, T> {
    /// Slots that are enough for triples and for more intervals.
    const MANY: bool = S >= 2048;
    /// The tilings over each pair, which learn within few episodes, and over each triple.
    const PAIR: usize = if Self::MANY { 3 } else { 2 };
    const TRIPLE: usize = if Self::MANY { 6 } else { 0 };
    /// The tilings over all dimensions: the others.
    const WHOLE: usize = T - 4 * (Self::PAIR + Self::TRIPLE);

    /// The tilings for this many slots, which are tuned. Two tunings exist: below 2,048 slots, and
    /// from there on.
    #[expect(clippy::new_without_default, reason = "there is only one")]
    #[must_use]
    pub fn new() -> Self {
        const { assert!(S >= 2 && S <= 1 << 16, "16 bits number the slots") };
        let [angle1, angle2, velocity1, velocity2] =
            if Self::MANY { [8, 10, 4, 8] } else { [6, 6, 5, 6] };
        let mut coder = Self {
            // Faster velocities are rare.
            dimensions: [
                Dimension::new(PI, angle1, true),
                Dimension::new(PI, angle2, true),
                Dimension::new(1.125 * PI, velocity1, false),
                Dimension::new(1.125 * 2.0 * PI, velocity2, false),
            ],
            offsets: [[0; T]; 4],
            strides: [[0; T]; 4],
            bases: core::array::from_fn(|t| (t as u16).wrapping_mul(GOLDEN)),
        };
        let [whole, pair, triple] = [Self::WHOLE, Self::PAIR, Self::TRIPLE];
        let tilings = [whole, pair, pair, pair, pair, triple, triple, triple, triple];
        // For each group: its stride in the next of its dimensions, and that dimension's odd
        // integer.
        let mut next = [(FACTOR, 1); 9];
        for (d, ((dimension, offsets), strides)) in
            (coder.dimensions.iter()).zip(&mut coder.offsets).zip(&mut coder.strides).enumerate()
        {
            let mut all = offsets.iter_mut().zip(strides);
            for ((dimensions, tilings), (stride, odd)) in GROUPS.iter().zip(tilings).zip(&mut next)
            {
                let is_over = dimensions >> d & 1 == 1;
                for (tiling, (offset, moves)) in all.by_ref().take(tilings).enumerate() {
                    if is_over {
                        *offset = displacement(tiling * *odd, tilings);
                        *moves = *stride;
                    }
                }
                if is_over {
                    *stride = stride.wrapping_mul(dimension.tiles());
                    *odd += 2;
                }
            }
        }
        coder
    }

    /// The slots of a state, each below `S`.
    #[must_use]
    #[inline]
    pub fn active(&self, state: &[f32; 4]) -> [u16; T] {
        let mut slots = self.bases;
        let tilings = self.offsets.iter().zip(&self.strides);
        for ((x, dimension), (offsets, strides)) in state.iter().zip(&self.dimensions).zip(tilings)
        {
            let [whole, next, fraction] = dimension.locate(*x);
            for (slot, (&offset, &stride)) in slots.iter_mut().zip(offsets.iter().zip(strides)) {
                let (_, carried) = fraction.overflowing_add(offset);
                let coordinate = if carried { next } else { whole };
                *slot = slot.wrapping_add(coordinate.wrapping_mul(stride));
            }
        }
        slots.map(|slot| ((u32::from(slot) * S as u32) >> 16) as u16)
    }
}

/// Displacement by the first odd integers (Sutton & Barto 9.5.4): among n tilings, the offset of
/// tiling j is j (1, 3, 5, 7, …) / n intervals, modulo 1. Here it is in 2⁻¹⁶ intervals.
fn displacement(steps: usize, tilings: usize) -> u16 {
    (steps as f32 / tilings as f32 * 65536.0) as u32 as u16
}
