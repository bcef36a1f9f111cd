//! The parameters of a batch: those that all acrobots share, or of each, and what resets draw.

use super::Batch;
use super::lane_params::LaneParams;
use super::storage::Storage;
use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::physics::{Params, check_params, model};
use crate::task::{Draws, Task};

impl<A: Arithmetic, S: Storage<A, N, T::Memory>, T: Task, const N: usize> Batch<A, S, T, N> {
    /// The parameters of acrobot `index`, or [`Error::NoSuchIndex`].
    pub fn params(&self, index: usize) -> Result<Params<A::Scalar>, Error> {
        self.block_and_rng(index)?;
        if let Some(model) = &self.settings.shared {
            return Ok(model.params);
        }
        let own = self.storage.slices().lane_params.get(index / N).ok_or(Error::SharedParams)?;
        Ok(own.get(index % N))
    }

    /// Whether each acrobot has its own parameters. Otherwise all share theirs.
    #[must_use]
    pub fn has_own_params(&self) -> bool {
        self.settings.shared.is_none()
    }

    /// Sets the parameters of all acrobots for the next steps, with the errors of
    /// [`Pendulum::set_params`](crate::physics::Pendulum::set_params).
    ///
    /// ```
    /// # use acrobot::batch::{Batch, BatchMemory, Block};
    /// # use acrobot::numpy::Pcg64;
    /// # use acrobot::{Fast, Params};
    /// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
    /// let mut batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
    /// batch.set_all_params(Params { dt: 0.05, ..Params::DEFAULT })?; // s
    /// assert_eq!((batch.params(2)?.dt, batch.has_own_params()), (0.05, false));
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    pub fn set_all_params(&mut self, params: Params<A::Scalar>) -> Result<(), Error> {
        self.check_params(&params)?;
        let model = model::<A>(params);
        let lane_params = self.storage.slices_mut().lane_params;
        lane_params.fill(LaneParams::shared(&model));
        if let Some(shared) = &mut self.settings.shared {
            *shared = model;
        }
        Ok(())
    }

    /// Sets the parameters of acrobot `index` for the next steps: [an
    /// example](super::OwnParams).
    ///
    /// # Errors
    ///
    /// Those of [`set_all_params`](Self::set_all_params), [`Error::NoSuchIndex`], and
    /// [`Error::SharedParams`] without memory for [`LaneParams`].
    pub fn set_params(&mut self, index: usize, params: Params<A::Scalar>) -> Result<(), Error> {
        self.check_params(&params)?;
        self.block_and_rng(index)?;
        let lane_params = self.storage.slices_mut().lane_params;
        let own = lane_params.get_mut(index / N).ok_or(Error::SharedParams)?;
        own.set(index % N, params);
        Ok(())
    }

    /// Checks parameters, and what the draws can make of them.
    pub(super) fn check_params(&self, params: &Params<A::Scalar>) -> Result<(), Error> {
        check_params::<A>(params)?;
        self.draws().check::<A>(params)
    }

    /// What each reset draws of the parameters.
    #[must_use]
    pub fn draws(&self) -> &Draws<A::Scalar> {
        self.storage.slices().draws.unwrap_or(&Draws::NONE)
    }

    /// Sets what each reset, also one in a step, draws of the acrobot's parameters after its
    /// initial state.
    ///
    /// ```
    /// # use acrobot::batch::{Batch, BatchMemory, Block, LaneParams, OwnParams};
    /// # use acrobot::numpy::Pcg64;
    /// # use acrobot::task::{Draw, Draws};
    /// # use acrobot::{Fast, Params};
    /// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
    /// let own = OwnParams::new([LaneParams::default()]);
    /// let mut batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own })?;
    /// let mass2 = Draw::Uniform { low: 0.8, high: 1.2 }; // kg
    /// batch.set_draws(Draws::new(Params { mass2, ..Draws::FIXED })?)?;
    /// batch.reset();
    /// assert!(batch.params(0)?.mass2 != batch.params(1)?.mass2);
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`set_all_params`](Self::set_all_params), for what the draws can make of the
    /// parameters of each acrobot, and [`Error::SharedParams`] without memory for [`LaneParams`].
    pub fn set_draws(&mut self, draws: Draws<A::Scalar>) -> Result<(), Error> {
        let count = if self.has_own_params() { self.len() } else { 1 };
        for index in 0..count {
            draws.check::<A>(&self.params(index)?)?;
        }
        match (&self.settings.shared, self.storage.slices_mut().draws) {
            (None, Some(own)) => *own = draws,
            _ if draws == Draws::NONE => {}
            _ => return Err(Error::SharedParams),
        }
        Ok(())
    }
}
