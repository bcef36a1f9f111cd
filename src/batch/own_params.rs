//! The parameters of each acrobot of a block, and the constants that follow from them.

use super::block::set;
use super::params::{BlockModel, Kind, OwnParams};
use crate::arithmetic::{
    Arithmetic, Coefficients, Constants, Equations, Lanes, Model, Real, Zeroed,
};
use crate::numpy::Pcg64;
use crate::physics::{Dynamics, Params, ParamsRange};

impl<A: Arithmetic> Kind<A> for OwnParams {
    type Shared = Option<ParamsRange<A::Scalar>>;
    type Own<const N: usize> = Own<A, N>;
    type Model<const N: usize> = Own<A, N>;

    const SHARED: Self::Shared = None;

    fn own<const N: usize>() -> Own<A, N> {
        let mut own = Own::ZEROED;
        for lane in 0..N {
            own.set_model(lane, Model::DEFAULT);
        }
        own
    }

    #[inline(always)]
    fn model<'a, const N: usize>(_: &'a Self::Shared, own: &'a Own<A, N>) -> &'a Own<A, N> {
        own
    }

    fn draw<const N: usize>(
        range: &Self::Shared,
        own: &mut Own<A, N>,
        lane: usize,
        rng: &mut Pcg64,
    ) {
        if let Some(range) = range {
            own.set_model(lane, Model::new(range.draw(rng)));
        }
    }
}

/// A model for each lane.
#[derive(Clone, Debug)]
pub struct Own<A: Arithmetic, const N: usize> {
    constants: Constants<A, Lanes<A::Scalar, N>>,
    dt: Lanes<A::Scalar, N>,
    max_velocities: [Lanes<A::Scalar, N>; 2],
    torques: [[A::Scalar; N]; 3],
    noise: [A::Scalar; N],
    has_noise: bool,
    is_book: [bool; N],
    /// For [`params`](Self::params): a step does not read them.
    params: [Params<A::Scalar>; N],
}

impl<A: Arithmetic, const N: usize> Zeroed for Own<A, N> {
    const ZEROED: Self = Self {
        constants: Zeroed::ZEROED,
        dt: Zeroed::ZEROED,
        max_velocities: [Zeroed::ZEROED; 2],
        torques: [[A::Scalar::ZERO; N]; 3],
        noise: [A::Scalar::ZERO; N],
        has_noise: false,
        is_book: [false; N],
        params: [Params::DEFAULT; N],
    };
}

impl<A: Arithmetic, const N: usize> Own<A, N> {
    pub(super) fn params(&self, lane: usize) -> Option<&Params<A::Scalar>> {
        self.params.get(lane)
    }

    /// Replaces the parameters of a lane by valid ones.
    pub(super) fn set_params(&mut self, lane: usize, params: Params<A::Scalar>) {
        self.set_model(lane, Model::new(params));
    }

    fn set_model(&mut self, lane: usize, Model { params, constants }: Model<A>) {
        self.constants = A::Form::zip(self.constants, constants, |lanes, x| lanes.with(lane, x));
        self.dt = self.dt.with(lane, params.dt);
        let [max_velocity1, max_velocity2] = &mut self.max_velocities;
        set(&mut max_velocity1.0, lane, params.max_velocity1);
        set(&mut max_velocity2.0, lane, params.max_velocity2);
        for (lanes, torque) in self.torques.iter_mut().zip(params.torques) {
            set(lanes, lane, torque);
        }
        set(&mut self.noise, lane, params.torque_noise);
        self.has_noise = self.noise.iter().any(|noise| *noise > A::Scalar::ZERO);
        set(&mut self.is_book, lane, params.dynamics == Dynamics::Book);
        set(&mut self.params, lane, params);
    }
}

impl<A: Arithmetic, const N: usize> Coefficients<A, Lanes<A::Scalar, N>> for Own<A, N> {
    #[inline(always)]
    fn constants(&self) -> Constants<A, Lanes<A::Scalar, N>> {
        self.constants
    }

    #[inline(always)]
    fn dt(&self) -> Lanes<A::Scalar, N> {
        self.dt
    }

    #[inline(always)]
    fn max_velocities(&self) -> [Lanes<A::Scalar, N>; 2] {
        self.max_velocities
    }

    #[inline(always)]
    fn select(
        &self,
        book: Lanes<A::Scalar, N>,
        mut nips: Lanes<A::Scalar, N>,
    ) -> Lanes<A::Scalar, N> {
        for ((to, x), is_book) in nips.0.iter_mut().zip(book.0).zip(&self.is_book) {
            *to = if *is_book { x } else { *to };
        }
        nips
    }
}

impl<A: Arithmetic, const N: usize> BlockModel<A, N> for Own<A, N> {
    #[inline(always)]
    fn torques(&self) -> [[A::Scalar; N]; 3] {
        self.torques
    }

    #[inline(always)]
    fn noise(&self) -> Option<[A::Scalar; N]> {
        self.has_noise.then_some(self.noise)
    }
}
