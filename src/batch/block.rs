//! Some acrobots side by side, and one step of them.

use core::marker::PhantomData;

use super::{Autoreset, Observations, Shared, StepBuffers};
use crate::arithmetic::{Arithmetic, Lanes, Real, SinCos};
use crate::error::Error;
use crate::numpy::{Pcg64, uniform};
use crate::physics::{Params, StartBounds, State, check_torque, sin_cos, step};

/// The memory of `N` acrobots that are stepped side by side. A [`Batch`](super::Batch) consists of these.
///
/// Sixteen suit a machine with vectors. Fewer waste less where there are few acrobots: a `Block<f32, 1>` takes 64
/// bytes, one of sixteen 640.
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
    /// Of θ1 and θ2, for the observation and the next step.
    sin_cos: [SinCos<Lanes<S, N>>; 2],
    elapsed: [u32; N],
    /// Whether the next step resets.
    ended: [bool; N],
}

impl<S: Real, const N: usize> Block<S, N> {
    /// The number of acrobots in a block.
    pub const LANES: usize = N;

    /// A block before its acrobots are placed.
    pub const EMPTY: Self = Self {
        y: [Lanes([S::ZERO; N]); 4],
        sin_cos: [(Lanes([S::ZERO; N]), Lanes([S::ZERO; N])); 2],
        elapsed: [0; N],
        ended: [false; N],
    };
}

#[expect(
    clippy::indexing_slicing,
    reason = "lanes count up to N, and a batch has checked its slices"
)]
impl<S: Real, const N: usize> Block<S, N> {
    #[inline(always)]
    pub(super) fn state(&self, lane: usize) -> State<S> {
        self.y.map(|numbers| numbers.0[lane]).into()
    }

    /// Places a lane in a state, which leaves its episode as it is.
    pub(super) fn set_state<A: Arithmetic<Scalar = S>>(&mut self, lane: usize, state: State<S>) {
        let new = sin_cos::<A>([state.theta1, state.theta2]);
        for (numbers, number) in self.y.iter_mut().zip(<[S; 4]>::from(state)) {
            numbers.0[lane] = number;
        }
        for ((sines, cosines), (sin, cos)) in self.sin_cos.iter_mut().zip(new) {
            (sines.0[lane], cosines.0[lane]) = (sin, cos);
        }
    }

    /// The steps of a lane's episode, and whether the next one resets it.
    pub(super) fn progress(&self, lane: usize) -> (u32, bool) {
        (self.elapsed[lane], self.ended[lane])
    }

    /// Continues an episode in a lane.
    pub(super) fn resume<A: Arithmetic<Scalar = S>>(
        &mut self,
        lane: usize,
        state: State<S>,
        (elapsed, ended): (u32, bool),
    ) {
        self.set_state::<A>(lane, state);
        self.elapsed[lane] = elapsed;
        self.ended[lane] = ended;
    }

    /// Begins an episode in each of the first lanes.
    pub(super) fn reset_to<A: Arithmetic<Scalar = S>>(&mut self, states: &[State<S>]) {
        for (lane, state) in states.iter().enumerate().take(N) {
            self.resume::<A>(lane, *state, (0, false));
        }
    }

    /// Resets some lanes, each with its generator. A lane without one holds no acrobot and hangs at rest.
    #[cold]
    pub(super) fn reset<A: Arithmetic<Scalar = S>>(
        &mut self,
        some: &[bool; N],
        bounds: StartBounds,
        generators: &mut [Pcg64],
    ) {
        for lane in (0..N).filter(|&lane| some[lane]) {
            let state = match generators.get_mut(lane) {
                Some(rng) => bounds.draw(rng).cast(),
                None => State::default(),
            };
            self.resume::<A>(lane, state, (0, false));
        }
    }

    /// Makes the lanes that wait for their reset fit a mode in which none waits.
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

    /// Each acrobot's six numbers, lane by lane.
    #[inline(always)]
    fn seen(&self) -> [&[S; N]; 6] {
        let [(sin1, cos1), (sin2, cos2)] = &self.sin_cos;
        let [_, _, dtheta1, dtheta2] = &self.y;
        [&cos1.0, &sin1.0, &cos2.0, &sin2.0, &dtheta1.0, &dtheta2.0]
    }

    /// Writes the observations of this block, which is the one with this number.
    #[inline(always)]
    pub(super) fn observe(&self, number: usize, observations: &mut Observations<'_>) {
        let seen = self.seen();
        let start = number * N;
        match observations {
            Observations::None => {}
            Observations::Rows(rows) => {
                let rows = rows.iter_mut().skip(start).take(N);
                for (lane, row) in rows.enumerate() {
                    *row = seen.map(|numbers| numbers[lane].to_f64() as f32);
                }
            }
            Observations::Columns(columns) => {
                for (column, numbers) in columns.iter_mut().zip(seen) {
                    for (cell, x) in column.iter_mut().skip(start).zip(numbers) {
                        *cell = x.to_f64() as f32;
                    }
                }
            }
        }
    }

    /// [`observe`](Self::observe) for some of its lanes.
    #[cold]
    fn observe_some(&self, number: usize, some: &[bool; N], observations: &mut Observations<'_>) {
        for lane in (0..N).filter(|&lane| some[lane]) {
            let row = self.seen().map(|numbers| numbers[lane].to_f64() as f32);
            observations.write(number * N + lane, row);
        }
    }

    #[inline(always)]
    fn step<A: Arithmetic<Scalar = S>>(
        &mut self,
        shared: &Shared<A>,
        number: usize,
        mut torques: [S; N],
        generators: &mut [Pcg64],
        final_observations: &mut Observations<'_>,
    ) -> Stepped<N> {
        if shared.model.params.torque_noise > S::ZERO {
            self.add_noise(&mut torques, shared.model.params.torque_noise, generators);
        }
        let terminated = step(
            &shared.model,
            &mut self.y,
            &mut self.sin_cos,
            Lanes(torques),
        );
        let mut stepped = Stepped {
            rewards: [-1.0; N],
            terminated,
            truncated: [false; N],
        };
        let mut ended = [false; N];
        for lane in 0..N {
            self.elapsed[lane] = self.elapsed[lane].saturating_add(1);
            stepped.truncated[lane] = self.elapsed[lane] >= shared.limit.get();
            if terminated[lane] {
                stepped.rewards[lane] = 0.0;
            }
            ended[lane] = terminated[lane] | stepped.truncated[lane];
        }

        let resets = match shared.autoreset {
            Autoreset::NextStep => core::mem::replace(&mut self.ended, ended),
            Autoreset::SameStep => ended,
            Autoreset::Disabled => [false; N],
        };
        if resets.iter().fold(false, |any, &reset| any | reset) {
            if shared.autoreset == Autoreset::NextStep {
                stepped.clear(&resets);
            } else {
                self.observe_some(number, &resets, final_observations);
            }
            self.reset::<A>(&resets, shared.bounds, generators);
        }
        stepped
    }

    /// Adds a draw of the noise to each torque, except in lanes that this step only resets.
    #[cold]
    fn add_noise(&self, torques: &mut [S; N], noise: S, generators: &mut [Pcg64]) {
        let noise = noise.to_f64();
        let lanes = torques.iter_mut().zip(&self.ended).zip(generators);
        for ((torque, _), rng) in lanes.filter(|((_, ended), _)| !**ended) {
            *torque = *torque + S::from_f64(uniform(rng, -noise, noise));
        }
    }
}

/// What a step of one block returns.
struct Stepped<const N: usize> {
    rewards: [f32; N],
    terminated: [bool; N],
    truncated: [bool; N],
}

impl<const N: usize> Stepped<N> {
    /// For lanes that the step only resets.
    #[cold]
    fn clear(&mut self, resets: &[bool; N]) {
        let each = self.rewards.iter_mut().zip(&mut self.terminated);
        let each = each.zip(&mut self.truncated).zip(resets);
        for (((reward, terminated), truncated), _) in each.filter(|(_, reset)| **reset) {
            (*reward, *terminated, *truncated) = (0.0, false, false);
        }
    }
}

/// What drives a batch for one step.
pub(super) trait Drive<S> {
    /// The argument's name, for errors.
    const NAME: &'static str;

    /// What each acrobot is given.
    type Input: Copy + Sync;

    /// Rejects an input that is not valid.
    fn check(inputs: &[Self::Input]) -> Result<(), Error>;

    /// The torques of one block in N m. Lanes without an input get one that is valid.
    fn torques<const N: usize>(params: &Params<S>, inputs: &[Self::Input]) -> [S; N];
}

/// Action numbers, which are 0, 1 and 2.
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

/// Torques in N m, which are finite.
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
    generators: &mut [Pcg64],
    inputs: &[D::Input],
    mut buffers: StepBuffers<'_>,
) {
    let each = inputs
        .chunks(N)
        .zip(generators.chunks_mut(N))
        .zip(buffers.rewards.chunks_mut(N))
        .zip(buffers.terminated.chunks_mut(N))
        .zip(buffers.truncated.chunks_mut(N));
    for ((number, block), ((((inputs, generators), rewards), terminated), truncated)) in
        blocks.iter_mut().enumerate().zip(each)
    {
        let torques = D::torques(&shared.model.params, inputs);
        let finals = &mut buffers.final_observations;
        let stepped = block.step(shared, number, torques, generators, finals);
        write(rewards, &stepped.rewards);
        write(terminated, &stepped.terminated);
        write(truncated, &stepped.truncated);
        block.observe(number, &mut buffers.observations);
    }
}

/// A block's inputs, converted. The last block may have fewer; the rest of its lanes get `rest`.
#[inline(always)]
fn read<T: Copy, U: Copy, const N: usize>(from: &[T], rest: U, convert: impl Fn(T) -> U) -> [U; N] {
    let mut to = [rest; N];
    // A whole block is a loop of known length, which LLVM turns into vectors.
    match from.first_chunk::<N>() {
        Some(all) => to.iter_mut().zip(all).for_each(|(to, &x)| *to = convert(x)),
        None => to
            .iter_mut()
            .zip(from)
            .for_each(|(to, &x)| *to = convert(x)),
    }
    to
}

/// Writes as many as there is room for.
#[inline(always)]
fn write<T: Copy, const N: usize>(to: &mut [T], from: &[T; N]) {
    match to.first_chunk_mut() {
        Some(to) => *to = *from,
        None => to.iter_mut().zip(from).for_each(|(to, &from)| *to = from),
    }
}
