//! `N` acrobots side by side, and their step.

use super::buffers::{StepBuffers, set, take_mut};
use super::inputs::Inputs;
use super::lane_params::LaneParams;
use super::settings::{Autoreset, Parameters, Settings};
use crate::arithmetic::{Arithmetic, Fast};
use crate::math::{Lanes, Numbers, Real, SinCos};
use crate::numpy::{Pcg64, uniform};
use crate::observation::Observation;
use crate::physics::{ResetBounds, State, reward, sin_cos, step};

/// The states of `N` acrobots that are stepped side by side. A [`Batch`](super::Batch) has several.
///
/// `N` = 16 suits a machine with SIMD. For a few acrobots, a smaller `N` wastes less memory:
///
/// ```
/// use acrobot::{Fast, batch::Block};
///
/// assert_eq!([size_of::<Block<Fast, 1>>(), size_of::<Block<Fast, 16>>()], [64, 640]);
/// ```
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Block<A: Arithmetic = Fast, const N: usize = 16> {
    /// θ1, θ2, θ̇1 and θ̇2.
    y: [Lanes<A::Scalar, N>; 4],
    /// Sines and cosines of θ1 and θ2, for the observation and the next step.
    sin_cos: [SinCos<Lanes<A::Scalar, N>>; 2],
    elapsed: [u32; N],
    /// Whether the next step resets the lane.
    reset_pending: [bool; N],
}

impl<A: Arithmetic, const N: usize> Block<A, N> {
    const ZEROS: Lanes<A::Scalar, N> = Lanes([A::Scalar::ZERO; N]);

    /// The number of acrobots in a block.
    pub const LANES: usize = N;

    /// A block to create a batch with, which resets it.
    pub const EMPTY: Self = Self {
        y: [Self::ZEROS; 4],
        sin_cos: [(Self::ZEROS, Self::ZEROS); 2],
        elapsed: [0; N],
        reset_pending: [false; N],
    };
}

// Lanes are accessed by iterators or `get`, so no compiler has to prove that an index cannot panic.
impl<A: Arithmetic, const N: usize> Block<A, N> {
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
        Some((*self.elapsed.get(lane)?, *self.reset_pending.get(lane)?))
    }

    pub(super) fn set_progress(&mut self, lane: usize, elapsed: u32, reset_pending: bool) {
        set(&mut self.elapsed, lane, elapsed);
        set(&mut self.reset_pending, lane, reset_pending);
    }

    pub(super) fn begin_episode(&mut self, lane: usize, state: State<A::Scalar>) {
        self.set_state(lane, state);
        self.set_progress(lane, 0, false);
    }

    /// Resets the lanes in `mask`, each with its generator, from which it first draws own
    /// parameters. A lane without one has no acrobot and hangs at rest.
    #[cold]
    pub(super) fn reset(
        &mut self,
        mask: &[bool; N],
        settings: &Settings<A>,
        bounds: ResetBounds,
        generators: &mut [Pcg64],
        mut lane_params: Option<&mut LaneParams<A, N>>,
    ) {
        let mut generators = generators.iter_mut();
        for (lane, resets) in mask.iter().enumerate() {
            let rng = generators.next();
            if *resets {
                let state = rng.map_or(State::HANGING, |rng| {
                    if let (Some(params), Parameters::Own(Some(range))) =
                        (&mut lane_params, &settings.parameters)
                    {
                        params.set(lane, range.draw(rng));
                    }
                    A::TASK.draw(bounds, rng).cast()
                });
                self.begin_episode(lane, state);
            }
        }
    }

    /// Ends pending resets: `SameStep` resets the lanes now, `Disabled` never.
    pub(super) fn settle_pending_resets(
        &mut self,
        settings: &Settings<A>,
        generators: &mut [Pcg64],
        lane_params: Option<&mut LaneParams<A, N>>,
    ) {
        let pending = self.reset_pending;
        match settings.autoreset {
            Autoreset::NextStep => {}
            Autoreset::SameStep => {
                self.reset(&pending, settings, settings.bounds, generators, lane_params);
            }
            Autoreset::Disabled => self.reset_pending = [false; N],
        }
    }

    #[inline(always)]
    fn rows(&self) -> impl Iterator<Item = [f32; 6]> {
        let [(sin1, cos1), (sin2, cos2)] = &self.sin_cos;
        let [_, _, dtheta1, dtheta2] = &self.y;
        let angles = (cos1.0.iter().zip(&sin1.0)).zip(cos2.0.iter().zip(&sin2.0));
        let all = angles.zip(dtheta1.0.iter().zip(&dtheta2.0));
        all.map(|(((cos1, sin1), (cos2, sin2)), (dtheta1, dtheta2))| {
            let sin_cos = [(*sin1, *cos1), (*sin2, *cos2)];
            Observation::of::<A>(sin_cos, [*dtheta1, *dtheta2]).to_array()
        })
    }

    /// Writes the observations, and removes the written elements from `to`.
    #[inline(always)]
    pub(super) fn observe(&self, to: &mut &mut [[f32; 6]]) {
        for (to, row) in take_mut(to, N).iter_mut().zip(self.rows()) {
            *to = row;
        }
    }

    #[cold]
    fn observe_masked(&self, mask: &[bool; N], to: &mut [[f32; 6]]) {
        for ((to, row), mask) in to.iter_mut().zip(self.rows()).zip(mask) {
            if *mask {
                *to = row;
            }
        }
    }

    /// One step of all lanes, without resets.
    #[inline(always)]
    pub(super) fn advance(
        &mut self,
        settings: &Settings<A>,
        LaneParams { model }: &LaneParams<A, N>,
        inputs: Inputs<'_, A::Scalar>,
        generators: &mut [Pcg64],
    ) -> Results<N> {
        let mut torques = inputs.torques(&model.params.torques);
        let noise = model.params.torque_noise;
        if !noise.all_within(Self::ZEROS) {
            add_noise(&mut torques.0, &noise.0, &self.reset_pending, generators);
        }
        let terminated = step::<A, _>(model, &mut self.y, &mut self.sin_cos, torques);
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
        if let Some(swingup) = reward::<A, _>(&model.params, self.sin_cos) {
            for (reward, x) in rewards.iter_mut().zip(swingup.0) {
                *reward = x.to_f64() as f32;
            }
        }
        let resets = match settings.autoreset {
            Autoreset::NextStep => core::mem::replace(&mut self.reset_pending, ended),
            Autoreset::SameStep => ended,
            Autoreset::Disabled => [false; N],
        };
        Results { rewards, terminated, truncated, resets }
    }

    /// Resets lanes whose episodes ended, writes the results, and removes the written elements from
    /// `buffers`.
    #[inline(always)]
    pub(super) fn finish(
        &mut self,
        settings: &Settings<A>,
        mut results: Results<N>,
        generators: &mut [Pcg64],
        lane_params: Option<&mut LaneParams<A, N>>,
        buffers: &mut StepBuffers<'_>,
    ) {
        let finals = buffers.final_observations.as_mut();
        let finals = finals.map(|rows| take_mut(rows, N));
        if results.resets.iter().fold(false, |any, &reset| any | reset) {
            if settings.autoreset == Autoreset::NextStep {
                results.clear();
            } else if let Some(finals) = finals {
                self.observe_masked(&results.resets, finals);
            }
            let (mask, bounds) = (&results.resets, settings.bounds);
            self.reset(mask, settings, bounds, generators, lane_params);
        }
        write(&mut buffers.rewards, &results.rewards);
        write(&mut buffers.terminated, &results.terminated);
        write(&mut buffers.truncated, &results.truncated);
        if let Some(rows) = &mut buffers.observations {
            self.observe(rows);
        }
    }
}

pub(super) struct Results<const N: usize> {
    rewards: [f32; N],
    terminated: [bool; N],
    truncated: [bool; N],
    /// Which lanes this step resets.
    resets: [bool; N],
}

impl<const N: usize> Results<N> {
    /// Clears the results of lanes that the step only resets.
    #[cold]
    fn clear(&mut self) {
        let results = self.rewards.iter_mut().zip(&mut self.terminated);
        let results = results.zip(&mut self.truncated).zip(self.resets);
        for (((reward, terminated), truncated), resets) in results {
            if resets {
                (*reward, *terminated, *truncated) = (0.0, false, false);
            }
        }
    }
}

/// Adds a noise draw to each torque, except in lanes without noise and in those that this step only
/// resets.
#[cold]
fn add_noise<S: Real, const N: usize>(
    torques: &mut [S; N],
    noise: &[S; N],
    reset_pending: &[bool; N],
    generators: &mut [Pcg64],
) {
    let lanes = torques.iter_mut().zip(noise).zip(reset_pending);
    for (((torque, noise), pending), rng) in lanes.zip(generators) {
        if *noise > S::ZERO && !pending {
            let noise = noise.to_f64();
            *torque = *torque + S::from_f64(uniform(rng, -noise, noise));
        }
    }
}

/// Writes as many elements as fit, and removes them from `to`.
#[inline(always)]
fn write<T: Copy, const N: usize>(to: &mut &mut [T], from: &[T; N]) {
    let to = take_mut(to, N);
    match <&mut [T; N]>::try_from(&mut *to) {
        Ok(to) => *to = *from,
        Err(_) => write_partial(to, from),
    }
}

/// Only the last block can have fewer than `N` acrobots. Out of line: a copy of a constant length
/// takes less time.
#[cold]
#[inline(never)]
fn write_partial<T: Copy>(to: &mut [T], from: &[T]) {
    to.iter_mut().zip(from).for_each(|(to, &from)| *to = from);
}
