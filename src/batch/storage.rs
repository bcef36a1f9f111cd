//! The memory of a batch.

use super::{Block, LaneParams};
use crate::arithmetic::Arithmetic;
use crate::numpy::Pcg64;

/// The memory of a [`Batch`](super::Batch): blocks with the states, generators, and parameters if each acrobot has its
/// own.
///
/// These are pairs and triples of arrays, slices or `Vec`s: `(blocks, generators)` where acrobots share their
/// parameters, `(blocks, generators, lane_params)` where each has its own. States and generators are separate because
/// most steps draw no random number. The slices must always have the same lengths.
///
/// ```
/// use acrobot::batch::{Batch, Block, LaneParams};
/// use acrobot::numpy::Pcg64;
/// use acrobot::{Fast, Params};
///
/// let mut blocks = vec![Block::EMPTY; 4]; // 16 acrobots in each
/// let mut generators = vec![Pcg64::UNSEEDED; 50];
/// let shared = (&mut blocks[..], &mut generators[..]);
/// assert_eq!(Batch::<Fast, _>::new(42, shared)?.len(), 50);
///
/// let own = ([Block::EMPTY; 4], [Pcg64::UNSEEDED; 50], [LaneParams::default(); 4]);
/// let mut batch = Batch::<Fast, _>::new(42, own)?;
/// batch.set_params_of(49, Params { mass1: 1.2, ..Params::DEFAULT })?;
/// # Ok::<(), acrobot::Error>(())
/// ```
pub trait Storage<A: Arithmetic, const N: usize> {
    /// The blocks, one for each `N` acrobots, the generators, one for each acrobot, and the parameters: one
    /// [`LaneParams`] for each block, or none where acrobots share their parameters.
    fn slices(&self) -> (&[Block<A, N>], &[Pcg64], &[LaneParams<A, N>]);

    /// The same slices, to change their elements.
    fn slices_mut(&mut self) -> (&mut [Block<A, N>], &mut [Pcg64], &mut [LaneParams<A, N>]);
}

impl<A, B, G, const N: usize> Storage<A, N> for (B, G)
where
    A: Arithmetic,
    B: AsRef<[Block<A, N>]> + AsMut<[Block<A, N>]>,
    G: AsRef<[Pcg64]> + AsMut<[Pcg64]>,
{
    fn slices(&self) -> (&[Block<A, N>], &[Pcg64], &[LaneParams<A, N>]) {
        (self.0.as_ref(), self.1.as_ref(), &[])
    }

    fn slices_mut(&mut self) -> (&mut [Block<A, N>], &mut [Pcg64], &mut [LaneParams<A, N>]) {
        (self.0.as_mut(), self.1.as_mut(), &mut [])
    }
}

impl<A, B, G, P, const N: usize> Storage<A, N> for (B, G, P)
where
    A: Arithmetic,
    B: AsRef<[Block<A, N>]> + AsMut<[Block<A, N>]>,
    G: AsRef<[Pcg64]> + AsMut<[Pcg64]>,
    P: AsRef<[LaneParams<A, N>]> + AsMut<[LaneParams<A, N>]>,
{
    fn slices(&self) -> (&[Block<A, N>], &[Pcg64], &[LaneParams<A, N>]) {
        (self.0.as_ref(), self.1.as_ref(), self.2.as_ref())
    }

    fn slices_mut(&mut self) -> (&mut [Block<A, N>], &mut [Pcg64], &mut [LaneParams<A, N>]) {
        (self.0.as_mut(), self.1.as_mut(), self.2.as_mut())
    }
}
