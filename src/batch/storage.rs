//! The memory of a batch.

use super::block::Block;
use super::lane_params::LaneParams;
use crate::arithmetic::{Arithmetic, Real};
use crate::numpy::Pcg64;
use crate::task::{Draws, Memory};

/// The memory of a [`Batch`](super::Batch): arrays, slices or `Vec`s, whose lengths must never
/// change. For 50 acrobots, 16 in a block:
///
/// ```
/// use acrobot::Fast;
/// use acrobot::batch::{Batch, BatchMemory, Block, LaneParams, OwnParams};
/// use acrobot::numpy::Pcg64;
///
/// let (blocks, generators) = ([Block::EMPTY; 4], [Pcg64::UNSEEDED; 50]);
/// let own = OwnParams::new([LaneParams::default(); 4]);
/// let batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own })?;
/// assert!(batch.has_own_params());
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct BatchMemory<B, G, O = ()> {
    /// A [`Block`] for each `N` acrobots.
    pub blocks: B,
    /// A generator for each acrobot.
    pub generators: G,
    /// `()` where acrobots share their parameters, or [`OwnParams`] where each has its own.
    pub own: O,
}

/// The memory for the parameters of each acrobot, and for what resets draw of them.
///
/// ```
/// # use acrobot::batch::{Batch, BatchMemory, Block, LaneParams, OwnParams};
/// # use acrobot::numpy::Pcg64;
/// # use acrobot::{Fast, Params};
/// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
/// let own = OwnParams::new([LaneParams::default()]);
/// let mut batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own })?;
/// batch.set_params(1, Params { mass2: 0.8, ..Params::DEFAULT })?; // kg
/// assert_eq!((batch.params(0)?.mass2, batch.params(1)?.mass2), (1.0, 0.8));
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct OwnParams<P, S = f32> {
    pub(super) lane_params: P,
    draws: Draws<S>,
}

impl<P, S: Real> OwnParams<P, S> {
    /// Memory with a [`LaneParams`] for each block, or without any: then acrobots share their
    /// parameters. A new batch has the default ones and [draws](super::Batch::set_draws) none.
    #[must_use]
    pub const fn new(lane_params: P) -> Self {
        Self { lane_params, draws: Draws::NONE }
    }
}

/// A [`BatchMemory`].
///
/// ```
/// # use acrobot::batch::{Batch, BatchMemory, Block, Storage};
/// # use acrobot::numpy::Pcg64;
/// # use acrobot::{Error, Fast};
/// fn speed<S: Storage<Fast, 16>>(batch: &Batch<Fast, S>) -> Result<f32, Error> {
///     Ok(batch.state(0)?.dtheta1.abs()) // rad/s
/// }
/// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
/// let batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
/// assert!(speed(&batch)? <= 0.1);
/// # Ok::<(), Error>(())
/// ```
pub trait Storage<A: Arithmetic, const N: usize, M: Memory = ()> {
    #[doc(hidden)]
    fn slices(&self) -> Slices<'_, A, N, M>;

    #[doc(hidden)]
    fn slices_mut(&mut self) -> SlicesMut<'_, A, N, M>;
}

/// The blocks, one for each `N` acrobots, the generators, one for each acrobot, and the parameters:
/// one [`LaneParams`] for each block, or none where acrobots share them, and what resets draw. No
/// path outside of the crate names it, which seals [`Storage`].
#[derive(Debug)]
pub struct Slices<'a, A: Arithmetic, const N: usize, M: Memory> {
    pub blocks: &'a [Block<A, N, M>],
    pub generators: &'a [Pcg64],
    pub lane_params: &'a [LaneParams<A, N>],
    pub draws: Option<&'a Draws<A::Scalar>>,
}

/// The same slices, to change their elements.
#[derive(Debug)]
pub struct SlicesMut<'a, A: Arithmetic, const N: usize, M: Memory> {
    pub blocks: &'a mut [Block<A, N, M>],
    pub generators: &'a mut [Pcg64],
    pub lane_params: &'a mut [LaneParams<A, N>],
    pub draws: Option<&'a mut Draws<A::Scalar>>,
}

impl<A, B, G, M, const N: usize> Storage<A, N, M> for BatchMemory<B, G>
where
    A: Arithmetic,
    M: Memory,
    B: AsRef<[Block<A, N, M>]> + AsMut<[Block<A, N, M>]>,
    G: AsRef<[Pcg64]> + AsMut<[Pcg64]>,
{
    fn slices(&self) -> Slices<'_, A, N, M> {
        Slices {
            blocks: self.blocks.as_ref(),
            generators: self.generators.as_ref(),
            lane_params: &[],
            draws: None,
        }
    }

    fn slices_mut(&mut self) -> SlicesMut<'_, A, N, M> {
        SlicesMut {
            blocks: self.blocks.as_mut(),
            generators: self.generators.as_mut(),
            lane_params: &mut [],
            draws: None,
        }
    }
}

impl<A, B, G, P, M, const N: usize> Storage<A, N, M> for BatchMemory<B, G, OwnParams<P, A::Scalar>>
where
    A: Arithmetic,
    M: Memory,
    B: AsRef<[Block<A, N, M>]> + AsMut<[Block<A, N, M>]>,
    G: AsRef<[Pcg64]> + AsMut<[Pcg64]>,
    P: AsRef<[LaneParams<A, N>]> + AsMut<[LaneParams<A, N>]>,
{
    fn slices(&self) -> Slices<'_, A, N, M> {
        Slices {
            blocks: self.blocks.as_ref(),
            generators: self.generators.as_ref(),
            lane_params: self.own.lane_params.as_ref(),
            draws: Some(&self.own.draws),
        }
    }

    fn slices_mut(&mut self) -> SlicesMut<'_, A, N, M> {
        SlicesMut {
            blocks: self.blocks.as_mut(),
            generators: self.generators.as_mut(),
            lane_params: self.own.lane_params.as_mut(),
            draws: Some(&mut self.own.draws),
        }
    }
}
