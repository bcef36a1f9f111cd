//! `N` acrobots side by side, and their step.

use core::hint::black_box;

use super::buffers::{set, take_mut};
use super::inputs::Inputs;
use super::params::{ParamsKind, SharedParams};
use super::{Autoreset, Observations, Settings, StepBuffers};
use crate::arithmetic::{Arithmetic, Fast};
use crate::math::{Lanes, Real, SinCos, Zeroed};
use crate::numpy::{Pcg64, uniform};
use crate::physics::{ResetBounds, State, sin_cos, step};

/// The memory of `N` acrobots that are stepped side by side. A [`Batch`](super::Batch) consists of these.
///
/// `N` = 16 suits a machine with SIMD. For a few acrobots, a smaller `N` wastes less memory: a `Block<Fast, 1>` takes 64
/// bytes, a `Block<Fast, 16>` 640. With [`OwnParams`](super::OwnParams) it has the parameters of its acrobots, too.
///
/// ```
/// use acrobot::Fast;
/// use acrobot::batch::{Block, OwnParams};
///
/// let blocks = vec![Block::<Fast>::EMPTY; 1000_usize.div_ceil(Block::<Fast>::LANES)];
/// assert_eq!(size_of_val(&blocks[..]), 63 * 640);
/// assert_eq!(size_of::<Block<Fast, 1>>(), 64);
/// assert_eq!(size_of::<Block<Fast, 16, OwnParams>>(), 2880);
/// ```
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Block<A: Arithmetic = Fast, const N: usize = 16, P: ParamsKind<A> = SharedParams> {
    /// θ1, θ2, θ̇1 and θ̇2.
    y: [Lanes<A::Scalar, N>; 4],
    /// Sines and cosines of θ1 and θ2, for the observation and the next step.
    sin_cos: [SinCos<Lanes<A::Scalar, N>>; 2],
    elapsed: [u32; N],
    /// Whether the next step resets the lane.
    ended: [bool; N],
    pub(super) own: P::Own<N>,
}

impl<A: Arithmetic, const N: usize, P: ParamsKind<A>> Block<A, N, P> {
    /// The number of acrobots in a block.
    pub const LANES: usize = N;

    /// A block to create a batch with, which resets it.
    pub const EMPTY: Self = Self {
        y: [Zeroed::ZEROED; 4],
        sin_cos: [(Zeroed::ZEROED, Zeroed::ZEROED); 2],
        elapsed: [0; N],
        ended: [false; N],
        own: Zeroed::ZEROED,
    };
}

// Lanes are accessed by iterators or `get`, so no compiler has to prove that an index cannot panic.
impl<A: Arithmetic, const N: usize, P: ParamsKind<A>> Block<A, N, P> {
    pub(super) fn state(&self, lane: usize) -> Option<State<A::Scalar>> {
        let [theta1, theta2, dtheta1, dtheta2] = &self.y;
        Some(State {
            theta1: *theta1.0.get(lane)?,
            theta2: *theta2.0.get(lane)?,
            dtheta1: *dtheta1.0.get(lane)?,
            dtheta2: *dtheta2.0.get(lane)?,
        })
    }

    /// Sets the state of a lane. Its episode continues.
    pub(super) fn set_state(&mut self, lane: usize, state: State<A::Scalar>) {
        let new = sin_cos::<A>([state.theta1, state.theta2]);
        for (numbers, number) in self.y.iter_mut().zip(<[A::Scalar; 4]>::from(state)) {
            set(&mut numbers.0, lane, number);
        }
        for ((sines, cosines), (sin, cos)) in self.sin_cos.iter_mut().zip(new) {
            set(&mut sines.0, lane, sin);
            set(&mut cosines.0, lane, cos);
        }
    }

    /// The number of steps of a lane's episode, and whether the next step resets it.
    pub(super) fn progress(&self, lane: usize) -> Option<(u32, bool)> {
        Some((*self.elapsed.get(lane)?, *self.ended.get(lane)?))
    }

    /// Sets the state and the progress of a lane.
    pub(super) fn resume(
        &mut self,
        lane: usize,
        state: State<A::Scalar>,
        (elapsed, ended): (u32, bool),
    ) {
        self.set_state(lane, state);
        set(&mut self.elapsed, lane, elapsed);
        set(&mut self.ended, lane, ended);
    }

    /// Resets the lanes in `some`, each with its generator. A lane without one has no acrobot and hangs at rest.
    #[cold]
    pub(super) fn reset(
        &mut self,
        some: &[bool; N],
        params: &P::Shared,
        bounds: ResetBounds,
        generators: &mut [Pcg64],
    ) {
        let mut generators = generators.iter_mut();
        for (lane, resets) in some.iter().enumerate() {
            let rng = generators.next();
            if *resets {
                let state = rng.map_or(State::HANGING, |rng| {
                    P::draw(params, &mut self.own, lane, rng);
                    bounds.draw(rng).cast()
                });
                self.resume(lane, state, (0, false));
            }
        }
    }

    /// Ends pending resets: `SameStep` resets the lanes now, `Disabled` never.
    pub(super) fn stop_waiting(&mut self, settings: &Settings<A, P>, generators: &mut [Pcg64]) {
        let ended = self.ended;
        match settings.autoreset {
            Autoreset::NextStep => {}
            Autoreset::SameStep => {
                self.reset(&ended, &settings.params, settings.bounds, generators);
            }
            Autoreset::Disabled => self.ended = [false; N],
        }
    }

    /// The observations: six columns with one number for each lane.
    #[inline(always)]
    fn columns(&self) -> [&[A::Scalar; N]; 6] {
        let [(sin1, cos1), (sin2, cos2)] = &self.sin_cos;
        let [_, _, dtheta1, dtheta2] = &self.y;
        [&cos1.0, &sin1.0, &cos2.0, &sin2.0, &dtheta1.0, &dtheta2.0]
    }

    /// The observations: one row of six numbers for each lane.
    #[inline(always)]
    fn rows(&self) -> impl Iterator<Item = [f32; 6]> {
        let [cos1, sin1, cos2, sin2, dtheta1, dtheta2] = self.columns();
        let angles = cos1.iter().zip(sin1).zip(cos2.iter().zip(sin2));
        let all = angles.zip(dtheta1.iter().zip(dtheta2));
        all.map(|(((cos1, sin1), (cos2, sin2)), (dtheta1, dtheta2))| {
            [cos1, sin1, cos2, sin2, dtheta1, dtheta2].map(|x| x.to_f64() as f32)
        })
    }

    /// Writes the observations, and removes the written elements from `to`.
    #[inline(always)]
    pub(super) fn observe(&self, to: &mut Observations<'_>) {
        match to {
            Observations::None => {}
            Observations::Rows(rows) => {
                for (to, row) in take_mut(rows, N).iter_mut().zip(self.rows()) {
                    *to = row;
                }
            }
            Observations::Columns(columns) => {
                for (to, column) in columns.iter_mut().zip(self.columns()) {
                    for (to, x) in take_mut(to, N).iter_mut().zip(column) {
                        *to = x.to_f64() as f32;
                    }
                }
            }
        }
    }

    /// Writes the observations of the lanes in `some`, at their index in `to`.
    #[cold]
    fn observe_some(&self, some: &[bool; N], to: &mut Observations<'_>) {
        for ((lane, row), _) in self
            .rows()
            .enumerate()
            .zip(some)
            .filter(|(_, is_one)| **is_one)
        {
            to.write(lane, row);
        }
    }

    /// One step of all lanes. Writes the results, and removes the written elements from `buffers`.
    #[inline(always)]
    fn step(
        &mut self,
        settings: &Settings<A, P>,
        splat: &P::Splat<N>,
        inputs: Inputs<'_, A::Scalar>,
        generators: &mut [Pcg64],
        buffers: &mut StepBuffers<'_>,
    ) {
        let model = P::model(splat, &self.own);
        let mut torques = inputs.torques(model);
        if model.has_noise {
            add_noise(&mut torques, &model.noise, &self.ended, generators);
        }
        let torques = Lanes(torques);
        let mut terminated = step::<A, _>(model, &mut self.y, &mut self.sin_cos, torques);
        let (mut rewards, mut truncated, mut ended) = ([-1.0; N], [false; N], [false; N]);
        let results = rewards.iter_mut().zip(&mut truncated).zip(&mut ended);
        for ((elapsed, terminated), ((reward, truncated), ended)) in
            self.elapsed.iter_mut().zip(&terminated).zip(results)
        {
            *elapsed = elapsed.saturating_add(1);
            *truncated = *elapsed >= settings.limit.get();
            if *terminated {
                *reward = 0.0;
            }
            *ended = *terminated | *truncated;
        }

        let resets = match settings.autoreset {
            Autoreset::NextStep => core::mem::replace(&mut self.ended, ended),
            Autoreset::SameStep => ended,
            Autoreset::Disabled => [false; N],
        };
        if resets.iter().fold(false, |any, &reset| any | reset) {
            if settings.autoreset == Autoreset::NextStep {
                clear(&resets, &mut rewards, &mut terminated, &mut truncated);
            } else {
                self.observe_some(&resets, &mut buffers.final_observations);
            }
            self.reset(&resets, &settings.params, settings.bounds, generators);
        }
        buffers.final_observations.take(N);
        write(&mut buffers.rewards, &rewards);
        write(&mut buffers.terminated, &terminated);
        write(&mut buffers.truncated, &truncated);
        self.observe(&mut buffers.observations);
    }
}

/// Adds a noise draw to each torque, except in lanes without noise and in those that this step only resets.
#[cold]
fn add_noise<S: Real, const N: usize>(
    torques: &mut [S; N],
    noise: &[S; N],
    ended: &[bool; N],
    generators: &mut [Pcg64],
) {
    let lanes = torques.iter_mut().zip(noise).zip(ended).zip(generators);
    for (((torque, noise), _), rng) in
        lanes.filter(|(((_, noise), ended), _)| **noise > S::ZERO && !**ended)
    {
        let noise = noise.to_f64();
        *torque = *torque + S::from_f64(uniform(rng, -noise, noise));
    }
}

/// Sets the results of lanes that the step only resets.
#[cold]
fn clear<const N: usize>(
    resets: &[bool; N],
    rewards: &mut [f32; N],
    terminated: &mut [bool; N],
    truncated: &mut [bool; N],
) {
    let results = rewards.iter_mut().zip(terminated).zip(truncated);
    for (((reward, terminated), truncated), _) in results.zip(resets).filter(|(_, reset)| **reset) {
        (*reward, *terminated, *truncated) = (0.0, false, false);
    }
}

/// Steps all blocks. `HIDE` hides from the compiler that they share a model. With AVX-512 it would otherwise hold the
/// model in registers and spill the state.
#[inline(always)]
pub(super) fn step_blocks<A, const N: usize, P, const HIDE: bool>(
    settings: &Settings<A, P>,
    blocks: &mut [Block<A, N, P>],
    mut generators: &mut [Pcg64],
    mut inputs: Inputs<'_, A::Scalar>,
    mut buffers: StepBuffers<'_>,
) where
    A: Arithmetic,
    P: ParamsKind<A>,
{
    let splat = P::splat(&settings.params);
    for block in blocks {
        let splat = if HIDE { black_box(&splat) } else { &splat };
        let inputs = inputs.take(N);
        let generators = take_mut(&mut generators, N);
        block.step(settings, splat, inputs, generators, &mut buffers);
    }
}

/// Writes as many elements as fit, and removes them from `to`.
#[inline(always)]
fn write<T: Copy, const N: usize>(to: &mut &mut [T], from: &[T; N]) {
    let to = take_mut(to, N);
    match <&mut [T; N]>::try_from(&mut *to) {
        Ok(to) => *to = *from,
        Err(_) => write_some(to, from),
    }
}

/// Only the last block can have fewer than `N` acrobots. Out of line, because a copy of a constant length takes less
/// time.
#[cold]
#[inline(never)]
fn write_some<T: Copy>(to: &mut [T], from: &[T]) {
    to.iter_mut().zip(from).for_each(|(to, &from)| *to = from);
}
