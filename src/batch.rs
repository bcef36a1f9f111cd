//! Many acrobots at once, each bit-identical to one alone.
//!
//! A [`Batch`] steps acrobots side by side, with SIMD and without a heap: it borrows or owns arrays, slices or
//! `Vec`s. Acrobot `i` is bit-identical to an [`Acrobot`](crate::Acrobot) seeded with the seed's `i`-th child. With the
//! feature `alloc`, `VecBatch` is a batch that owns its memory and that of the results.
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
//! let buffers = StepBuffers::new(&mut rewards, &mut terminated, &mut truncated);
//! batch.step(&[2_u8; 50], buffers.with_observations(Observations::Rows(&mut observations)))?;
//! assert_eq!(rewards, [-1.0; 50]);
//! # Ok::<(), acrobot::Error>(())
//! ```

mod block;
mod buffers;
mod inputs;
mod lane_model;
mod member;
mod params;
mod reset;
mod settings;
mod simd;
#[cfg(feature = "alloc")]
mod vec_batch;

use core::num::NonZeroU32;

pub use block::Block;
pub use buffers::{Observations, StepBuffers};
pub use inputs::Input;
pub use member::Member;
pub use params::{OwnParams, ParamsKind, SharedParams};
pub use settings::Autoreset;
pub use simd::SimdLevel;
#[cfg(feature = "alloc")]
pub use vec_batch::{StepResults, VecBatch};

use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::numpy::{Pcg64, SeedSequence};
use crate::physics::{Model, Params, ParamsRange, ResetBounds, State};
use crate::reset_options::ResetOptions;
use crate::time_limit::V1;
use buffers::{check_length, take_mut};
use inputs::Inputs;
use settings::Settings;

/// Many acrobots, each with its own stream of random numbers.
///
/// Acrobot `i` is bit-identical to an [`Acrobot`](crate::Acrobot) seeded with the seed's `i`-th child, under a
/// [`TimeLimit`](crate::TimeLimit). A batch steps `N` acrobots side by side; with the `std` feature it uses
/// the widest SIMD instructions that the machine has. Neither `N` nor the instructions change a bit.
///
/// `B` holds a [`Block`] for each `N` acrobots, and `G` a generator for each acrobot: arrays, slices or `Vec`s. They
/// are separate because most steps draw no random number. See [the example](self). `P` says whether acrobots share
/// their parameters: [`SharedParams`] or [`OwnParams`]. `N` must be from 1 to 32:
///
/// ```compile_fail,E0080
/// use acrobot::Fast;
/// use acrobot::batch::{Batch, Block};
/// use acrobot::numpy::Pcg64;
///
/// let block = vec![Block::EMPTY];
/// let batch = Batch::<Fast, _, _, 33>::new(42, block, vec![Pcg64::UNSEEDED; 33]);
/// ```
#[derive(Clone, Debug)]
pub struct Batch<A, B, G, const N: usize = 16, P = SharedParams>
where
    A: Arithmetic,
    P: ParamsKind<A>,
{
    settings: Settings<A, P>,
    simd_level: SimdLevel,
    blocks: B,
    generators: G,
}

impl<A, B, G, const N: usize, P> Batch<A, B, G, N, P>
where
    A: Arithmetic,
    B: AsRef<[Block<A, N, P>]> + AsMut<[Block<A, N, P>]>,
    G: AsRef<[Pcg64]> + AsMut<[Pcg64]>,
    P: ParamsKind<A>,
{
    /// A batch with one acrobot for each generator. Acrobot `i` is seeded with the `i`-th child of `seed` and is in its
    /// initial state. The batch has the default parameters, a limit of 500 steps and [`Autoreset::NextStep`].
    ///
    /// # Errors
    ///
    /// [`Error::EmptyBatch`] without generators, and [`Error::WrongLength`] unless there is one block for each `N`
    /// generators; the last block may be partly filled.
    pub fn new(seed: u64, blocks: B, generators: G) -> Result<Self, Error> {
        Self::with_seed(SeedSequence::new(seed), blocks, generators)
    }

    /// As [`new`](Self::new), with a seed of any size. Acrobot `i` is seeded with the `i`-th child that `seed` has not
    /// yet spawned.
    ///
    /// # Errors
    ///
    /// Those of [`new`](Self::new).
    pub fn with_seed(seed: SeedSequence, blocks: B, generators: G) -> Result<Self, Error> {
        const { assert!(0 < N && N <= 32, "a block must hold from 1 to 32 acrobots") };
        let len = generators.as_ref().len();
        if len == 0 {
            return Err(Error::EmptyBatch);
        }
        check_length("blocks", blocks.as_ref().len(), len.div_ceil(N))?;
        let mut batch = Self {
            settings: Settings {
                params: P::SHARED,
                bounds: ResetBounds::DEFAULT,
                limit: V1,
                autoreset: Autoreset::default(),
            },
            simd_level: SimdLevel::widest(),
            blocks,
            generators,
        };
        for block in batch.blocks.as_mut() {
            block.own = P::own();
        }
        batch.reset_with(ResetOptions {
            seed: Some(seed),
            bounds: None,
        });
        Ok(batch)
    }

    /// The number of acrobots.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "no batch is empty")]
    pub fn len(&self) -> usize {
        self.generators.as_ref().len()
    }

    /// Applies an action or a torque to each acrobot for one dt: the numbers 0, 1 and 2, [`Action`](crate::Action)s, or
    /// any finite torques in N m.
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] unless each slice has one element for each acrobot, [`Error::UnknownAction`] for a
    /// number above 2, and [`Error::OutOfRange`] for a torque that is not finite.
    pub fn step<I: Input<A::Scalar>>(
        &mut self,
        inputs: &[I],
        buffers: StepBuffers<'_>,
    ) -> Result<(), Error> {
        let inputs = self.check(inputs, &buffers)?;
        let (blocks, generators) = (self.blocks.as_mut(), self.generators.as_mut());
        self.simd_level
            .step(&self.settings, blocks, generators, inputs, buffers);
        Ok(())
    }

    /// As [`step`](Self::step), on all cores with rayon. The number of threads changes no bit.
    ///
    /// # Errors
    ///
    /// Those of [`step`](Self::step).
    #[cfg(feature = "rayon")]
    pub fn par_step<I: Input<A::Scalar>>(
        &mut self,
        inputs: &[I],
        buffers: StepBuffers<'_>,
    ) -> Result<(), Error> {
        let inputs = self.check(inputs, &buffers)?;
        let (blocks, generators) = (self.blocks.as_mut(), self.generators.as_mut());
        self.simd_level
            .par_step(&self.settings, blocks, generators, inputs, buffers);
        Ok(())
    }

    fn check<'a, I: Input<A::Scalar>>(
        &self,
        inputs: &'a [I],
        buffers: &StepBuffers<'_>,
    ) -> Result<Inputs<'a, A::Scalar>, Error> {
        let inputs = I::inputs(inputs);
        inputs.check(self.len())?;
        buffers.check(self.len())?;
        Ok(inputs)
    }

    /// Writes the observations of the states.
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] unless each slice has one element for each acrobot.
    pub fn observe(&self, mut observations: Observations<'_>) -> Result<(), Error> {
        observations.check("observations", self.len())?;
        for block in self.blocks.as_ref() {
            block.observe(&mut observations);
        }
        Ok(())
    }

    /// The generators, one for each acrobot, to draw from them or to replace them.
    pub fn generators_mut(&mut self) -> &mut [Pcg64] {
        self.generators.as_mut()
    }

    /// The number of steps of acrobot `index` since its last reset, if there is one.
    #[must_use]
    pub fn elapsed(&self, index: usize) -> Option<u32> {
        check_index(index, self.len()).ok()?;
        let (elapsed, _) = self.blocks.as_ref().get(index / N)?.progress(index % N)?;
        Some(elapsed)
    }

    /// The state of acrobot `index`, if there is one.
    #[must_use]
    pub fn state(&self, index: usize) -> Option<State<A::Scalar>> {
        check_index(index, self.len()).ok()?;
        self.blocks.as_ref().get(index / N)?.state(index % N)
    }

    /// Sets the state of acrobot `index`. Its number of steps and a pending reset do not change.
    ///
    /// # Errors
    ///
    /// [`Error::NoSuchIndex`] for an index of at least [`len`](Self::len), and [`Error::OutOfRange`] for a number
    /// that is not finite.
    pub fn set_state(&mut self, index: usize, state: State<A::Scalar>) -> Result<(), Error> {
        state.validate()?;
        check_index(index, self.len())?;
        if let Some(block) = self.blocks.as_mut().get_mut(index / N) {
            block.set_state(index % N, state);
        }
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

impl<A, B, G, const N: usize> Batch<A, B, G, N, SharedParams>
where
    A: Arithmetic,
    B: AsRef<[Block<A, N>]> + AsMut<[Block<A, N>]>,
    G: AsRef<[Pcg64]> + AsMut<[Pcg64]>,
{
    /// The parameters of all acrobots.
    #[must_use]
    pub fn params(&self) -> &Params<A::Scalar> {
        &self.settings.params.params
    }

    /// Sets the parameters of all acrobots for the next steps.
    ///
    /// # Errors
    ///
    /// Those of [`Params::validate`].
    pub fn set_params(&mut self, params: Params<A::Scalar>) -> Result<(), Error> {
        params.validate()?;
        self.settings.params = Model::new(params);
        Ok(())
    }
}

/// Parameters for each acrobot.
impl<A, B, G, const N: usize> Batch<A, B, G, N, OwnParams>
where
    A: Arithmetic,
    B: AsRef<[Block<A, N, OwnParams>]> + AsMut<[Block<A, N, OwnParams>]>,
    G: AsRef<[Pcg64]> + AsMut<[Pcg64]>,
{
    /// The parameters of acrobot `index`, if there is one.
    #[must_use]
    pub fn params_of(&self, index: usize) -> Option<&Params<A::Scalar>> {
        check_index(index, self.len()).ok()?;
        let block = self.blocks.as_ref().get(index / N)?;
        block.own.params.get(index % N)
    }

    /// Sets the parameters of acrobot `index` for the next steps.
    ///
    /// # Errors
    ///
    /// Those of [`Params::validate`], and [`Error::NoSuchIndex`] for an index of at least [`len`](Self::len).
    pub fn set_params_of(&mut self, index: usize, params: Params<A::Scalar>) -> Result<(), Error> {
        params.validate()?;
        check_index(index, self.len())?;
        if let Some(block) = self.blocks.as_mut().get_mut(index / N) {
            block.own.set_params(index % N, params);
        }
        Ok(())
    }

    /// The range from which each reset draws the acrobot's parameters.
    #[must_use]
    pub fn params_range(&self) -> Option<&ParamsRange<A::Scalar>> {
        self.settings.params.as_ref()
    }

    /// Sets the range from which each reset, also one in a step, first draws the acrobot's parameters and then its
    /// initial state. With `None`, the default, a reset does not change parameters.
    pub fn set_params_range(&mut self, range: Option<ParamsRange<A::Scalar>>) {
        self.settings.params = range;
    }
}

/// Each block with its generators. The last may have fewer than `N`.
fn each_block<'a, B, const N: usize>(
    blocks: &'a mut [B],
    mut generators: &'a mut [Pcg64],
) -> impl Iterator<Item = (&'a mut B, &'a mut [Pcg64])> {
    let blocks = blocks.iter_mut();
    blocks.map(move |block| (block, take_mut(&mut generators, N)))
}

/// Rejects an index that no acrobot has.
fn check_index(index: usize, len: usize) -> Result<(), Error> {
    if index < len {
        Ok(())
    } else {
        Err(no_such_member(index, len))
    }
}

fn no_such_member(index: usize, len: usize) -> Error {
    Error::NoSuchIndex {
        name: "member",
        index,
        len,
    }
}
