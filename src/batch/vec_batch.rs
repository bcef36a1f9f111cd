//! A batch that owns its memory.

use alloc::vec::Vec;
use core::ops::{Deref, DerefMut};

use super::Batch;
use super::block::Block;
use super::buffers::StepBuffers;
use super::inputs::Input;
use super::lane_params::LaneParams;
use super::storage::{BatchMemory, OwnParams};
use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::numpy::{Pcg64, SeedSequence};
use crate::task::{Gymnasium, Observation, Task};

type Own<A, const N: usize> = OwnParams<Vec<LaneParams<A, N>>, <A as Arithmetic>::Scalar>;

type InVec<A, T, const N: usize> =
    BatchMemory<Vec<Block<A, N, <T as Task>::Memory>>, Vec<Pcg64>, Own<A, N>>;

type InVecs<A, T, const N: usize> = Batch<A, InVec<A, T, N>, T, N>;

/// A [`Batch`] in `Vec`s, with all its methods, whose steps return their results.
///
/// A [`Batch`] of another length may replace the one inside. The next results need new memory:
/// without it a step returns [`Error::OutOfMemory`], and the observations are empty.
///
/// ```
/// use acrobot::{Action, Fast, batch::VecBatch};
///
/// let mut batch = VecBatch::<Fast>::new(42, 1000)?;
/// let dtheta1 = batch.observations()[0][4]; // rad/s
/// let results = batch.step(&[Action::Positive; 1000])?;
/// assert_eq!(results.rewards, [-1.0; 1000]);
/// assert!(results.observations[0][4] != dtheta1);
/// # Ok::<(), acrobot::Error>(())
/// ```
///
/// [Another](crate::guide::rust#many-at-once) has own parameters for each acrobot.
#[derive(Clone, Debug)]
pub struct VecBatch<A: Arithmetic, T: Task = Gymnasium, const N: usize = 16> {
    batch: InVecs<A, T, N>,
    results: StepResults<T::Observation>,
}

/// The results of a step of a [`VecBatch`], as in [`StepBuffers`]. The next step overwrites them.
///
/// ```
/// use acrobot::Fast;
/// use acrobot::batch::{StepResults, VecBatch};
///
/// let mut batch = VecBatch::<Fast>::new(42, 3)?;
/// let StepResults { rewards, observations, .. } = batch.step(&[1.0_f32; 3])?; // N m
/// assert_eq!((&rewards[..], observations.len()), (&[-1.0; 3][..], 3));
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct StepResults<O = [f32; 6]> {
    /// The rewards.
    pub rewards: Vec<f32>,
    /// Whether the task ended each episode.
    pub terminated: Vec<bool>,
    /// Whether the time limit is reached.
    pub truncated: Vec<bool>,
    /// The observations of the new states.
    pub observations: Vec<O>,
    /// The last observations of episodes that this step ended. Those of other acrobots are older,
    /// or 0.
    pub final_observations: Vec<O>,
}

impl<O: Observation> StepResults<O> {
    fn new(len: usize) -> Result<Self, Error> {
        Ok(Self {
            rewards: fill(0.0, len, len)?,
            terminated: fill(false, len, len)?,
            truncated: fill(false, len, len)?,
            observations: fill(O::ZEROS, len, len)?,
            final_observations: fill(O::ZEROS, len, len)?,
        })
    }
}

fn memory<A: Arithmetic, T: Task, const N: usize>(len: usize) -> Result<InVec<A, T, N>, Error> {
    let blocks = fill(Block::EMPTY, len.div_ceil(N), len)?;
    let generators = fill(Pcg64::UNSEEDED, len, len)?;
    Ok(BatchMemory { blocks, generators, own: OwnParams::new(Vec::new()) })
}

impl<A: Arithmetic, T: Task, const N: usize> VecBatch<A, T, N> {
    /// A batch of `len` acrobots, with seeds and settings as those of [`Batch::new`].
    ///
    /// # Errors
    ///
    /// [`Error::EmptyBatch`] for a `len` of 0, and [`Error::OutOfMemory`].
    pub fn new(seed: impl Into<SeedSequence>, len: usize) -> Result<Self, Error> {
        Ok(Self {
            batch: Batch::new(seed, memory::<A, T, N>(len)?)?,
            results: StepResults::new(len)?,
        })
    }

    /// As [`new`](Self::new), for this task: see [`Batch::with_task`].
    pub fn with_task(seed: impl Into<SeedSequence>, task: T, len: usize) -> Result<Self, Error> {
        let batch = Batch::with_task(seed, task, memory::<A, T, N>(len)?)?;
        Ok(Self { batch, results: StepResults::new(len)? })
    }

    /// Allocates parameters for each acrobot, which [`set_params`](Batch::set_params) and
    /// [`set_draws`](Batch::set_draws) need. They begin as those that all share.
    ///
    /// ```
    /// # use acrobot::{Fast, Params, batch::VecBatch};
    /// let mut batch = VecBatch::<Fast>::new(42, 1000)?;
    /// batch.own_params()?;
    /// batch.set_params(7, Params { length1: 1.5, ..Params::DEFAULT })?; // m
    /// assert_eq!((batch.params(6)?.length1, batch.params(7)?.length1), (1.0, 1.5));
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::OutOfMemory`]. Then nothing changes.
    pub fn own_params(&mut self) -> Result<(), Error> {
        if let Some(model) = &self.batch.settings.shared {
            let len = self.batch.len();
            self.batch.storage.own.lane_params =
                fill(LaneParams::shared(model), len.div_ceil(N), len)?;
            self.batch.settings.shared = None;
        }
        Ok(())
    }

    /// Allocates new results if the batch has another length.
    fn fit_results(&mut self) -> Result<(), Error> {
        let len = self.batch.len();
        if self.results.rewards.len() != len {
            self.results = StepResults::new(len)?;
        }
        Ok(())
    }

    /// The observations of the states, for example after a reset.
    pub fn observations(&mut self) -> &[T::Observation] {
        let fits = self.fit_results();
        match fits.and_then(|()| self.batch.observe(&mut self.results.observations)) {
            Ok(()) => &self.results.observations,
            Err(_) => &[],
        }
    }

    /// Calls [`Batch::step_into`], with its errors and [`Error::OutOfMemory`], and returns the
    /// results.
    pub fn step<I: Input<A::Scalar>>(
        &mut self,
        inputs: &[I],
    ) -> Result<&StepResults<T::Observation>, Error> {
        self.step_by(|batch, buffers| batch.step_into(inputs, buffers))
    }

    /// As [`step`](Self::step), with its errors, on all cores: see [`Batch::par_step_into`].
    ///
    /// ```
    /// # use acrobot::{Action, Fast, batch::VecBatch};
    /// let mut batch = VecBatch::<Fast>::new(42, 20_000)?;
    /// let mut same = batch.clone();
    /// let actions = [Action::Positive; 20_000];
    /// assert_eq!(batch.par_step(&actions)?, same.step(&actions)?);
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    #[cfg(feature = "rayon")]
    pub fn par_step<I: Input<A::Scalar>>(
        &mut self,
        inputs: &[I],
    ) -> Result<&StepResults<T::Observation>, Error> {
        self.step_by(|batch, buffers| batch.par_step_into(inputs, buffers))
    }

    #[inline(always)]
    fn step_by<F>(&mut self, step: F) -> Result<&StepResults<T::Observation>, Error>
    where
        F: FnOnce(&mut InVecs<A, T, N>, StepBuffers<'_, T::Observation>) -> Result<(), Error>,
    {
        self.fit_results()?;
        let to = &mut self.results;
        let buffers = StepBuffers::new(&mut to.rewards, &mut to.terminated, &mut to.truncated)
            .with_observations(&mut to.observations)
            .with_final_observations(&mut to.final_observations);
        step(&mut self.batch, buffers)?;
        Ok(&self.results)
    }
}

impl<A: Arithmetic, T: Task, const N: usize> Deref for VecBatch<A, T, N> {
    type Target = InVecs<A, T, N>;

    fn deref(&self) -> &Self::Target {
        &self.batch
    }
}

impl<A: Arithmetic, T: Task, const N: usize> DerefMut for VecBatch<A, T, N> {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.batch
    }
}

/// `count` copies of a value, if they fit into memory.
fn fill<T: Clone>(value: T, count: usize, len: usize) -> Result<Vec<T>, Error> {
    let mut vec = Vec::new();
    let reserved = vec.try_reserve_exact(count);
    reserved.map_err(|_| Error::OutOfMemory { of: "acrobots", len })?;
    vec.resize(count, value);
    Ok(vec)
}
