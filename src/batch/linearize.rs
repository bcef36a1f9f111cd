//! The derivatives of one step of all acrobots.

use super::Batch;
use super::block::Block;
use super::buffers::{check_length, take, take_mut};
use super::inputs::Inputs;
use super::lane_params::LaneParams;
use super::storage::Storage;
use crate::arithmetic::Arithmetic;
use crate::control::model::StepModel;
use crate::control::model::by_params::by_params as by_params_of;
use crate::control::model::step_model::{by_bounds, clamp, derivatives};
use crate::error::Error;
use crate::math::matrix::{check_finite, transpose};
use crate::math::{Kernel, Lanes, Numbers, Real, Zeros, lanes, pair, set_lanes};
use crate::physics::{Params, step};
use crate::task::{Memory, Task};

impl<A: Arithmetic, S: Storage<A, N, T::Memory>, T: Task, const N: usize> Batch<A, S, T, N> {
    /// Linearizes one step of each acrobot about its state and a torque, N m: `models` are
    /// bit-identical to those of
    /// [`Pendulum::linearize_step`](crate::physics::Pendulum::linearize_step). `by_params` gets the
    /// derivatives of the state after the step by each parameter. Those by the torques of actions
    /// and by the torque noise are 0, because they do not act on this step. The width of Coulomb
    /// friction counts as constant.
    ///
    /// ```
    /// # use acrobot::Fast;
    /// # use acrobot::batch::{Batch, BatchMemory, Block};
    /// # use acrobot::control::model::StepModel;
    /// # use acrobot::numpy::Pcg64;
    /// # use acrobot::Params;
    /// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
    /// let batch = Batch::<Fast, _>::new(42, BatchMemory { blocks, generators, own: () })?;
    /// let mut models = [StepModel { a: [[0.0; 4]; 4], b: [0.0; 4] }; 3];
    /// let mut by_params = [Params::<f32>::DEFAULT.map(|_| [0.0; 4]); 3];
    /// batch.linearize_step_into(&[1.0; 3], &mut models, Some(&mut by_params))?; // N m
    /// let [.., dtheta2] = models[0].b; // rad/s per N m
    /// let [.., by_mass2] = by_params[0].mass2; // rad/s per kg
    /// assert!(dtheta2 > 0.0 && by_mass2 < 0.0); // a heavier link accelerates less
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::WrongLength`] unless each slice has one element for each acrobot,
    /// [`Error::OutOfRange`] for a torque that is not finite, and [`Error::NotFinite`] if a
    /// derivative overflows.
    pub fn linearize_step_into(
        &self,
        torques: &[A::Scalar],
        models: &mut [StepModel<A::Scalar>],
        by_params: Option<&mut [Params<[A::Scalar; 4]>]>,
    ) -> Result<(), Error> {
        Inputs::Torques(torques).check(self.len())?;
        check_length("models", models.len(), self.len())?;
        let slices = self.storage.slices();
        let shared = self.settings.shared.as_ref().map(LaneParams::shared);
        let (blocks, own, shared) = (slices.blocks, slices.lane_params, shared.as_ref());
        let mut by_params = by_params;
        if let Some(by_params) = &by_params {
            check_length("by_params", by_params.len(), self.len())?;
        }
        let mut sum = Zeros::ZEROS;
        let (all, by_all) = (&mut *models, by_params.as_deref_mut());
        let given = Linearize {
            blocks,
            own,
            shared,
            torques,
            models: all,
            by_params: by_all,
            sum: &mut sum,
        };
        self.simd_level.run(given);
        if sum.all_abs_le(Zeros::ZEROS) {
            return Ok(());
        }
        for StepModel { a, b } in models {
            check_finite("a", a.as_flattened())?;
            check_finite("b", b)?;
        }
        for each in by_params.into_iter().flatten() {
            check_finite("by_params", each.numbers().map(|(_, x)| x).as_flattened())?;
        }
        Ok(())
    }
}

struct Linearize<'a, A: Arithmetic, M: Memory, const N: usize> {
    blocks: &'a [Block<A, N, M>],
    own: &'a [LaneParams<A, N>],
    shared: Option<&'a LaneParams<A, N>>,
    torques: &'a [A::Scalar],
    models: &'a mut [StepModel<A::Scalar>],
    by_params: Option<&'a mut [Params<[A::Scalar; 4]>]>,
    /// Of 0 times each derivative, which is NaN if one is not finite.
    sum: &'a mut Lanes<A::Scalar, N>,
}

impl<A: Arithmetic, M: Memory, const N: usize> Kernel for Linearize<'_, A, M, N> {
    #[inline(always)]
    fn run<const AVX512: bool>(self) {
        let Self { mut torques, mut models, mut by_params, sum, .. } = self;
        let mut own = self.own.iter();
        for block in self.blocks {
            let Some(LaneParams { model }) = self.shared.or_else(|| own.next()) else { return };
            let torques = Inputs::Torques(take(&mut torques, N)).torques(&model.params.torques);
            let (y, sin_cos) = (block.y, block.sin_cos);
            let mut columns = [[Lanes([A::Scalar::ZERO; N]); 4]; 5];
            let local = *model;
            for i in 0..N {
                let own = local.zip(&local, |x, _| x.lane(i));
                let sin_cos = [pair(&sin_cos[0], i), pair(&sin_cos[1], i)];
                let of_lane = derivatives::<A, true>(&own, lanes(&y, i), sin_cos, torques.lane(i));
                for (column, x) in columns.iter_mut().zip(of_lane) {
                    set_lanes(column, i, x);
                }
            }
            let (mut end, mut of_end) = (y, sin_cos);
            step::<A, _>(model, &mut end, &mut of_end, torques);
            let sides = by_bounds::<A, _>(model, end);
            clamp(&mut columns, sides);
            add_zeros(sum, &columns);
            let [by1, by2, by3, by4, by_torque] = &columns;
            for (i, place) in take_mut(&mut models, N).iter_mut().enumerate().take(N) {
                let columns = [lanes(by1, i), lanes(by2, i), lanes(by3, i), lanes(by4, i)];
                *place = StepModel { a: transpose(&columns), b: lanes(by_torque, i) };
            }
            let Some(by_params) = &mut by_params else { continue };
            let mut columns = by_params_of::<A, _>(model, y, sin_cos, torques);
            clamp(&mut columns, sides);
            add_zeros(sum, &columns);
            let o = Lanes([A::Scalar::ZERO; N]);
            let (none, bound1, bound2) = ([o; 4], [o, o, sides[0], o], [o, o, o, sides[1]]);
            let [length1, masses_and_gravity @ .., d1, d2, c1, c2, rotor, dt] = &columns;
            let [m1, m2, lc1, lc2, i1, i2, gravity] = masses_and_gravity;
            let numbers = [
                length1, &none, m1, m2, lc1, lc2, i1, i2, gravity, dt, &bound1, &bound2, &none,
                &none, &none, &none, d1, d2, c1, c2, rotor,
            ];
            for (i, place) in take_mut(by_params, N).iter_mut().enumerate().take(N) {
                for (place, x) in place.numbers_mut().into_iter().zip(numbers) {
                    *place = lanes(x, i);
                }
            }
        }
    }
}

#[inline(always)]
fn add_zeros<S: Real, const N: usize>(sum: &mut Lanes<S, N>, columns: &[[Lanes<S, N>; 4]]) {
    for x in columns.as_flattened() {
        *sum = *sum + *x * Zeros::ZEROS;
    }
}
