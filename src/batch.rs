//! Many acrobots at once, each bit-identical to one alone.
//!
//! A [`Batch`] steps acrobots side by side, with SIMD and without a heap: it borrows or owns arrays, slices or
//! `Vec`s. Acrobot `i` is bit-identical to an [`Acrobot`](crate::Acrobot) seeded with the seed's `i`-th child.
//!
//! ```
//! use acrobot::Fast;
//! use acrobot::batch::{Batch, Block, Observations, StepBuffers};
//! use acrobot::numpy::Pcg64;
//!
//! let (blocks, generators) = ([Block::EMPTY; 4], [Pcg64::UNSEEDED; 50]);
//! let mut batch = Batch::<Fast, _, _>::new(42, blocks, generators)?;
//! let (mut rewards, mut terminated, mut truncated) = ([0.0; 50], [false; 50], [false; 50]);
//! let mut observations = [[0.0; 6]; 50];
//! batch.step(
//!     &[2_u8; 50],
//!     StepBuffers {
//!         rewards: &mut rewards,
//!         terminated: &mut terminated,
//!         truncated: &mut truncated,
//!         observations: Observations::Rows(&mut observations),
//!         final_observations: Observations::None,
//!     },
//! )?;
//! assert_eq!(rewards, [-1.0; 50]);
//! # Ok::<(), acrobot::Error>(())
//! ```

mod block;
mod member;
mod simd;

use core::num::NonZeroU32;

pub use block::Block;
pub use member::Member;
pub use simd::SimdLevel;

use crate::acrobot::ResetOptions;
use crate::arithmetic::{Arithmetic, Model, Real};
use crate::error::Error;
use crate::numpy::{Pcg64, SeedSequence};
use crate::physics::{Params, StartBounds, State, check_torque};
use crate::time_limit::V1;
use block::{Actions, Drive, Torques};

/// When a batch resets an acrobot whose episode has ended: Gymnasium's `AutoresetMode`.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Autoreset {
    /// In the next step, which ignores its action and returns the initial state, with a reward of 0.
    #[default]
    NextStep,
    /// In the step that ends the episode. It returns the initial state as its observation, and the last observation
    /// of the episode in [`final_observations`](StepBuffers::final_observations).
    SameStep,
    /// Never. Acrobots step on after their ends, as an [`Acrobot`](crate::Acrobot) does, until
    /// [`Batch::reset_masked`] or another reset.
    Disabled,
}

/// Where a step of a [`Batch`] writes its results. Each slice has one element for each acrobot.
#[derive(Debug)]
pub struct StepBuffers<'a> {
    /// −1, or 0 for the step that reaches the goal and for one that only resets.
    pub rewards: &'a mut [f32],
    /// Whether the new state is in the goal.
    pub terminated: &'a mut [bool],
    /// Whether the time limit is reached.
    pub truncated: &'a mut [bool],
    /// What the agents see of the new states.
    pub observations: Observations<'a>,
    /// The last observations of the episodes that this step ended, with [`Autoreset::SameStep`] only. Elements of
    /// other acrobots stay as they are.
    pub final_observations: Observations<'a>,
}

/// Where a [`Batch`] writes [observations](crate::Observation).
#[derive(Debug)]
pub enum Observations<'a> {
    /// Nowhere: they are not computed.
    None,
    /// Six numbers for each acrobot.
    Rows(&'a mut [[f32; 6]]),
    /// Six slices with one number for each acrobot.
    Columns([&'a mut [f32]; 6]),
}

/// Many acrobots with the same parameters, each with its own stream of random numbers.
///
/// Acrobot `i` is bit-identical to an [`Acrobot`](crate::Acrobot) seeded with the seed's `i`-th child, under a
/// [`TimeLimit`](crate::TimeLimit). A batch steps `N` acrobots side by side, with the widest SIMD instructions that
/// the machine has if the `std` feature is on. Neither `N` nor the instructions change a bit.
///
/// `B` holds a [`Block`] for each `N` acrobots, and `G` a generator for each acrobot: arrays, slices or `Vec`s. They
/// are separate because a step seldom draws. [An example](self).
#[derive(Clone, Debug)]
pub struct Batch<A: Arithmetic, B, G, const N: usize = 16> {
    shared: Shared<A>,
    simd_level: SimdLevel,
    blocks: B,
    generators: G,
}

/// What all acrobots of a batch have in common.
#[derive(Clone, Debug)]
struct Shared<A: Arithmetic> {
    model: Model<A>,
    bounds: StartBounds,
    limit: NonZeroU32,
    autoreset: Autoreset,
}

impl<A, B, G, const N: usize> Batch<A, B, G, N>
where
    A: Arithmetic,
    B: AsRef<[Block<A::Scalar, N>]> + AsMut<[Block<A::Scalar, N>]>,
    G: AsRef<[Pcg64]> + AsMut<[Pcg64]>,
{
    /// A batch of as many acrobots as `generators`, which it seeds. It has the default parameters, a limit of 500
    /// steps and [`Autoreset::NextStep`].
    ///
    /// # Errors
    ///
    /// [`Error::EmptyBatch`] without generators, and [`Error::WrongLength`] unless there is one block for each `N`
    /// generators; the last may be filled in part.
    pub fn new(seed: u64, blocks: B, generators: G) -> Result<Self, Error> {
        const { assert!(N > 0, "a block holds at least one acrobot") };
        let len = generators.as_ref().len();
        if len == 0 {
            return Err(Error::EmptyBatch);
        }
        check_length("blocks", blocks.as_ref().len(), len.div_ceil(N))?;
        let mut batch = Self {
            shared: Shared {
                model: Model::DEFAULT,
                bounds: StartBounds::DEFAULT,
                limit: V1,
                autoreset: Autoreset::default(),
            },
            simd_level: SimdLevel::widest(),
            blocks,
            generators,
        };
        batch.reset_with_seed(seed);
        Ok(batch)
    }

    /// The number of acrobots.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "no batch is empty")]
    pub fn len(&self) -> usize {
        self.generators.as_ref().len()
    }

    /// Resets all acrobots, each with the next draws of its own stream.
    pub fn reset(&mut self) {
        self.reset_within(self.shared.bounds);
    }

    /// Resets all acrobots, with initial states from `bounds`. Later resets draw from
    /// [`start_bounds`](Self::start_bounds) again.
    pub fn reset_within(&mut self, bounds: StartBounds) {
        for (block, generators) in self.each_block() {
            block.reset::<A>(&[true; N], bounds, generators);
        }
    }

    /// Seeds acrobot `i` with the `i`-th child of `seed`, and resets all.
    pub fn reset_with_seed(&mut self, seed: u64) {
        self.seed(SeedSequence::new(seed));
        self.reset();
    }

    /// Gymnasium's `reset(seed=…, options=…)`: seeds as [`reset_with_seed`](Self::reset_with_seed) if there is a
    /// seed, and resets all within `options.bounds`.
    pub fn reset_with(&mut self, options: ResetOptions) {
        if let Some(seed) = options.seed {
            self.seed(seed);
        }
        self.reset_within(options.bounds);
    }

    fn seed(&mut self, mut seed: SeedSequence) {
        let children = seed.spawn(u64::MAX);
        for (rng, seed) in self.generators.as_mut().iter_mut().zip(children) {
            *rng = seed.into();
        }
    }

    /// Resets the acrobots whose element of `mask` is true: Gymnasium's `reset(options={"reset_mask": mask})`.
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] unless `mask` has one element for each acrobot.
    pub fn reset_masked(&mut self, mask: &[bool]) -> Result<(), Error> {
        check_length("mask", mask.len(), self.len())?;
        let bounds = self.shared.bounds;
        for ((block, generators), mask) in self.each_block().zip(mask.chunks(N)) {
            let mut some = [false; N];
            some.iter_mut().zip(mask).for_each(|(to, from)| *to = *from);
            block.reset::<A>(&some, bounds, generators);
        }
        Ok(())
    }

    /// Begins an episode of each acrobot in a given state: for searches on the model.
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] unless there is one state for each acrobot, and [`Error::OutOfRange`] for a number that
    /// is not finite.
    pub fn reset_to(&mut self, states: &[State<A::Scalar>]) -> Result<(), Error> {
        check_length("states", states.len(), self.len())?;
        states.iter().try_for_each(State::validate)?;
        let blocks = self.blocks.as_mut().iter_mut();
        for (block, states) in blocks.zip(states.chunks(N)) {
            block.reset_to::<A>(states);
        }
        Ok(())
    }

    /// Applies an action to each acrobot for one dt: the numbers 0, 1 and 2, or [`Action`](crate::Action)s.
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] unless each slice has one element for each acrobot, and [`Error::UnknownAction`] for a
    /// number above 2.
    pub fn step<T: Copy + Into<u8> + Sync>(
        &mut self,
        actions: &[T],
        buffers: StepBuffers<'_>,
    ) -> Result<(), Error> {
        check_actions(actions)?;
        self.drive::<Actions<T>>(actions, buffers)
    }

    /// Applies a torque in N m, of any size, to each acrobot for one dt: for controllers.
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] unless each slice has one element for each acrobot, and [`Error::OutOfRange`] for a
    /// torque that is not finite.
    pub fn step_torques(
        &mut self,
        torques: &[A::Scalar],
        buffers: StepBuffers<'_>,
    ) -> Result<(), Error> {
        check_torques(torques)?;
        self.drive::<Torques>(torques, buffers)
    }

    /// [`step`](Self::step) on all cores, by rayon. The number of threads changes no bit.
    ///
    /// # Errors
    ///
    /// As [`step`](Self::step).
    #[cfg(feature = "rayon")]
    pub fn par_step<T: Copy + Into<u8> + Sync>(
        &mut self,
        actions: &[T],
        buffers: StepBuffers<'_>,
    ) -> Result<(), Error> {
        check_actions(actions)?;
        self.par_drive::<Actions<T>>(actions, buffers)
    }

    /// [`step_torques`](Self::step_torques) on all cores, by rayon. The number of threads changes no bit.
    ///
    /// # Errors
    ///
    /// As [`step_torques`](Self::step_torques).
    #[cfg(feature = "rayon")]
    pub fn par_step_torques(
        &mut self,
        torques: &[A::Scalar],
        buffers: StepBuffers<'_>,
    ) -> Result<(), Error> {
        check_torques(torques)?;
        self.par_drive::<Torques>(torques, buffers)
    }

    fn drive<D: Drive<A::Scalar>>(
        &mut self,
        inputs: &[D::Input],
        buffers: StepBuffers<'_>,
    ) -> Result<(), Error> {
        check_length(D::NAME, inputs.len(), self.len())?;
        buffers.check(self.len())?;
        let (blocks, generators) = (self.blocks.as_mut(), self.generators.as_mut());
        self.simd_level
            .step::<A, D, N>(&self.shared, blocks, generators, inputs, buffers);
        Ok(())
    }

    #[cfg(feature = "rayon")]
    fn par_drive<D: Drive<A::Scalar>>(
        &mut self,
        inputs: &[D::Input],
        buffers: StepBuffers<'_>,
    ) -> Result<(), Error> {
        check_length(D::NAME, inputs.len(), self.len())?;
        buffers.check(self.len())?;
        let (blocks, generators) = (self.blocks.as_mut(), self.generators.as_mut());
        self.simd_level
            .par_step::<A, D, N>(&self.shared, blocks, generators, inputs, buffers);
        Ok(())
    }

    /// Writes what the agents see of the states.
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] unless each slice has one element for each acrobot.
    pub fn observe(&self, mut observations: Observations<'_>) -> Result<(), Error> {
        observations.check("observations", self.len())?;
        for (number, block) in self.blocks.as_ref().iter().enumerate() {
            block.observe(number, &mut observations);
        }
        Ok(())
    }

    /// The state of acrobot `index`, if there is one.
    #[must_use]
    pub fn state(&self, index: usize) -> Option<State<A::Scalar>> {
        if index >= self.len() {
            return None;
        }
        let block = self.blocks.as_ref().get(index / N)?;
        Some(block.state(index % N))
    }

    /// Sets the state of acrobot `index`. Its episode goes on: its steps, and a reset that it waits for, stay.
    ///
    /// # Errors
    ///
    /// [`Error::NoSuchIndex`] for an index of at least [`len`](Self::len), and [`Error::OutOfRange`] for a number
    /// that is not finite.
    pub fn set_state(&mut self, index: usize, state: State<A::Scalar>) -> Result<(), Error> {
        state.validate()?;
        let len = self.len();
        match self.blocks.as_mut().get_mut(index / N) {
            Some(block) if index < len => block.set_state::<A>(index % N, state),
            _ => return Err(no_such_member(index, len)),
        }
        Ok(())
    }

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
    pub fn start_bounds(&self) -> StartBounds {
        self.shared.bounds
    }

    /// Sets the bounds of initial states, from the next reset on.
    pub fn set_start_bounds(&mut self, bounds: StartBounds) {
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
        let blocks = self.blocks.as_mut().iter_mut();
        for (block, generators) in blocks.zip(self.generators.as_mut().chunks_mut(N)) {
            block.stop_waiting::<A>(&self.shared, generators);
        }
    }

    /// Each block with its generators.
    fn each_block(&mut self) -> impl Iterator<Item = (&mut Block<A::Scalar, N>, &mut [Pcg64])> {
        let blocks = self.blocks.as_mut().iter_mut();
        blocks.zip(self.generators.as_mut().chunks_mut(N))
    }
}

fn check_actions(actions: &[impl Copy + Into<u8>]) -> Result<(), Error> {
    let numbers = actions.iter().map(|&action| action.into());
    match numbers.fold(0, u8::max) {
        0..=2 => Ok(()),
        highest => Err(Error::UnknownAction(highest)),
    }
}

fn check_torques<S: Real>(torques: &[S]) -> Result<(), Error> {
    torques.iter().try_for_each(|torque| check_torque(*torque))
}

fn check_length(name: &'static str, len: usize, expected: usize) -> Result<(), Error> {
    if len == expected {
        Ok(())
    } else {
        Err(Error::WrongLength {
            name,
            len,
            expected,
        })
    }
}

fn no_such_member(index: usize, len: usize) -> Error {
    Error::NoSuchIndex {
        name: "member",
        index,
        len,
    }
}

impl StepBuffers<'_> {
    /// The buffers of the acrobots before an index, and of the others.
    #[cfg(feature = "rayon")]
    fn split_at(self, index: usize) -> (Self, Self) {
        let (rewards1, rewards2) = self.rewards.split_at_mut(index);
        let (terminated1, terminated2) = self.terminated.split_at_mut(index);
        let (truncated1, truncated2) = self.truncated.split_at_mut(index);
        let (observations1, observations2) = self.observations.split_at(index);
        let (finals1, finals2) = self.final_observations.split_at(index);
        let before = Self {
            rewards: rewards1,
            terminated: terminated1,
            truncated: truncated1,
            observations: observations1,
            final_observations: finals1,
        };
        let after = Self {
            rewards: rewards2,
            terminated: terminated2,
            truncated: truncated2,
            observations: observations2,
            final_observations: finals2,
        };
        (before, after)
    }

    fn check(&self, len: usize) -> Result<(), Error> {
        check_length("rewards", self.rewards.len(), len)?;
        check_length("terminated", self.terminated.len(), len)?;
        check_length("truncated", self.truncated.len(), len)?;
        self.observations.check("observations", len)?;
        self.final_observations.check("final_observations", len)
    }
}

impl Observations<'_> {
    #[cfg(feature = "rayon")]
    fn split_at(self, index: usize) -> (Self, Self) {
        match self {
            Self::None => (Self::None, Self::None),
            Self::Rows(rows) => {
                let (before, after) = rows.split_at_mut(index);
                (Self::Rows(before), Self::Rows(after))
            }
            Self::Columns(columns) => {
                let mut halves = columns.map(|column| column.split_at_mut(index));
                let before = halves.each_mut().map(|(before, _)| core::mem::take(before));
                let after = halves.map(|(_, after)| after);
                (Self::Columns(before), Self::Columns(after))
            }
        }
    }

    fn check(&self, name: &'static str, len: usize) -> Result<(), Error> {
        match self {
            Self::None => Ok(()),
            Self::Rows(rows) => check_length(name, rows.len(), len),
            Self::Columns(columns) => columns
                .iter()
                .try_for_each(|column| check_length(name, column.len(), len)),
        }
    }

    /// Writes the six numbers of one acrobot, if it is in the batch.
    fn write(&mut self, index: usize, row: [f32; 6]) {
        match self {
            Self::None => {}
            Self::Rows(rows) => {
                if let Some(to) = rows.get_mut(index) {
                    *to = row;
                }
            }
            Self::Columns(columns) => {
                for (column, x) in columns.iter_mut().zip(row) {
                    if let Some(to) = column.get_mut(index) {
                        *to = x;
                    }
                }
            }
        }
    }
}
