//! Whether the acrobots of a batch share their parameters, or each has its own.

use core::fmt;

use super::buffers::set;
use super::lane_model::LaneModel;
use super::{Batch, Block, check_index};
use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::math::Zeroed;
use crate::numpy::Pcg64;
use crate::physics::equations::Model;
use crate::physics::{Params, ParamsRange};

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
    params: [Params<A::Scalar>; N],
}

impl<A: Arithmetic, const N: usize> Zeroed for Own<A, N> {
    const ZEROED: Self = Self {
        model: Zeroed::ZEROED,
        params: [Params::DEFAULT; N],
    };
}

impl<A: Arithmetic, const N: usize> Own<A, N> {
    /// Replaces the parameters of a lane by valid ones.
    fn set_params(&mut self, lane: usize, params: Params<A::Scalar>) {
        self.model.set(lane, Model::new(params));
        set(&mut self.params, lane, params);
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
