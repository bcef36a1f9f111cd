//! What a step reads of the parameters: a number for each lane.

use super::buffers::set;
use crate::arithmetic::Arithmetic;
use crate::math::{Lanes, Numbers, Real, SinCos, Zeroed};
use crate::physics::{Coefficients, Constants, Dynamics, Equations, Model};

/// A model for each lane. Aligned, because an SSE instruction can read only aligned numbers from memory.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct LaneModel<A: Arithmetic, const N: usize> {
    constants: Constants<A, Lanes<A::Scalar, N>>,
    dt: Lanes<A::Scalar, N>,
    max_velocities: [Lanes<A::Scalar, N>; 2],
    /// The torques of the three actions, N m.
    pub(super) torques: [[A::Scalar; N]; 3],
    /// N m.
    pub(super) noise: [A::Scalar; N],
    pub(super) has_noise: bool,
    is_book: [bool; N],
}

impl<A: Arithmetic, const N: usize> Zeroed for LaneModel<A, N> {
    const ZEROED: Self = Self {
        constants: Zeroed::ZEROED,
        dt: Zeroed::ZEROED,
        max_velocities: [Zeroed::ZEROED; 2],
        torques: [[A::Scalar::ZERO; N]; 3],
        noise: [A::Scalar::ZERO; N],
        has_noise: false,
        is_book: [false; N],
    };
}

impl<A: Arithmetic, const N: usize> LaneModel<A, N> {
    /// The same model in all lanes.
    #[inline(always)]
    pub(super) fn splat(model: &Model<A>) -> Self {
        let params = &model.params;
        let [negative, zero, positive] = params.torques;
        Self {
            constants: A::Form::zip(model.constants, model.constants, |_, x| Lanes::splat(x)),
            dt: Lanes::splat(params.dt),
            max_velocities: [
                Lanes::splat(params.max_velocity1),
                Lanes::splat(params.max_velocity2),
            ],
            torques: [[negative; N], [zero; N], [positive; N]],
            noise: [params.torque_noise; N],
            has_noise: params.torque_noise > A::Scalar::ZERO,
            is_book: [params.dynamics == Dynamics::Book; N],
        }
    }

    /// Replaces the model of one lane.
    pub(super) fn set(&mut self, lane: usize, Model { params, constants }: Model<A>) {
        self.constants = A::Form::zip(self.constants, constants, |mut lanes, x| {
            set(&mut lanes.0, lane, x);
            lanes
        });
        set(&mut self.dt.0, lane, params.dt);
        let [max_velocity1, max_velocity2] = &mut self.max_velocities;
        set(&mut max_velocity1.0, lane, params.max_velocity1);
        set(&mut max_velocity2.0, lane, params.max_velocity2);
        for (lanes, torque) in self.torques.iter_mut().zip(params.torques) {
            set(lanes, lane, torque);
        }
        set(&mut self.noise, lane, params.torque_noise);
        self.has_noise = self.noise.iter().any(|noise| *noise > A::Scalar::ZERO);
        set(&mut self.is_book, lane, params.dynamics == Dynamics::Book);
    }
}

impl<A: Arithmetic, const N: usize> Coefficients<A, Lanes<A::Scalar, N>> for LaneModel<A, N> {
    #[inline(always)]
    fn constants(&self) -> &Constants<A, Lanes<A::Scalar, N>> {
        &self.constants
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

    #[inline(always)]
    fn sin_cos(&self, x: Lanes<A::Scalar, N>) -> SinCos<Lanes<A::Scalar, N>> {
        let (sin, cos) = A::sin_cos_lanes(x.0);
        (Lanes(sin), Lanes(cos))
    }
}
