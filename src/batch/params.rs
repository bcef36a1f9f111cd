//! Whether the acrobots of a batch share their parameters, or each has its own.

use core::fmt;

use super::buffers::set;
use super::lane_model::LaneModel;
use crate::arithmetic::Arithmetic;
use crate::math::Zeroed;
use crate::numpy::Pcg64;
use crate::physics::{Model, Params, ParamsRange};

/// All acrobots of a batch have the same parameters.
#[derive(Clone, Copy, Debug)]
pub struct SharedParams;

/// Each acrobot of a batch has its own parameters: for domain randomization.
#[derive(Clone, Copy, Debug)]
pub struct OwnParams;

/// Whether acrobots share their parameters: [`SharedParams`] or [`OwnParams`]. No other type can implement it.
pub trait ParamsKind<A: Arithmetic>: Kind<A> {}

impl<A: Arithmetic, P: Kind<A>> ParamsKind<A> for P {}

/// Where the parameters are.
pub trait Kind<A: Arithmetic>: Copy + fmt::Debug + Send + Sync {
    /// What a batch stores.
    type Shared: Clone + fmt::Debug + Send + Sync;

    /// What a block stores.
    type Own<const N: usize>: Zeroed + Clone + fmt::Debug + Send + Sync;

    /// The shared model in all lanes.
    type Splat<const N: usize>;

    /// The default parameters.
    const SHARED: Self::Shared;

    /// The default parameters in all lanes.
    fn own<const N: usize>() -> Self::Own<N>;

    /// The shared model in all lanes: a step computes it once, for all blocks.
    fn splat<const N: usize>(shared: &Self::Shared) -> Self::Splat<N>;

    /// The model of a block.
    fn model<'a, const N: usize>(
        splat: &'a Self::Splat<N>,
        own: &'a Self::Own<N>,
    ) -> &'a LaneModel<A, N>;

    /// Draws the parameters of a lane that is reset, if a range is set.
    fn draw<const N: usize>(
        shared: &Self::Shared,
        own: &mut Self::Own<N>,
        lane: usize,
        rng: &mut Pcg64,
    );
}

impl<A: Arithmetic> Kind<A> for SharedParams {
    type Shared = Model<A>;
    type Own<const N: usize> = ();
    type Splat<const N: usize> = LaneModel<A, N>;

    const SHARED: Model<A> = Model::DEFAULT;

    fn own<const N: usize>() {}

    #[inline(always)]
    fn splat<const N: usize>(shared: &Model<A>) -> LaneModel<A, N> {
        LaneModel::splat(shared)
    }

    #[inline(always)]
    fn model<'a, const N: usize>(splat: &'a LaneModel<A, N>, (): &'a ()) -> &'a LaneModel<A, N> {
        splat
    }

    fn draw<const N: usize>(_: &Model<A>, (): &mut (), _: usize, _: &mut Pcg64) {}
}

impl<A: Arithmetic> Kind<A> for OwnParams {
    type Shared = Option<ParamsRange<A::Scalar>>;
    type Own<const N: usize> = Own<A, N>;
    type Splat<const N: usize> = ();

    const SHARED: Self::Shared = None;

    fn own<const N: usize>() -> Own<A, N> {
        let mut own = Own::ZEROED;
        for lane in 0..N {
            own.set_params(lane, Params::DEFAULT);
        }
        own
    }

    fn splat<const N: usize>(_: &Self::Shared) {}

    #[inline(always)]
    fn model<'a, const N: usize>((): &'a (), own: &'a Own<A, N>) -> &'a LaneModel<A, N> {
        &own.model
    }

    fn draw<const N: usize>(
        range: &Self::Shared,
        own: &mut Own<A, N>,
        lane: usize,
        rng: &mut Pcg64,
    ) {
        if let Some(range) = range {
            own.set_params(lane, range.draw(rng));
        }
    }
}

/// The parameters of each acrobot of a block.
#[derive(Clone, Debug)]
pub struct Own<A: Arithmetic, const N: usize> {
    model: LaneModel<A, N>,
    pub(super) params: [Params<A::Scalar>; N],
}

impl<A: Arithmetic, const N: usize> Zeroed for Own<A, N> {
    const ZEROED: Self = Self {
        model: Zeroed::ZEROED,
        params: [Params::DEFAULT; N],
    };
}

impl<A: Arithmetic, const N: usize> Own<A, N> {
    /// Replaces the parameters of a lane by valid ones.
    pub(super) fn set_params(&mut self, lane: usize, params: Params<A::Scalar>) {
        self.model.set(lane, Model::new(params));
        set(&mut self.params, lane, params);
    }
}
