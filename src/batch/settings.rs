//! What all acrobots of a batch have in common, to read and to change.

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

    /// Sets the parameters of all acrobots, from the next step on.
    ///
    /// # Errors
    ///
    /// As [`Params::validate`].
    pub fn set_params(&mut self, params: Params<A::Scalar>) -> Result<(), Error> {
        params.validate()?;
        self.shared.model = Model::new(params);
        Ok(())
    }

    /// The SIMD instructions to step with.
    #[must_use]
    pub fn simd_level(&self) -> SimdLevel {
        self.simd_level
    }

    /// Sets the SIMD instructions to step with. A level that the machine does not have acts as the baseline.
    pub fn set_simd_level(&mut self, level: SimdLevel) {
        self.simd_level = level;
    }

    /// The bounds of initial states.
    #[must_use]
    pub fn reset_bounds(&self) -> ResetBounds {
        self.shared.bounds
    }

    /// Sets the bounds of initial states, from the next reset on.
    pub fn set_reset_bounds(&mut self, bounds: ResetBounds) {
        self.shared.bounds = bounds;
    }

    /// The steps after which episodes are truncated.
    #[must_use]
    pub fn limit(&self) -> NonZeroU32 {
        self.shared.limit
    }

    /// Sets the steps after which episodes are truncated.
    pub fn set_limit(&mut self, limit: NonZeroU32) {
        self.shared.limit = limit;
    }

    /// When ended episodes are reset.
    #[must_use]
    pub fn autoreset(&self) -> Autoreset {
        self.shared.autoreset
    }

    /// Sets when ended episodes are reset. Of the acrobots that wait for the next step to reset them,
    /// [`Autoreset::SameStep`] resets all immediately, and with [`Autoreset::Disabled`] all step on.
    pub fn set_autoreset(&mut self, autoreset: Autoreset) {
        self.shared.autoreset = autoreset;
        for (block, generators) in each_block(self.blocks.as_mut(), self.generators.as_mut()) {
            block.stop_waiting::<A>(&self.shared, generators);
        }
    }
}
