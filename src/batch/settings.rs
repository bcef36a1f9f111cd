//! The settings that all acrobots of a batch share.

use core::num::NonZeroU32;

use super::{Autoreset, Batch, Block, ParamsKind, SimdLevel, each_block};
use crate::arithmetic::Arithmetic;
use crate::numpy::Pcg64;
use crate::physics::ResetBounds;

impl<A, B, G, const N: usize, P> Batch<A, B, G, N, P>
where
    A: Arithmetic,
    B: AsRef<[Block<A, N, P>]> + AsMut<[Block<A, N, P>]>,
    G: AsRef<[Pcg64]> + AsMut<[Pcg64]>,
    P: ParamsKind<A>,
{
    /// The SIMD instructions that a step uses.
    #[must_use]
    pub fn simd_level(&self) -> SimdLevel {
        self.simd_level
    }

    /// Sets the SIMD instructions that a step uses. A level that the machine does not have acts as the baseline.
    pub fn set_simd_level(&mut self, level: SimdLevel) {
        self.simd_level = level;
    }

    /// The bounds of initial states.
    #[must_use]
    pub fn reset_bounds(&self) -> ResetBounds {
        self.settings.bounds
    }

    /// Sets the bounds of initial states for the next resets.
    pub fn set_reset_bounds(&mut self, bounds: ResetBounds) {
        self.settings.bounds = bounds;
    }

    /// The number of steps after which episodes are truncated.
    #[must_use]
    pub fn limit(&self) -> NonZeroU32 {
        self.settings.limit
    }

    /// Sets the number of steps after which episodes are truncated.
    pub fn set_limit(&mut self, limit: NonZeroU32) {
        self.settings.limit = limit;
    }

    /// When ended episodes are reset.
    #[must_use]
    pub fn autoreset(&self) -> Autoreset {
        self.settings.autoreset
    }

    /// Sets when ended episodes are reset. Acrobots whose reset is pending are reset immediately by
    /// [`Autoreset::SameStep`], and never by [`Autoreset::Disabled`].
    pub fn set_autoreset(&mut self, autoreset: Autoreset) {
        self.settings.autoreset = autoreset;
        for (block, generators) in
            each_block::<_, N>(self.blocks.as_mut(), self.generators.as_mut())
        {
            block.stop_waiting(&self.settings, generators);
        }
    }
}
