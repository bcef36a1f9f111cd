//! Parameters as a step reads them: a number for each lane.

use super::buffers::set;
use crate::arithmetic::{Arithmetic, Fast};
use crate::math::{Lanes, Real};
use crate::physics::{Defaults, Dynamics, Model, Params, default_model, model};
use crate::task::Draws;

/// The memory for the parameters of `N` acrobots, where each has its own: 2240 bytes for 16 in
/// `Fast`.
///
/// ```
/// use acrobot::batch::{LaneParams, OwnParams};
///
/// let lane_params: [LaneParams; 4] = [LaneParams::default(); 4];
/// let own: OwnParams<_> = OwnParams::new(lane_params); // for up to 64 acrobots
/// assert_eq!(size_of::<LaneParams>(), 2240); // bytes
/// ```
// Aligned, because an SSE instruction can read only aligned numbers from memory.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct LaneParams<A: Arithmetic = Fast, const N: usize = 16> {
    /// Its `params.dynamics` says nothing: `nips` among the constants tells the equations of each
    /// lane.
    pub(super) model: Model<Lanes<A::Scalar, N>>,
}

/// The parameters of a block's acrobots, and what resets draw of them.
pub(super) type Own<'a, A, const N: usize> =
    (&'a mut LaneParams<A, N>, &'a Draws<<A as Arithmetic>::Scalar>);

impl<A: Arithmetic, const N: usize> Default for LaneParams<A, N> {
    fn default() -> Self {
        Self::shared(&const { default_model::<A, Defaults>() })
    }
}

impl<A: Arithmetic, const N: usize> LaneParams<A, N> {
    /// The same model in all lanes.
    #[inline(always)]
    pub(super) fn shared(model: &Model<A::Scalar>) -> Self {
        let model = model.zip(model, |_, x| Lanes([*x; N]));
        Self { model }
    }

    /// Replaces the parameters of a lane by valid ones.
    pub(super) fn set(&mut self, lane: usize, params: Params<A::Scalar>) {
        let replace = |lanes: &Lanes<_, N>, x: &A::Scalar| {
            let mut lanes = *lanes;
            set(&mut lanes.0, lane, *x);
            lanes
        };
        self.model = self.model.zip(&model::<A>(params), replace);
    }

    /// The parameters of a lane below `N`.
    pub(super) fn get(&self, lane: usize) -> Params<A::Scalar> {
        let number = |lanes: &Lanes<A::Scalar, N>, _: &A::Scalar| {
            *lanes.0.get(lane).unwrap_or(&A::Scalar::ZERO)
        };
        let Model { params, constants } =
            self.model.zip(&const { default_model::<A, Defaults>() }, number);
        Params {
            dynamics: if constants.nips > A::Scalar::ZERO {
                Dynamics::Nips
            } else {
                Dynamics::Book
            },
            ..params
        }
    }
}
