//! Many acrobots at once: the bits of each are those of one alone.

mod block;
mod member;
mod vectors;

use core::num::NonZeroU32;

pub use block::Block;
pub use member::Member;
pub use vectors::Vectors;

use crate::arithmetic::Arithmetic;
use crate::dynamics::Model;
use crate::error::Error;
use crate::params::Params;
use crate::rng::Pcg64;
use crate::seed::SeedSequence;
use crate::state::{StartBounds, State};
use crate::time_limit::V1;

/// When an acrobot of a batch whose episode has ended is reset: Gymnasium's `AutoresetMode`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Autoreset {
    /// By the next step, which ignores its action and returns the start, with a reward of 0.
    #[default]
    NextStep,
    /// By the step that ends it, which returns the start as its observation, and what was seen last
    /// among the [`final_observations`](Output::final_observations).
    SameStep,
}

/// Where a step of a [`Batch`] writes, an element for each acrobot.
#[derive(Debug)]
pub struct Output<'a> {
    /// −1, or 0 for the step that reaches the goal and for one that only resets.
    pub rewards: &'a mut [f32],
    /// Whether the goal was reached.
    pub terminated: &'a mut [bool],
    /// Whether the time limit was reached.
    pub truncated: &'a mut [bool],
    /// What the agents see of the new states.
    pub observations: Observations<'a>,
    /// With [`Autoreset::SameStep`] alone: what the agents saw last of the episodes that this step
    /// ended. Elements of other acrobots stay as they are.
    pub final_observations: Observations<'a>,
}

/// Where the observations go. What they are: [`Observation`](crate::Observation).
#[derive(Debug)]
pub enum Observations<'a> {
    /// Nowhere: they are not computed.
    None,
    /// Six numbers for each acrobot.
    Rows(&'a mut [[f32; 6]]),
    /// Six slices with a number for each acrobot.
    Columns([&'a mut [f32]; 6]),
}

/// Many acrobots, each with the parameters of all and a stream of its own.
///
/// Acrobot `i` is [`Acrobot::<A>`](crate::Acrobot) of the `i`-th child of the seed under a
/// [`TimeLimit`](crate::TimeLimit), to the bit. In [`Fast`](crate::Fast) `N` are stepped side by side, with
/// the widest vectors that the machine has where the `std` feature is on; in the other arithmetics
/// one after another. Neither `N` nor the vectors change a bit.
///
/// It lives in memory that it is given: arrays, slices or `Vec`s of [`Block`]s, one for each `N`, and of
/// generators, one for each. The two are apart because a step seldom draws.
///
/// ```
/// use acrobot::{Batch, Block, Fast, Observations, Output, Pcg64};
///
/// let (blocks, generators) = ([Block::EMPTY; 4], [Pcg64::UNSEEDED; 50]);
/// let mut batch = Batch::<Fast, _, _>::new(42, blocks, generators)?;
/// let (mut rewards, mut terminated, mut truncated) = ([0.0; 50], [false; 50], [false; 50]);
/// let mut observations = [[0.0; 6]; 50];
/// batch.step(
///     &[2_u8; 50],
///     Output {
///         rewards: &mut rewards,
///         terminated: &mut terminated,
///         truncated: &mut truncated,
///         observations: Observations::Rows(&mut observations),
///         final_observations: Observations::None,
///     },
/// )?;
/// assert_eq!(rewards, [-1.0; 50]);
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Batch<A: Arithmetic, B, G, const N: usize = 16> {
    shared: Shared<A::Scalar>,
    vectors: Vectors,
    blocks: B,
    generators: G,
}

/// What all acrobots of a batch have in common.
#[derive(Clone, Debug)]
struct Shared<S> {
    model: Model<S>,
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
    /// As many acrobots as generators, seeded anew, with the default parameters and each at its first
    /// start; a limit of 500 steps, and the reset by the next step.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for no generators, and [`Error::WrongLength`] where `blocks` are not as many
    /// as they need: one for each `N`, the last of which may be in part.
    pub fn new(seed: impl Into<SeedSequence>, blocks: B, generators: G) -> Result<Self, Error> {
        const { assert!(N > 0, "a block holds one acrobot or more") };
        let len = generators.as_ref().len();
        if len == 0 {
            return Err(Error::OutOfRange {
                name: "generators",
                value: 0.0,
                unit: "acrobots",
                allowed: "1 or more",
            });
        }
        check_length("blocks", blocks.as_ref().len(), len.div_ceil(N))?;
        let shared = Shared {
            model: Model::new::<A>(Params::default()),
            bounds: StartBounds::DEFAULT,
            limit: V1,
            autoreset: Autoreset::default(),
        };
        let mut batch = Self {
            shared,
            vectors: Vectors::widest(),
            blocks,
            generators,
        };
        batch.reset_seeded(seed);
        Ok(batch)
    }

    /// How many acrobots.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "there is no batch of none")]
    pub fn len(&self) -> usize {
        self.generators.as_ref().len()
    }

    /// Resets all, each within its own stream.
    pub fn reset(&mut self) {
        let blocks = self.blocks.as_mut().iter_mut();
        for (block, generators) in blocks.zip(self.generators.as_mut().chunks_mut(N)) {
            block.reset::<A>(&[true; N], self.shared.bounds, generators);
        }
    }

    /// Seeds acrobot `i` with the `i`-th child of `seed`, and resets all.
    pub fn reset_seeded(&mut self, seed: impl Into<SeedSequence>) {
        let children = seed.into().spawn(u64::MAX);
        for (rng, seed) in self.generators.as_mut().iter_mut().zip(children) {
            *rng = Pcg64::new(seed);
        }
        self.reset();
    }

    /// Begins an episode of each in a state of its own: for searches on the model.
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] unless there is a state for each acrobot, and [`Error::OutOfRange`] for a
    /// number that is not finite; nothing is changed then.
    pub fn reset_to(&mut self, states: &[State<A::Scalar>]) -> Result<(), Error> {
        check_length("states", states.len(), self.len())?;
        states.iter().try_for_each(State::validate)?;
        let blocks = self.blocks.as_mut().iter_mut();
        for (block, states) in blocks.zip(states.chunks(N)) {
            block.reset_to::<A>(states);
        }
        Ok(())
    }

    /// Applies an action to each for one `dt`: the numbers 0, 1 and 2, or [`Action`](crate::Action)s.
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] for a slice that has not an element for each acrobot, and
    /// [`Error::UnknownAction`] for a number above 2; nothing is stepped then.
    pub fn step(
        &mut self,
        actions: &[impl Copy + Into<u8>],
        output: Output<'_>,
    ) -> Result<(), Error> {
        self.check(actions, &output)?;
        let (blocks, generators) = (self.blocks.as_mut(), self.generators.as_mut());
        self.vectors
            .step::<A, N>(&self.shared, blocks, generators, actions, output);
        Ok(())
    }

    fn check(&self, actions: &[impl Copy + Into<u8>], output: &Output<'_>) -> Result<(), Error> {
        check_length("actions", actions.len(), self.len())?;
        output.check(self.len())?;
        let numbers = actions.iter().map(|&action| action.into());
        match numbers.fold(0, u8::max) {
            0..=2 => Ok(()),
            highest => Err(Error::UnknownAction(highest)),
        }
    }

    /// [`step`](Self::step) on all cores, by rayon: the same bits, whatever the number of threads.
    ///
    /// # Errors
    ///
    /// As [`step`](Self::step).
    #[cfg(feature = "rayon")]
    pub fn par_step(
        &mut self,
        actions: &[impl Copy + Into<u8> + Sync],
        output: Output<'_>,
    ) -> Result<(), Error> {
        self.check(actions, &output)?;
        let (blocks, generators) = (self.blocks.as_mut(), self.generators.as_mut());
        self.vectors
            .par_step::<A, N>(&self.shared, blocks, generators, actions, output);
        Ok(())
    }

    /// Writes what the agents see of the states.
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] for a slice that has not an element for each acrobot.
    pub fn observe(&self, mut observations: Observations<'_>) -> Result<(), Error> {
        observations.check("observations", self.len())?;
        for (number, block) in self.blocks.as_ref().iter().enumerate() {
            block.observe(number, &mut observations);
        }
        Ok(())
    }

    /// The state of the acrobot of that index, if there is one.
    #[must_use]
    pub fn state(&self, index: usize) -> Option<State<A::Scalar>> {
        if index >= self.len() {
            return None;
        }
        let block = self.blocks.as_ref().get(index / N)?;
        Some(block.state(index % N))
    }

    /// The parameters of all.
    #[must_use]
    pub fn params(&self) -> &Params<A::Scalar> {
        &self.shared.model.params
    }

    /// Sets the parameters of all, from the next step on.
    ///
    /// # Errors
    ///
    /// As [`Acrobot::set_params`](crate::Acrobot::set_params); the parameters stay as they were then.
    pub fn set_params(&mut self, params: Params<A::Scalar>) -> Result<(), Error> {
        params.validate()?;
        self.shared.model = Model::new::<A>(params);
        Ok(())
    }

    /// Sets the vectors to step with; those that the machine has not are as the baseline.
    pub fn set_vectors(&mut self, vectors: Vectors) {
        self.vectors = vectors;
    }

    /// Sets the bounds of the starts to come.
    pub fn set_start_bounds(&mut self, bounds: StartBounds) {
        self.shared.bounds = bounds;
    }

    /// Sets the steps after which episodes are truncated.
    pub fn set_limit(&mut self, limit: NonZeroU32) {
        self.shared.limit = limit;
    }

    /// Sets when ended episodes are reset; those that wait for it are at once by
    /// [`Autoreset::SameStep`], with which none waits.
    pub fn set_autoreset(&mut self, autoreset: Autoreset) {
        self.shared.autoreset = autoreset;
        if autoreset == Autoreset::SameStep {
            let blocks = self.blocks.as_mut().iter_mut();
            for (block, generators) in blocks.zip(self.generators.as_mut().chunks_mut(N)) {
                block.reset_ended::<A>(self.shared.bounds, generators);
            }
        }
    }
}

fn check_length(name: &'static str, found: usize, expected: usize) -> Result<(), Error> {
    if found == expected {
        Ok(())
    } else {
        Err(Error::WrongLength {
            name,
            found,
            expected,
        })
    }
}

impl Output<'_> {
    /// The outputs of the acrobots before an index, and of those from there on.
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

    /// The six numbers of one acrobot, if it is of the batch.
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
