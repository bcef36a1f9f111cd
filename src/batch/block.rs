//! `N` acrobots side by side, and their step.

use core::marker::PhantomData;

use super::buffers::{take, take_mut};
use super::{Autoreset, Observations, Shared, StepBuffers};
use crate::arithmetic::{Arithmetic, Lanes, Real, SinCos};
use crate::error::Error;
use crate::numpy::{Pcg64, uniform};
use crate::physics::{Params, ResetBounds, State, check_torque, sin_cos, step};

/// The memory of `N` acrobots that are stepped side by side. A [`Batch`](super::Batch) consists of these.
///
/// `N` = 16 suits a machine with SIMD. For a few acrobots, a smaller `N` wastes less memory: a `Block<f32, 1>` takes 64
/// bytes, a `Block<f32, 16>` 640.
///
/// ```
/// use acrobot::batch::Block;
///
/// let blocks = vec![Block::<f32>::EMPTY; 1000_usize.div_ceil(Block::<f32>::LANES)];
/// assert_eq!(size_of_val(&blocks[..]), 63 * 640);
/// assert_eq!(size_of::<Block<f32, 1>>(), 64);
/// ```
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Block<S = f32, const N: usize = 16> {
    /// θ1, θ2, θ̇1 and θ̇2.
    y: [Lanes<S, N>; 4],
    /// Sines and cosines of θ1 and θ2, for the observation and the next step.
    sin_cos: [SinCos<Lanes<S, N>>; 2],
    elapsed: [u32; N],
    /// Whether the next step resets the lane.
    ended: [bool; N],
}

impl<S: Real, const N: usize> Block<S, N> {
    /// The number of acrobots in a block.
    pub const LANES: usize = N;

    /// A block to create a batch with, which resets it.
    pub const EMPTY: Self = Self {
        y: [Lanes([S::ZERO; N]); 4],
        sin_cos: [(Lanes([S::ZERO; N]), Lanes([S::ZERO; N])); 2],
        elapsed: [0; N],
        ended: [false; N],
    };
}

// Lanes are accessed by iterators or `get`, so no compiler has to prove that an index cannot panic.
impl<S: Real, const N: usize> Block<S, N> {
    pub(super) fn state(&self, lane: usize) -> Option<State<S>> {
        let [theta1, theta2, dtheta1, dtheta2] = &self.y;
        Some(State {
            theta1: *theta1.0.get(lane)?,
            theta2: *theta2.0.get(lane)?,
            dtheta1: *dtheta1.0.get(lane)?,
            dtheta2: *dtheta2.0.get(lane)?,
        })
    }

    /// Sets the state of a lane. Its episode continues.
    pub(super) fn set_state<A: Arithmetic<Scalar = S>>(&mut self, lane: usize, state: State<S>) {
        let new = sin_cos::<A>([state.theta1, state.theta2]);
        for (numbers, number) in self.y.iter_mut().zip(<[S; 4]>::from(state)) {
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
    pub(super) fn resume<A: Arithmetic<Scalar = S>>(
        &mut self,
        lane: usize,
        state: State<S>,
        (elapsed, ended): (u32, bool),
    ) {
        self.set_state::<A>(lane, state);
        set(&mut self.elapsed, lane, elapsed);
        set(&mut self.ended, lane, ended);
    }

    /// Begins an episode in the first lanes, one for each state.
    pub(super) fn reset_to<A: Arithmetic<Scalar = S>>(&mut self, states: &[State<S>]) {
        for (lane, state) in states.iter().enumerate() {
            self.resume::<A>(lane, *state, (0, false));
        }
    }

    /// Resets the lanes in `some`, each with its generator. A lane without one has no acrobot and hangs at rest.
    #[cold]
    pub(super) fn reset<A: Arithmetic<Scalar = S>>(
        &mut self,
        some: &[bool; N],
        bounds: ResetBounds,
        generators: &mut [Pcg64],
    ) {
        let mut generators = generators.iter_mut();
        for (lane, resets) in some.iter().enumerate() {
            let rng = generators.next();
            if *resets {
                let state = rng.map_or(State::HANGING, |rng| bounds.draw(rng).cast());
                self.resume::<A>(lane, state, (0, false));
            }
        }
    }

    /// Ends pending resets: `SameStep` resets the lanes now, `Disabled` never.
    pub(super) fn stop_waiting<A: Arithmetic<Scalar = S>>(
        &mut self,
        shared: &Shared<A>,
        generators: &mut [Pcg64],
    ) {
        let ended = self.ended;
        match shared.autoreset {
            Autoreset::NextStep => {}
            Autoreset::SameStep => self.reset::<A>(&ended, shared.bounds, generators),
            Autoreset::Disabled => self.ended = [false; N],
        }
    }

    /// The observations: six columns with one number for each lane.
    #[inline(always)]
    fn columns(&self) -> [&[S; N]; 6] {
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
    fn step<A: Arithmetic<Scalar = S>>(
        &mut self,
        shared: &Shared<A>,
        mut torques: [S; N],
        generators: &mut [Pcg64],
        buffers: &mut StepBuffers<'_>,
    ) {
        if shared.model.params.torque_noise > S::ZERO {
            self.add_noise(&mut torques, shared.model.params.torque_noise, generators);
        }
        let mut terminated = step(
            &shared.model,
            &mut self.y,
            &mut self.sin_cos,
            Lanes(torques),
        );
        let (mut rewards, mut truncated, mut ended) = ([-1.0; N], [false; N], [false; N]);
        let results = rewards.iter_mut().zip(&mut truncated).zip(&mut ended);
        for ((elapsed, terminated), ((reward, truncated), ended)) in
            self.elapsed.iter_mut().zip(&terminated).zip(results)
        {
            *elapsed = elapsed.saturating_add(1);
            *truncated = *elapsed >= shared.limit.get();
            if *terminated {
                *reward = 0.0;
            }
            *ended = *terminated | *truncated;
        }

        let resets = match shared.autoreset {
            Autoreset::NextStep => core::mem::replace(&mut self.ended, ended),
            Autoreset::SameStep => ended,
            Autoreset::Disabled => [false; N],
        };
        if resets.iter().fold(false, |any, &reset| any | reset) {
            if shared.autoreset == Autoreset::NextStep {
                clear(&resets, &mut rewards, &mut terminated, &mut truncated);
            } else {
                self.observe_some(&resets, &mut buffers.final_observations);
            }
            self.reset::<A>(&resets, shared.bounds, generators);
        }
        buffers.final_observations.take(N);
        write(&mut buffers.rewards, &rewards);
        write(&mut buffers.terminated, &terminated);
        write(&mut buffers.truncated, &truncated);
        self.observe(&mut buffers.observations);
    }

    /// Adds a noise draw to each torque, except in lanes that this step only resets.
    #[cold]
    fn add_noise(&self, torques: &mut [S; N], noise: S, generators: &mut [Pcg64]) {
        let noise = noise.to_f64();
        let lanes = torques.iter_mut().zip(&self.ended).zip(generators);
        for ((torque, _), rng) in lanes.filter(|((_, ended), _)| !**ended) {
            *torque = *torque + S::from_f64(uniform(rng, -noise, noise));
        }
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

fn set<T>(lanes: &mut [T], lane: usize, x: T) {
    if let Some(to) = lanes.get_mut(lane) {
        *to = x;
    }
}

/// The kind of input to a step: actions or torques.
pub(super) trait Drive<S> {
    /// The argument's name, for errors.
    const NAME: &'static str;

    /// The input to one acrobot.
    type Input: Copy + Sync;

    /// Rejects invalid inputs.
    fn check(inputs: &[Self::Input]) -> Result<(), Error>;

    /// The torques of one block, N m. Lanes without an input get a valid torque.
    fn torques<const N: usize>(params: &Params<S>, inputs: &[Self::Input]) -> [S; N];
}

/// Action numbers: 0, 1 and 2.
pub(super) struct Actions<T>(PhantomData<T>);

impl<S: Real, T: Copy + Into<u8> + Sync> Drive<S> for Actions<T> {
    const NAME: &'static str = "actions";

    type Input = T;

    fn check(inputs: &[T]) -> Result<(), Error> {
        match inputs.iter().map(|&action| action.into()).fold(0, u8::max) {
            0..=2 => Ok(()),
            highest => Err(Error::UnknownAction(highest)),
        }
    }

    #[inline(always)]
    fn torques<const N: usize>(params: &Params<S>, inputs: &[T]) -> [S; N] {
        let [_, idle, _] = params.torques;
        read(inputs, idle, |action| {
            S::pick(params.torques, action.into())
        })
    }
}

/// Finite torques, N m.
pub(super) struct Torques;

impl<S: Real> Drive<S> for Torques {
    const NAME: &'static str = "torques";

    type Input = S;

    fn check(inputs: &[S]) -> Result<(), Error> {
        inputs.iter().try_for_each(|torque| check_torque(*torque))
    }

    #[inline(always)]
    fn torques<const N: usize>(_: &Params<S>, inputs: &[S]) -> [S; N] {
        read(inputs, S::ZERO, |torque| torque)
    }
}

#[inline(always)]
pub(super) fn step_blocks<A: Arithmetic, D: Drive<A::Scalar>, const N: usize>(
    shared: &Shared<A>,
    blocks: &mut [Block<A::Scalar, N>],
    mut generators: &mut [Pcg64],
    mut inputs: &[D::Input],
    mut buffers: StepBuffers<'_>,
) {
    for block in blocks {
        let torques = D::torques(&shared.model.params, take(&mut inputs, N));
        let generators = take_mut(&mut generators, N);
        block.step(shared, torques, generators, &mut buffers);
    }
}

/// Converts a block's inputs. The last block may have fewer than `N`; its other lanes get `rest`.
#[inline(always)]
fn read<T: Copy, U: Copy, const N: usize>(from: &[T], rest: U, convert: impl Fn(T) -> U) -> [U; N] {
    let mut to = [rest; N];
    for (to, &x) in to.iter_mut().zip(from) {
        *to = convert(x);
    }
    to
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
