//! Tile coding (Sutton & Barto 9.5.4): a state activates one tile in each of several offset grids.

use core::iter::repeat_n;

use crate::error::Error;
use crate::values::Features;

/// How one number of the state is divided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dimension {
    low: f32,
    high: f32,
    intervals: u16,
    cyclic: bool,
}

impl Dimension {
    /// From `low` to `high` in equal `intervals`. A number outside counts as the nearest bound.
    ///
    /// Because tilings are offset, each has one more interval beyond the bounds.
    #[must_use]
    pub const fn bounded(low: f32, high: f32, intervals: u16) -> Self {
        Self {
            low,
            high,
            intervals,
            cyclic: false,
        }
    }

    /// An angle or another cyclic number: `high` equals `low`, and numbers outside wrap around.
    #[must_use]
    pub const fn cyclic(low: f32, high: f32, intervals: u16) -> Self {
        Self {
            low,
            high,
            intervals,
            cyclic: true,
        }
    }

    /// The number of coordinates that a tile can have.
    const fn tiles(&self) -> u16 {
        self.intervals + !self.cyclic as u16
    }

    fn check(&self) -> Result<(), Error> {
        let reject = |name, value, rule| Err(Error::OutOfRange { name, value, rule });
        if !self.low.is_finite() {
            return reject("a lower bound", self.low, "finite");
        }
        if !(self.high > self.low && (self.high - self.low).is_finite()) {
            return reject("an upper bound", self.high, "finite and above the lower");
        }
        let intervals = usize::from(self.intervals);
        let fits = (1..=256).contains(&intervals);
        Error::unless(fits, "intervals", intervals, "from 1 to", 256)
    }

    /// The interval of `x` before any offset, the next one, and how far `x` is between them, in 2⁻¹⁶
    /// intervals.
    #[inline]
    fn locate(&self, x: f32, per_unit: f32) -> [u16; 3] {
        let mut x = (x - self.low) * per_unit;
        let intervals = f32::from(self.intervals);
        if self.cyclic && !(0.0..intervals).contains(&x) {
            x = wrap(x, intervals);
        }
        // Casts saturate, and NaN is 0.
        let whole = (x as u16).min(self.intervals - 1);
        let fraction = ((x - f32::from(whole)) * 65536.0) as u32;
        let next = whole + 1;
        let next = if next == self.tiles() { 0 } else { next };
        [whole, next, fraction.min(65535) as u16]
    }
}

/// The remainder in \[0, `n`) of a rounded-down division; 0 for infinities and NaN.
#[cold]
fn wrap(x: f32, n: f32) -> f32 {
    let turns = x / n;
    let mut whole = turns as i32 as f32;
    if whole > turns {
        whole -= 1.0;
    }
    let rest = x - whole * n;
    if rest >= 0.0 && rest < n { rest } else { 0.0 }
}

/// Tilings over the same dimensions, each offset against the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Group<'a> {
    dimensions: &'a [usize],
    tilings: usize,
}

impl<'a> Group<'a> {
    /// A number of `tilings` over these dimensions of the state, counted from 0.
    #[must_use]
    pub const fn new(dimensions: &'a [usize], tilings: usize) -> Self {
        Self {
            dimensions,
            tilings,
        }
    }
}

/// How tiles find their slots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Table {
    /// Each tile has its own slot. [`Features::slots`] returns how many there are.
    Direct,
    /// All tiles share this many slots, from 2 to 65,536.
    Hashed(usize),
}

/// Slots that 16 bits can number.
const MAX_SLOTS: usize = 1 << 16;

/// The stride from tile to tile of a tiling. Its multiples modulo 2¹⁶ lie far apart, as those of the golden
/// ratio do (Knuth 6.4): it is the only factor whose continued fraction over 2¹⁶ has no quotient above 2.
const FACTOR: u16 = 0xb3f9;

/// The stride from tiling to tiling: 2¹⁶ over the golden ratio.
const GOLDEN: u16 = 0x9e37;

/// `T` tilings over a state of `D` numbers.
///
/// A tile's slot is linear in its coordinates: one product and one comparison for each dimension, in 16 bits, so
/// that eight tilings fit in the smallest vector register. Hashing only changes the factors and scales the sum at the end.
#[derive(Clone, Debug, PartialEq)]
pub struct TileCoder<const D: usize, const T: usize> {
    dimensions: [Dimension; D],
    /// Intervals for each unit of the state.
    per_unit: [f32; D],
    /// The offset of each tiling, in 2⁻¹⁶ intervals.
    offsets: [[u16; T]; D],
    /// How much the slot grows from one coordinate to the next; 0 in dimensions that a tiling ignores.
    strides: [[u16; T]; D],
    /// The slot of each tiling's first tile.
    bases: [u16; T],
    /// The slots that the sum's 2¹⁶ values are scaled to.
    range: u32,
    slots: usize,
}

impl<const D: usize, const T: usize> TileCoder<D, T> {
    /// Tilings in these groups, `T` in all. `offset` returns the offset of each in each dimension, from 0 to below
    /// 1 intervals; [`displacement`] is the usual function.
    ///
    /// # Errors
    ///
    /// [`Error`] for dimensions without extent or with other than 1 to 256 intervals, for no tilings or other than
    /// `T` in all, for an offset outside \[0, 1), for a hashed table with other than 2 to 65,536 slots, and for more
    /// than 65,536 slots without hashing.
    pub fn new(
        dimensions: [Dimension; D],
        groups: &[Group],
        table: Table,
        offset: impl FnMut(Place) -> f32,
    ) -> Result<Self, Error> {
        let mut coder = Self::grids(dimensions, groups, offset)?;
        match table {
            Table::Direct => coder.place(groups)?,
            Table::Hashed(slots) => coder.hash(slots)?,
        }
        Ok(coder)
    }

    /// Places the tilings in the table, one after the other.
    fn place(&mut self, groups: &[Group]) -> Result<(), Error> {
        let dimensions = &self.dimensions;
        let tiles = groups.iter().flat_map(|group| {
            let tiles = |&d: &usize| dimensions.get(d).map_or(1, |d| usize::from(d.tiles()));
            repeat_n(
                group.dimensions.iter().map(tiles).product::<usize>(),
                group.tilings,
            )
        });
        for (base, tiles) in self.bases.iter_mut().zip(tiles) {
            *base = self.slots as u16;
            self.slots += tiles;
            let fits = self.slots <= MAX_SLOTS;
            Error::unless(fits, "slots", self.slots, "at most", MAX_SLOTS)?;
        }
        Ok(())
    }

    fn hash(&mut self, slots: usize) -> Result<(), Error> {
        let fits = (2..=MAX_SLOTS).contains(&slots);
        Error::unless(fits, "slots", slots, "from 2 to", MAX_SLOTS)?;
        self.slots = slots;
        self.range = slots as u32;
        for (t, base) in self.bases.iter_mut().enumerate() {
            *base = (t as u16).wrapping_mul(GOLDEN);
        }
        for stride in self.strides.as_flattened_mut() {
            *stride = stride.wrapping_mul(FACTOR);
        }
        Ok(())
    }

    /// The tilings before they are placed in the table.
    fn grids(
        dimensions: [Dimension; D],
        groups: &[Group],
        mut offset: impl FnMut(Place) -> f32,
    ) -> Result<Self, Error> {
        // Saturating: a sum that wraps around to T would pass.
        let each = groups.iter().map(|group| group.tilings);
        let tilings = each.fold(0, usize::saturating_add);
        let fits = T > 0 && tilings == T;
        Error::unless(fits, "tilings", tilings, "above 0 and equal to", T)?;
        for dimension in &dimensions {
            dimension.check()?;
        }
        let mut coder = Self {
            dimensions,
            per_unit: dimensions.map(|d| f32::from(d.intervals) / (d.high - d.low)),
            offsets: [[0; T]; D],
            strides: [[0; T]; D],
            bases: [0; T],
            range: MAX_SLOTS as u32,
            slots: 0,
        };
        let mut first = 0;
        for (number, group) in groups.iter().enumerate() {
            let mut stride = 1;
            for (place, &d) in group.dimensions.iter().enumerate() {
                let (Some(dimension), Some(offsets), Some(strides)) = (
                    dimensions.get(d),
                    coder.offsets.get_mut(d),
                    coder.strides.get_mut(d),
                ) else {
                    return Err(Error::Count {
                        name: "a dimension's index",
                        value: d,
                        rule: "below",
                        limit: D,
                    });
                };
                for tiling in 0..group.tilings {
                    let offset = offset(Place {
                        group: number,
                        tiling,
                        tilings: group.tilings,
                        dimension: place,
                    });
                    if !(0.0..1.0).contains(&offset) {
                        return Err(Error::OutOfRange {
                            name: "an offset",
                            value: offset,
                            rule: "at least 0 and below 1 interval",
                        });
                    }
                    let t = first + tiling;
                    if let Some(moved) = offsets.get_mut(t) {
                        *moved = (offset * 65536.0) as u16;
                    }
                    if let Some(factor) = strides.get_mut(t) {
                        *factor = stride as u16;
                    }
                }
                stride *= usize::from(dimension.tiles());
                let fits = stride <= 1 << 16;
                Error::unless(fits, "tiles of a tiling", stride, "at most", 1 << 16)?;
            }
            first += group.tilings;
        }
        Ok(coder)
    }
}

/// The tiling and the dimension of an offset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// The group's index.
    pub group: usize,
    /// The tiling's index in the group.
    pub tiling: usize,
    /// The number of tilings in the group.
    pub tilings: usize,
    /// The dimension's index in the group.
    pub dimension: usize,
}

/// Displacement by the first odd integers (Sutton & Barto 9.5.4): among n tilings, the offset of tiling j is
/// j (1, 3, 5, 7, …) / n intervals, modulo 1.
#[must_use]
pub fn displacement(place: Place) -> f32 {
    let steps = place.tiling * (2 * place.dimension + 1);
    steps.checked_rem(place.tilings).unwrap_or(0) as f32 / place.tilings as f32
}

impl<const D: usize, const T: usize> Features<D, T> for TileCoder<D, T> {
    fn slots(&self) -> usize {
        self.slots
    }

    #[inline]
    fn active(&self, state: &[f32; D]) -> [u16; T] {
        let mut slots = self.bases;
        let scales = self.dimensions.iter().zip(&self.per_unit);
        let tilings = self.offsets.iter().zip(&self.strides);
        for ((x, (dimension, per_unit)), (offsets, strides)) in
            state.iter().zip(scales).zip(tilings)
        {
            let [whole, next, fraction] = dimension.locate(*x, *per_unit);
            for (slot, (&offset, &stride)) in slots.iter_mut().zip(offsets.iter().zip(strides)) {
                let (_, carried) = fraction.overflowing_add(offset);
                let coordinate = if carried { next } else { whole };
                *slot = slot.wrapping_add(coordinate.wrapping_mul(stride));
            }
        }
        slots.map(|slot| ((u32::from(slot) * self.range) >> 16) as u16)
    }

    fn fingerprint(&self, mut mix: impl FnMut(u32)) {
        let tilings = self.offsets.iter().zip(&self.strides);
        for (dimension, (offsets, strides)) in self.dimensions.iter().zip(tilings) {
            mix(dimension.low.to_bits());
            mix(dimension.high.to_bits());
            mix(u32::from(dimension.intervals) << 1 | u32::from(dimension.cyclic));
            for (&offset, &stride) in offsets.iter().zip(strides) {
                mix(u32::from(offset) << 16 | u32::from(stride));
            }
        }
        self.bases.iter().for_each(|&base| mix(u32::from(base)));
        mix(self.range);
    }
}
