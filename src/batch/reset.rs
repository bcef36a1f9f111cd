//! Resets of all acrobots of a batch, or of some.

use super::buffers::check_length;
use super::storage::Storage;
use super::{Batch, each_block};
use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::numpy::SeedSequence;
use crate::physics::State;
use crate::task::{ResetOptions, Task};

impl<A: Arithmetic, S: Storage<A, N, T::Memory>, T: Task, const N: usize> Batch<A, S, T, N> {
    /// Resets all acrobots, each with the next draws of its stream.
    ///
    /// ```
    /// # use acrobot::Fast;
    /// # use acrobot::batch::{Batch, BatchMemory, Block};
    /// # use acrobot::numpy::Pcg64;
    /// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
    /// let mut batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
    /// let first = batch.state(0)?;
    /// batch.reset();
    /// assert_ne!(batch.state(0)?, first);
    /// batch.reset_with_seed(42);
    /// assert_eq!(batch.state(0)?, first);
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    pub fn reset(&mut self) {
        self.reset_with(ResetOptions::default());
    }

    /// Seeds acrobot `i` with the `i`-th child of `seed`, and resets all.
    pub fn reset_with_seed(&mut self, seed: impl Into<SeedSequence>) {
        self.reset_with(seed.into().into());
    }

    /// Gymnasium's `reset(seed=…, options=…)` for all acrobots. A seed seeds acrobot `i` with the
    /// `i`-th child that the seed has not yet spawned.
    ///
    /// ```
    /// # use acrobot::Fast;
    /// # use acrobot::batch::{Batch, BatchMemory, Block};
    /// # use acrobot::numpy::Pcg64;
    /// # use acrobot::task::{ResetBounds, ResetOptions};
    /// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
    /// let mut batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
    /// let bounds = Some(ResetBounds::new(0.3, 0.4)?); // rad and rad/s
    /// batch.reset_with(ResetOptions { bounds, ..7.into() });
    /// assert!((0.3..=0.4).contains(&batch.state(0)?.theta1));
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    pub fn reset_with(&mut self, options: ResetOptions) {
        self.reset_lanes(core::iter::repeat(true), options);
    }

    /// As [`reset_with`](Self::reset_with), for the acrobots whose element of `mask` is true:
    /// Gymnasium's `reset(options={"reset_mask": mask})`. The others do not change.
    ///
    /// ```
    /// # use acrobot::batch::{Batch, BatchMemory, Block};
    /// # use acrobot::numpy::{Pcg64, SeedSequence};
    /// # use acrobot::{Acrobot, Fast};
    /// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
    /// let mut batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
    /// batch.reset_masked(&[true, false, false], 7.into())?;
    /// let alone = Acrobot::<Fast>::new(SeedSequence::new(7).child(0));
    /// assert_eq!(batch.state(0)?, alone.state());
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] unless `mask` has one element for each acrobot.
    pub fn reset_masked(&mut self, mask: &[bool], options: ResetOptions) -> Result<(), Error> {
        check_length("mask", mask.len(), self.len())?;
        self.reset_lanes(mask.iter().copied(), options);
        Ok(())
    }

    fn reset_lanes(&mut self, mut mask: impl Iterator<Item = bool>, options: ResetOptions) {
        let bounds = options.bounds.unwrap_or(self.settings.bounds);
        let mut children = options.seed.map(|mut seed| seed.spawn(u64::MAX));
        for (block, generators, own) in each_block(&mut self.storage) {
            let mut lanes = [true; N];
            for (resets, rng) in lanes.iter_mut().zip(&mut *generators) {
                *resets = mask.next().unwrap_or(true);
                let child = children.as_mut().and_then(Iterator::next);
                if let Some(child) = child.filter(|_| *resets) {
                    *rng = child.into();
                }
            }
            block.reset(&lanes, &self.settings, bounds, generators, own);
        }
    }

    /// Begins an episode of each acrobot in a given state. Draws nothing.
    ///
    /// ```
    /// # use acrobot::batch::{Batch, BatchMemory, Block};
    /// # use acrobot::numpy::Pcg64;
    /// # use acrobot::{Fast, State};
    /// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
    /// let mut batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
    /// batch.reset_to(&[State::HANGING, State::UPRIGHT, State::HANGING])?;
    /// assert_eq!(batch.state(1)?, State::UPRIGHT);
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] unless there is one state for each acrobot, and [`Error::OutOfRange`]
    /// for a number that is not finite.
    pub fn reset_to(&mut self, states: &[State<A::Scalar>]) -> Result<(), Error> {
        check_length("states", states.len(), self.len())?;
        states.iter().try_for_each(State::validate)?;
        let mut states = states.iter();
        for block in self.storage.slices_mut().blocks {
            for (lane, state) in states.by_ref().take(N).enumerate() {
                block.begin(lane, &self.settings.task, *state, None);
                block.set_progress(lane, 0, false);
            }
        }
        Ok(())
    }
}
