//! The memory of a batch.

use super::block::Block;
use super::lane_params::LaneParams;
use crate::arithmetic::Arithmetic;
use crate::numpy::Pcg64;
use crate::task::Draws;

/// The memory of a [`Batch`](super::Batch): arrays, slices or `Vec`s, as `(blocks, generators)`
/// where acrobots share their parameters, and `(blocks, generators, lane_params, draws)` where each
/// has its own, from which resets draw. Their lengths must never change. For 50 acrobots, 16 in a
/// block: `([Block::EMPTY; 4], [Pcg64::UNSEEDED; 50], [LaneParams::default(); 4], Draws::NONE)`.
pub trait Storage<A: Arithmetic, const N: usize> {
    #[doc(hidden)]
    fn slices(&self) -> Slices<'_, A, N>;

    #[doc(hidden)]
    fn slices_mut(&mut self) -> SlicesMut<'_, A, N>;
}

/// The blocks, one for each `N` acrobots, the generators, one for each acrobot, and the parameters:
/// one [`LaneParams`] for each block, or none where acrobots share them, and what resets draw. No
/// path outside of the crate names it, which seals [`Storage`].
#[derive(Debug)]
pub struct Slices<'a, A: Arithmetic, const N: usize> {
    pub blocks: &'a [Block<A, N>],
    pub generators: &'a [Pcg64],
    pub lane_params: &'a [LaneParams<A, N>],
    pub draws: Option<&'a Draws<A::Scalar>>,
}

/// The same slices, to change their elements.
#[derive(Debug)]
pub struct SlicesMut<'a, A: Arithmetic, const N: usize> {
    pub blocks: &'a mut [Block<A, N>],
    pub generators: &'a mut [Pcg64],
    pub lane_params: &'a mut [LaneParams<A, N>],
    pub draws: Option<&'a mut Draws<A::Scalar>>,
}

impl<A, B, G, const N: usize> Storage<A, N> for (B, G)
where
    A: Arithmetic,
    B: AsRef<[Block<A, N>]> + AsMut<[Block<A, N>]>,
    G: AsRef<[Pcg64]> + AsMut<[Pcg64]>,
{
    fn slices(&self) -> Slices<'_, A, N> {
        Slices {
            blocks: self.0.as_ref(),
            generators: self.1.as_ref(),
            lane_params: &[],
            draws: None,
        }
    }

    fn slices_mut(&mut self) -> SlicesMut<'_, A, N> {
        SlicesMut {
            blocks: self.0.as_mut(),
            generators: self.1.as_mut(),
            lane_params: &mut [],
            draws: None,
        }
    }
}

impl<A, B, G, P, const N: usize> Storage<A, N> for (B, G, P, Draws<A::Scalar>)
where
    A: Arithmetic,
    B: AsRef<[Block<A, N>]> + AsMut<[Block<A, N>]>,
    G: AsRef<[Pcg64]> + AsMut<[Pcg64]>,
    P: AsRef<[LaneParams<A, N>]> + AsMut<[LaneParams<A, N>]>,
{
    fn slices(&self) -> Slices<'_, A, N> {
        Slices {
            blocks: self.0.as_ref(),
            generators: self.1.as_ref(),
            lane_params: self.2.as_ref(),
            draws: Some(&self.3),
        }
    }

    fn slices_mut(&mut self) -> SlicesMut<'_, A, N> {
        SlicesMut {
            blocks: self.0.as_mut(),
            generators: self.1.as_mut(),
            lane_params: self.2.as_mut(),
            draws: Some(&mut self.3),
        }
    }
}
