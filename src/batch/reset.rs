//! Resets of all acrobots of a batch, or of some.

use super::buffers::check_length;
use super::{Batch, Block, ParamsKind, each_block};
use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::numpy::{Pcg64, SeedSequence};
use crate::physics::{ResetBounds, State};
use crate::reset_options::ResetOptions;

impl<A, B, G, const N: usize, P> Batch<A, B, G, N, P>
where
    A: Arithmetic,
    B: AsRef<[Block<A, N, P>]> + AsMut<[Block<A, N, P>]>,
    G: AsRef<[Pcg64]> + AsMut<[Pcg64]>,
    P: ParamsKind<A>,
{
    /// Resets all acrobots, each with the next draws of its stream.
    pub fn reset(&mut self) {
        self.reset_with(ResetOptions::default());
    }

    /// Resets all acrobots, with initial states from `bounds`. Later resets draw from
    /// [`reset_bounds`](Self::reset_bounds) again.
    pub fn reset_within(&mut self, bounds: ResetBounds) {
        self.reset_with(ResetOptions {
            seed: None,
            bounds: Some(bounds),
        });
    }

    /// Seeds acrobot `i` with the `i`-th child of `seed`, and resets all.
    pub fn reset_with_seed(&mut self, seed: u64) {
        self.reset_with(ResetOptions {
            seed: Some(SeedSequence::new(seed)),
            bounds: None,
        });
    }

    /// Gymnasium's `reset(seed=…, options=…)` for all acrobots. A seed seeds acrobot `i` with the `i`-th child that the
    /// seed has not yet spawned. Without bounds, initial states are from [`reset_bounds`](Self::reset_bounds).
    pub fn reset_with(&mut self, options: ResetOptions) {
        self.reset_some(core::iter::repeat(true), options);
    }

    /// As [`reset_with`](Self::reset_with), for the acrobots whose element of `mask` is true: Gymnasium's
    /// `reset(options={"reset_mask": mask})`. The others do not change.
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] unless `mask` has one element for each acrobot.
    pub fn reset_masked(&mut self, mask: &[bool], options: ResetOptions) -> Result<(), Error> {
        check_length("mask", mask.len(), self.len())?;
        self.reset_some(mask.iter().copied(), options);
        Ok(())
    }

    fn reset_some(&mut self, mut mask: impl Iterator<Item = bool>, options: ResetOptions) {
        let bounds = options.bounds.unwrap_or(self.settings.bounds);
        let mut children = options.seed.map(|mut seed| seed.spawn(u64::MAX));
        for (block, generators) in
            each_block::<_, N>(self.blocks.as_mut(), self.generators.as_mut())
        {
            let mut some = [true; N];
            for (some, rng) in some.iter_mut().zip(&mut *generators) {
                *some = mask.next().unwrap_or(true);
                let child = children.as_mut().and_then(Iterator::next);
                if let Some(child) = child.filter(|_| *some) {
                    *rng = child.into();
                }
            }
            block.reset(&some, &self.settings.params, bounds, generators);
        }
    }

    /// Begins an episode of each acrobot in a given state, for example to search on the model.
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] unless there is one state for each acrobot, and [`Error::OutOfRange`] for a number that
    /// is not finite.
    pub fn reset_to(&mut self, states: &[State<A::Scalar>]) -> Result<(), Error> {
        self.reset_some_to(core::iter::repeat(true), states)
    }

    /// As [`reset_to`](Self::reset_to), for the acrobots whose element of `mask` is true. The states of the others are
    /// ignored, but must be finite.
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] unless each slice has one element for each acrobot, and [`Error::OutOfRange`] for a
    /// number that is not finite.
    pub fn reset_to_masked(
        &mut self,
        mask: &[bool],
        states: &[State<A::Scalar>],
    ) -> Result<(), Error> {
        check_length("mask", mask.len(), self.len())?;
        self.reset_some_to(mask.iter().copied(), states)
    }

    fn reset_some_to(
        &mut self,
        mask: impl Iterator<Item = bool>,
        states: &[State<A::Scalar>],
    ) -> Result<(), Error> {
        check_length("states", states.len(), self.len())?;
        states.iter().try_for_each(State::validate)?;
        let mut states = mask.zip(states);
        for block in self.blocks.as_mut() {
            for (lane, (some, state)) in states.by_ref().take(N).enumerate() {
                if some {
                    block.resume(lane, *state, (0, false));
                }
            }
        }
        Ok(())
    }
}
