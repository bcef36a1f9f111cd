//! The settings that all acrobots of a batch share.

use core::num::NonZeroU32;

use super::{Autoreset, Batch, Block, SimdLevel, each_block};
use crate::arithmetic::{Arithmetic, Model};
use crate::error::Error;
use crate::numpy::Pcg64;
use crate::physics::{Params, ResetBounds};

impl<A, B, G, const N: usize> Batch<A, B, G, N>
where
    A: Arithmetic,
    B: AsRef<[Block<A::Scalar, N>]> + AsMut<[Block<A::Scalar, N>]>,
    G: AsRef<[Pcg64]> + AsMut<[Pcg64]>,
{
    /// The parameters of all acrobots.
    #[must_use]
    pub fn params(&self) -> &Params<A::Scalar> {
        &self.shared.model.params
    }

    /// Sets the parameters of all acrobots for the next steps.
    ///
    /// # Errors
    ///
    /// Those of [`Params::validate`].
    pub fn set_params(&mut self, params: Params<A::Scalar>) -> Result<(), Error> {
        params.validate()?;
        self.shared.model = Model::new(params);
        Ok(())
    }

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
        self.shared.bounds
    }

    /// Sets the bounds of initial states for the next resets.
    pub fn set_reset_bounds(&mut self, bounds: ResetBounds) {
        self.shared.bounds = bounds;
    }

    /// The number of steps after which episodes are truncated.
    #[must_use]
    pub fn limit(&self) -> NonZeroU32 {
        self.shared.limit
    }

    /// Sets the number of steps after which episodes are truncated.
    pub fn set_limit(&mut self, limit: NonZeroU32) {
        self.shared.limit = limit;
    }

    /// When ended episodes are reset.
    #[must_use]
    pub fn autoreset(&self) -> Autoreset {
        self.shared.autoreset
    }

    /// Sets when ended episodes are reset. Acrobots whose reset is pending are reset immediately by
    /// [`Autoreset::SameStep`], and never by [`Autoreset::Disabled`].
    pub fn set_autoreset(&mut self, autoreset: Autoreset) {
        self.shared.autoreset = autoreset;
        for (block, generators) in each_block(self.blocks.as_mut(), self.generators.as_mut()) {
            block.stop_waiting::<A>(&self.shared, generators);
        }
    }
}
