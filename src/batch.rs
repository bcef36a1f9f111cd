//! Many acrobots at once, each bit-identical to one alone.
//!
//! A [`Batch`] steps acrobots side by side, with SIMD and without a heap: it borrows or owns
//! arrays, slices or `Vec`s. With the feature `alloc`, `VecBatch` also owns the memory of the
//! results. The guide has examples [with `Vec`s](crate::guide::rust#many-at-once) and [with
//! arrays](crate::guide::embedded_topics#the-physics-alone-or-several-acrobots).

mod block;
mod buffers;
mod inputs;
mod lane_params;
mod linearize;
mod member;
mod params;
mod reset;
mod settings;
#[cfg(feature = "serde")]
mod snapshot;
mod storage;
mod task;
#[cfg(feature = "alloc")]
mod vec_batch;
mod work;

use core::num::NonZeroU32;

pub use block::Block;
pub use buffers::StepBuffers;
pub use inputs::Input;
pub use lane_params::LaneParams;
pub use member::Member;
pub use settings::Autoreset;
pub use storage::{BatchMemory, OwnParams, Storage};
#[cfg(feature = "alloc")]
pub use vec_batch::{StepResults, VecBatch};

use crate::arithmetic::Arithmetic;
use crate::error::Error;
pub use crate::math::SimdLevel;
use crate::numpy::{Pcg64, SeedSequence};
use crate::physics::{State, default_model, model};
use crate::task::{Gymnasium, Memory, ResetBounds, Task};
use buffers::{check_length, take_mut};
use inputs::Inputs;
use lane_params::Own;
use settings::Settings;
use storage::SlicesMut;
use work::Work;

/// Many acrobots, each with its own stream of random numbers.
///
/// Acrobot `i` is bit-identical to an [`Acrobot`](crate::Acrobot) seeded with the seed's `i`-th
/// child, under a [`TimeLimit`](crate::TimeLimit), whatever `N` and the [SIMD
/// instructions](SimdLevel).
///
/// ```
/// # use acrobot::Fast;
/// # use acrobot::batch::{Batch, BatchMemory, Block, StepBuffers};
/// # use acrobot::numpy::Pcg64;
/// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
/// let mut batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
/// let (mut rewards, mut terminated, mut truncated) = ([0.0; 3], [false; 3], [false; 3]);
/// let buffers = StepBuffers::new(&mut rewards, &mut terminated, &mut truncated);
/// batch.step_into(&[2_u8; 3], buffers)?;
/// assert_eq!((rewards, batch.elapsed_steps(0)?), ([-1.0; 3], 1));
/// # Ok::<(), acrobot::Error>(())
/// ```
///
/// `S` is its [memory](BatchMemory). `N` must be from 1 to 32, or the program does not compile.
///
/// # Snapshots
///
/// With the `serde` feature a batch can be saved as a whole, with the header of an
/// [acrobot's](crate::Acrobot#snapshots) snapshot, and continues bit-identically with any `N`. It
/// is a sequence, the settings and then each acrobot, so it cannot be flattened into a struct.
#[derive(Clone, Debug)]
pub struct Batch<A: Arithmetic, S, T = Gymnasium, const N: usize = 16> {
    settings: Settings<A, T>,
    simd_level: SimdLevel,
    storage: S,
}

impl<A: Arithmetic, S: Storage<A, N, T::Memory>, T: Task, const N: usize> Batch<A, S, T, N> {
    /// A batch with one acrobot for each generator, with the default parameters, in its initial
    /// state. Acrobot `i` is seeded with the `i`-th child that `seed` has not yet spawned.
    ///
    /// ```
    /// # use acrobot::batch::{Batch, BatchMemory, Block};
    /// # use acrobot::numpy::{Pcg64, SeedSequence};
    /// # use acrobot::{Acrobot, Fast};
    /// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
    /// let batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
    /// let alone = Acrobot::<Fast>::new(SeedSequence::new(42).child(2));
    /// assert_eq!(batch.state(2)?, alone.state());
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::EmptyBatch`] without generators, and [`Error::WrongLength`] unless there is one
    /// block for each `N` generators, the last partly filled, and one [`LaneParams`] for each block
    /// or none.
    pub fn new(seed: impl Into<SeedSequence>, mut storage: S) -> Result<Self, Error> {
        const { assert!(0 < N && N <= 32, "a block must hold from 1 to 32 acrobots") };
        let SlicesMut { blocks, generators, lane_params, .. } = storage.slices_mut();
        if generators.is_empty() {
            return Err(Error::EmptyBatch);
        }
        check_length("blocks", blocks.len(), generators.len().div_ceil(N))?;
        const { default_model::<A, T>() };
        let model = model::<A>(T::PARAMS.cast());
        let shared = if lane_params.is_empty() {
            Some(model)
        } else {
            check_length("lane_params", lane_params.len(), blocks.len())?;
            lane_params.fill(LaneParams::shared(&model));
            None
        };
        let mut batch = Self {
            settings: Settings {
                shared,
                bounds: T::RESET_BOUNDS,
                max_steps: T::MAX_STEPS,
                autoreset: Autoreset::default(),
                task: T::DEFAULT,
            },
            simd_level: SimdLevel::widest(),
            storage,
        };
        batch.reset_with(seed.into().into());
        Ok(batch)
    }

    /// The number of acrobots.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "no batch is empty")]
    pub fn len(&self) -> usize {
        self.storage.slices().generators.len()
    }

    /// Applies an action or a torque to each acrobot for one dt: the numbers 0, 1 and 2,
    /// [`Action`](crate::Action)s, or any finite torques in N m.
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] unless each slice has one element for each acrobot,
    /// [`Error::UnknownAction`] for a number above 2, and [`Error::OutOfRange`] for a torque that
    /// is not finite.
    pub fn step_into<I: Input<A::Scalar>>(
        &mut self,
        inputs: &[I],
        buffers: StepBuffers<'_, T::Observation>,
    ) -> Result<(), Error> {
        self.step_any(I::inputs(inputs), buffers)
    }

    // A module of WebAssembly has it once for actions and torques, which saves 15 KB.
    #[cfg_attr(target_family = "wasm", inline(never))]
    #[cfg_attr(target_os = "none", inline(always))]
    fn step_any(
        &mut self,
        inputs: Inputs<'_, A::Scalar>,
        buffers: StepBuffers<'_, T::Observation>,
    ) -> Result<(), Error> {
        let level = self.simd_level;
        level.run(self.work(inputs, buffers)?);
        Ok(())
    }

    /// As [`step_into`](Self::step_into), with its errors, on all cores with rayon. The number of
    /// threads changes no bit.
    ///
    /// ```
    /// # use acrobot::Fast;
    /// # use acrobot::batch::{Batch, BatchMemory, Block, StepBuffers};
    /// # use acrobot::numpy::Pcg64;
    /// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
    /// let mut batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
    /// let (mut rewards, mut terminated, mut truncated) = ([0.0; 3], [false; 3], [false; 3]);
    /// let buffers = StepBuffers::new(&mut rewards, &mut terminated, &mut truncated);
    /// batch.par_step_into(&[0.5_f32; 3], buffers)?; // N m
    /// assert_eq!(rewards, [-1.0; 3]);
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    #[cfg(feature = "rayon")]
    pub fn par_step_into<I: Input<A::Scalar>>(
        &mut self,
        inputs: &[I],
        buffers: StepBuffers<'_, T::Observation>,
    ) -> Result<(), Error> {
        let level = self.simd_level;
        self.work(I::inputs(inputs), buffers)?.par_step(level);
        Ok(())
    }

    /// Checks what a step reads and writes.
    fn work<'a>(
        &'a mut self,
        inputs: Inputs<'a, A::Scalar>,
        buffers: StepBuffers<'a, T::Observation>,
    ) -> Result<Work<'a, A, T, N>, Error> {
        inputs.check(self.len())?;
        buffers.check(self.len())?;
        let slices = self.storage.slices_mut();
        Ok(Work {
            settings: &self.settings,
            blocks: slices.blocks,
            generators: slices.generators,
            lane_params: slices.lane_params,
            draws: slices.draws.map(|draws| &*draws),
            inputs,
            buffers,
        })
    }

    /// Writes the [observations](Task::Observation) of the states.
    ///
    /// ```
    /// # use acrobot::Fast;
    /// # use acrobot::batch::{Batch, BatchMemory, Block};
    /// # use acrobot::numpy::Pcg64;
    /// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
    /// let batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
    /// let mut observations = [[0.0; 6]; 3];
    /// batch.observe(&mut observations)?;
    /// assert_eq!(observations[0][4], batch.state(0)?.dtheta1); // rad/s
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] unless there is one element for each acrobot.
    pub fn observe(&self, mut observations: &mut [T::Observation]) -> Result<(), Error> {
        check_length("observations", observations.len(), self.len())?;
        for block in self.storage.slices().blocks {
            block.observe(&self.settings.task, &mut observations);
        }
        Ok(())
    }

    /// The generators, one for each acrobot, to draw from them or to replace them.
    ///
    /// ```
    /// # use acrobot::batch::{Batch, BatchMemory, Block};
    /// # use acrobot::numpy::Pcg64;
    /// # use acrobot::{Acrobot, Fast};
    /// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
    /// let mut batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
    /// for (rng, seed) in batch.generators_mut().iter_mut().zip(42..) {
    ///     *rng = Pcg64::new(seed); // 42, 43 and 44, as in SyncVectorEnv
    /// }
    /// batch.reset();
    /// assert_eq!(batch.state(1)?, Acrobot::<Fast>::new(43).state());
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    pub fn generators_mut(&mut self) -> &mut [Pcg64] {
        self.storage.slices_mut().generators
    }

    /// The number of steps of acrobot `index` since its last reset, or [`Error::NoSuchIndex`].
    pub fn elapsed_steps(&self, index: usize) -> Result<u32, Error> {
        let (block, _) = self.block_and_rng(index)?;
        Ok(block.progress(index % N).0)
    }

    /// Whether the episode of acrobot `index` has ended and it waits for a reset: by the next step
    /// or, with [`Autoreset::Disabled`], by the caller. Or [`Error::NoSuchIndex`].
    ///
    /// ```
    /// # use acrobot::batch::{Batch, BatchMemory, Block};
    /// # use acrobot::numpy::Pcg64;
    /// # use acrobot::{Error, Fast};
    /// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
    /// let batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
    /// assert!(!batch.is_done(0)?);
    /// assert_eq!(batch.is_done(3), Err(Error::NoSuchIndex { index: 3, len: 3 }));
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    pub fn is_done(&self, index: usize) -> Result<bool, Error> {
        let (block, _) = self.block_and_rng(index)?;
        Ok(block.progress(index % N).1)
    }

    /// The state of acrobot `index`, or [`Error::NoSuchIndex`].
    pub fn state(&self, index: usize) -> Result<State<A::Scalar>, Error> {
        let (block, _) = self.block_and_rng(index)?;
        Ok(block.state(index % N))
    }

    /// Sets the state of acrobot `index`. Its episode continues, or still waits for a reset.
    ///
    /// ```
    /// # use acrobot::batch::{Batch, BatchMemory, Block};
    /// # use acrobot::numpy::Pcg64;
    /// # use acrobot::{Fast, State};
    /// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
    /// let mut batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
    /// batch.set_state(0, State { theta1: 0.5, ..State::HANGING })?; // rad
    /// assert_eq!(batch.state(0)?.theta1, 0.5);
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::NoSuchIndex`], and [`Error::OutOfRange`] for a number that is not finite.
    pub fn set_state(&mut self, index: usize, state: State<A::Scalar>) -> Result<(), Error> {
        state.validate()?;
        let len = self.len();
        let block = self.storage.slices_mut().blocks.get_mut(index / N).filter(|_| index < len);
        let block = block.ok_or(Error::NoSuchIndex { index, len })?;
        block.begin(index % N, &self.settings.task, state, None);
        Ok(())
    }

    /// The block of acrobot `index`, and its generator.
    fn block_and_rng(&self, index: usize) -> Result<(&Block<A, N, T::Memory>, &Pcg64), Error> {
        let slices = self.storage.slices();
        let both = slices.blocks.get(index / N).zip(slices.generators.get(index));
        both.ok_or(Error::NoSuchIndex { index, len: self.len() })
    }

    /// The SIMD instructions that a step uses.
    #[must_use]
    pub fn simd_level(&self) -> SimdLevel {
        self.simd_level
    }

    /// Sets the SIMD instructions that a step uses. One that the machine does not have acts as the
    /// baseline.
    pub fn set_simd_level(&mut self, level: SimdLevel) {
        self.simd_level = level;
    }

    /// The bounds of initial states.
    #[must_use]
    pub fn reset_bounds(&self) -> ResetBounds {
        self.settings.bounds
    }

    /// Sets the bounds of initial states for the next resets.
    ///
    /// ```
    /// # use acrobot::Fast;
    /// # use acrobot::batch::{Batch, BatchMemory, Block};
    /// # use acrobot::numpy::Pcg64;
    /// # use acrobot::task::ResetBounds;
    /// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
    /// let mut batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
    /// batch.set_reset_bounds(ResetBounds::new(0.3, 0.4)?); // rad and rad/s
    /// batch.reset();
    /// assert!((0.3..=0.4).contains(&batch.state(0)?.theta1));
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    pub fn set_reset_bounds(&mut self, bounds: ResetBounds) {
        self.settings.bounds = bounds;
    }

    /// The number of steps after which episodes are truncated.
    #[must_use]
    pub fn max_steps(&self) -> NonZeroU32 {
        self.settings.max_steps
    }

    /// Sets [`max_steps`](Self::max_steps).
    pub fn set_max_steps(&mut self, max_steps: NonZeroU32) {
        self.settings.max_steps = max_steps;
    }

    /// When ended episodes are reset.
    #[must_use]
    pub fn autoreset(&self) -> Autoreset {
        self.settings.autoreset
    }

    /// Sets when ended episodes are reset. [`Autoreset::SameStep`] immediately resets those
    /// that wait for it.
    pub fn set_autoreset(&mut self, autoreset: Autoreset) {
        self.settings.autoreset = autoreset;
        for (block, generators, own) in each_block(&mut self.storage) {
            block.reset_done(&self.settings, generators, own);
        }
    }
}

/// A block with its generators, fewer than `N` in the last block, and its own parameters, if any.
type Part<'a, A, M, const N: usize> =
    (&'a mut Block<A, N, M>, &'a mut [Pcg64], Option<Own<'a, A, N>>);

fn each_block<A: Arithmetic, M: Memory, const N: usize>(
    storage: &mut impl Storage<A, N, M>,
) -> impl Iterator<Item = Part<'_, A, M, N>> {
    let slices = storage.slices_mut();
    let (mut generators, mut lane_params) = (slices.generators, slices.lane_params.iter_mut());
    let blocks = slices.blocks.iter_mut();
    let draws = slices.draws.map(|draws| &*draws);
    blocks.map(move |block| {
        let own = lane_params.next().zip(draws);
        (block, take_mut(&mut generators, N), own)
    })
}
