//! Some acrobots side by side, and one step of them.

use core::any::{Any, TypeId};
use core::array::from_fn;

use super::{Autoreset, Observations, Output, Shared};
use crate::acrobot::transition;
use crate::arithmetic::{Arithmetic, Fast, Form, Numbers, Real, kernel};
use crate::dynamics::{Driven, Model, sin_cos};
use crate::lanes::Lanes;
use crate::params::Params;
use crate::rk4::rk4_from;
use crate::rng::{Pcg64, uniform};
use crate::state::{StartBounds, State};

/// The memory of `N` acrobots that are stepped side by side: what a [`Batch`](crate::Batch) lives in.
///
/// Sixteen suit a machine with vectors. Fewer waste less where there are few acrobots: a `Block<f32, 1>`
/// takes 64 bytes, one of sixteen 640.
///
/// ```
/// use acrobot::Block;
///
/// let blocks = vec![Block::<f32>::EMPTY; 1000_usize.div_ceil(Block::<f32>::LANES)];
/// assert_eq!(size_of_val(&blocks[..]), 63 * 640);
/// assert_eq!(size_of::<Block<f32, 1>>(), 64);
/// ```
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Block<S = f32, const N: usize = 16> {
    /// θ1, θ2, θ̇1 and θ̇2.
    state: [[S; N]; 4],
    /// cos θ1, sin θ1, cos θ2 and sin θ2: the order of an observation.
    cos_sin: [[S; N]; 4],
    elapsed: [u32; N],
    /// Whether the next step resets.
    ended: [bool; N],
}

impl<S: Real, const N: usize> Block<S, N> {
    /// How many acrobots a block holds.
    pub const LANES: usize = N;

    /// Memory in which no acrobot lives yet.
    pub const EMPTY: Self = Self {
        state: [[S::ZERO; N]; 4],
        cos_sin: [[S::ZERO; N]; 4],
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
        State::from(self.state.map(|numbers| numbers[lane]))
    }

    #[inline(always)]
    fn place(&mut self, lane: usize, state: State<S>, [(sin1, cos1), (sin2, cos2)]: [(S, S); 2]) {
        for (numbers, number) in self.state.iter_mut().zip(<[S; 4]>::from(state)) {
            numbers[lane] = number;
        }
        for (numbers, number) in self.cos_sin.iter_mut().zip([cos1, sin1, cos2, sin2]) {
            numbers[lane] = number;
        }
    }

    pub(super) fn reset_to<A: Arithmetic<Scalar = S>>(&mut self, states: &[State<S>]) {
        for (lane, state) in states.iter().enumerate().take(N) {
            self.begin::<A>(lane, *state);
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
        self.begin::<A>(lane, state);
        self.elapsed[lane] = elapsed;
        self.ended[lane] = ended;
    }

    fn begin<A: Arithmetic<Scalar = S>>(&mut self, lane: usize, start: State<S>) {
        self.place(lane, start, sin_cos::<A>(&start));
        self.elapsed[lane] = 0;
        self.ended[lane] = false;
    }

    /// Resets some, each by its generator. A lane without one holds no acrobot, and hangs at rest.
    #[cold]
    pub(super) fn reset<A: Arithmetic<Scalar = S>>(
        &mut self,
        some: &[bool; N],
        bounds: StartBounds,
        generators: &mut [Pcg64],
    ) {
        for lane in (0..N).filter(|&lane| some[lane]) {
            let start = match generators.get_mut(lane) {
                Some(rng) => bounds.draw(rng).cast(),
                None => State::default(),
            };
            self.begin::<A>(lane, start);
        }
    }

    /// Resets those that wait for the next step to do it.
    pub(super) fn reset_ended<A: Arithmetic<Scalar = S>>(
        &mut self,
        bounds: StartBounds,
        generators: &mut [Pcg64],
    ) {
        let ended = self.ended;
        self.reset::<A>(&ended, bounds, generators);
    }

    /// Six times a number of each acrobot.
    #[inline(always)]
    fn seen(&self) -> [&[S; N]; 6] {
        let [cos1, sin1, cos2, sin2] = &self.cos_sin;
        let [_, _, dtheta1, dtheta2] = &self.state;
        [cos1, sin1, cos2, sin2, dtheta1, dtheta2]
    }

    /// What is seen of the block of that number, written where it belongs.
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

    /// The same for some of its lanes.
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
        shared: &Shared<S>,
        number: usize,
        actions: &[u8; N],
        generators: &mut [Pcg64],
        final_observations: &mut Observations<'_>,
    ) -> Stepped<N> {
        let params = &shared.model.params;
        let torques = if params.torque_noise > S::ZERO {
            self.noisy_torques(params, actions, generators)
        } else {
            actions.map(|action| S::pick(params.torques, action))
        };
        let terminated = self.advance::<A>(&shared.model, torques);
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
        };
        if resets.iter().fold(false, |any, &reset| any | reset) {
            match shared.autoreset {
                Autoreset::NextStep => stepped.forget(&resets),
                Autoreset::SameStep => self.observe_some(number, &resets, final_observations),
            }
            self.reset::<A>(&resets, shared.bounds, generators);
        }
        stepped
    }

    /// Applies a torque to each for one `dt`, and says which are in the goal.
    #[inline(always)]
    fn advance<A: Arithmetic<Scalar = S>>(
        &mut self,
        model: &Model<S>,
        torques: [S; N],
    ) -> [bool; N] {
        if TypeId::of::<A>() == TypeId::of::<Fast>() {
            let all: (&mut dyn Any, &dyn Any) = (self, model);
            if let (Some(block), Some(model)) = (all.0.downcast_mut(), all.1.downcast_ref()) {
                return advance_lanes(block, model, torques.map(|torque| torque.to_f64() as f32));
            }
        }
        from_fn(|lane| {
            let mut state = self.state(lane);
            let [cos1, sin1, cos2, sin2] = self.cos_sin.map(|numbers| numbers[lane]);
            let mut sin_cos = [(sin1, cos1), (sin2, cos2)];
            let terminated = transition::<A>(model, &mut state, &mut sin_cos, torques[lane]);
            self.place(lane, state, sin_cos);
            terminated
        })
    }

    /// With a draw of the noise for each that is not to be reset.
    #[cold]
    fn noisy_torques(
        &self,
        params: &Params<S>,
        actions: &[u8; N],
        generators: &mut [Pcg64],
    ) -> [S; N] {
        let noise = params.torque_noise.to_f64();
        from_fn(|lane| {
            let torque = S::pick(params.torques, actions[lane]);
            match generators.get_mut(lane) {
                Some(rng) if !self.ended[lane] => torque + S::from_f64(uniform(rng, -noise, noise)),
                _ => torque,
            }
        })
    }
}

/// What a step of one block returns.
struct Stepped<const N: usize> {
    rewards: [f32; N],
    terminated: [bool; N],
    truncated: [bool; N],
}

impl<const N: usize> Stepped<N> {
    /// What a step that only resets has none of.
    #[cold]
    fn forget(&mut self, resets: &[bool; N]) {
        let each = self.rewards.iter_mut().zip(&mut self.terminated);
        let each = each.zip(&mut self.truncated).zip(resets);
        for (((reward, terminated), truncated), _) in each.filter(|(_, reset)| **reset) {
            (*reward, *terminated, *truncated) = (0.0, false, false);
        }
    }
}

/// [`transition`] of all at once, without a branch but for results that are not finite.
#[inline(always)]
fn advance_lanes<const N: usize>(
    block: &mut Block<f32, N>,
    model: &Model<f32>,
    torques: [f32; N],
) -> [bool; N] {
    let torque = Lanes(torques);
    let [theta1, theta2, dtheta1, dtheta2] = block.state;
    let y = [Lanes(theta1), Lanes(theta2), Lanes(dtheta1), Lanes(dtheta2)];
    let [cos1, sin1, cos2, sin2] = block.cos_sin;
    let sin_cos = [(Lanes(sin1), Lanes(cos1)), (Lanes(sin2), Lanes(cos2))];
    let k1 = model.lean(y, sin_cos, torque);
    let driven = Driven::<Fast, _>::new(model, torque);
    let next = rk4_from(Form::Lean, y, k1, model.dts, &driven);

    // 0 times what is not finite is NaN.
    let zero = Lanes::splat(0.0);
    let [theta1, theta2, dtheta1, dtheta2] = next;
    let zeros = ((theta1 * zero + theta2 * zero) + dtheta1 * zero) + dtheta2 * zero;
    let next = if zeros.0.iter().fold(true, |all, &x| all & (x == 0.0)) {
        next
    } else {
        at_rest(next, zeros, y)
    };

    let [theta1, theta2, dtheta1, dtheta2] = next;
    let (theta1, theta2) = (theta1.wrap(), theta2.wrap());
    let dtheta1 = dtheta1.bound(model.params.max_velocity1);
    let dtheta2 = dtheta2.bound(model.params.max_velocity2);
    let (sin1, cos1) = kernel(theta1);
    let (sin2, cos2) = kernel(theta2);
    block.state = [theta1.0, theta2.0, dtheta1.0, dtheta2.0];
    block.cos_sin = [cos1.0, sin1.0, cos2.0, sin2.0];

    let cos_sum = cos1 * cos2 - sin1 * sin2;
    let height = -cos1 - cos_sum;
    let mut terminated = [false; N];
    for (terminated, height) in terminated.iter_mut().zip(height.0) {
        *terminated = height > 1.0;
    }
    terminated
}

/// Lanes that are not finite keep their angles and stop.
#[cold]
fn at_rest<const N: usize>(
    mut next: [Lanes<N>; 4],
    zeros: Lanes<N>,
    [theta1, theta2, ..]: [Lanes<N>; 4],
) -> [Lanes<N>; 4] {
    let zero = Lanes::splat(0.0);
    for (next, kept) in next.iter_mut().zip([theta1, theta2, zero, zero]) {
        for ((next, kept), zero) in next.0.iter_mut().zip(kept.0).zip(zeros.0) {
            *next = if zero == 0.0 { *next } else { kept };
        }
    }
    next
}

#[inline(always)]
pub(super) fn step_blocks<A: Arithmetic, const N: usize>(
    shared: &Shared<A::Scalar>,
    blocks: &mut [Block<A::Scalar, N>],
    generators: &mut [Pcg64],
    actions: &[impl Copy + Into<u8>],
    mut output: Output<'_>,
) {
    let each = actions
        .chunks(N)
        .zip(generators.chunks_mut(N))
        .zip(output.rewards.chunks_mut(N))
        .zip(output.terminated.chunks_mut(N))
        .zip(output.truncated.chunks_mut(N));
    for ((number, block), ((((actions, generators), rewards), terminated), truncated)) in
        blocks.iter_mut().enumerate().zip(each)
    {
        // What is left of the last block does nothing that is seen.
        let mut given = [1; N];
        match actions.first_chunk::<N>() {
            Some(all) => read(&mut given, all),
            None => read(&mut given, actions),
        }
        let finals = &mut output.final_observations;
        let stepped = block.step::<A>(shared, number, &given, generators, finals);
        write(rewards, &stepped.rewards);
        write(terminated, &stepped.terminated);
        write(truncated, &stepped.truncated);
        block.observe(number, &mut output.observations);
    }
}

/// As many as there are.
#[inline(always)]
fn read<const N: usize>(to: &mut [u8; N], from: &[impl Copy + Into<u8>]) {
    for (to, &from) in to.iter_mut().zip(from) {
        *to = from.into();
    }
}

/// As many as there is room for.
#[inline(always)]
fn write<T: Copy, const N: usize>(to: &mut [T], from: &[T; N]) {
    match to.first_chunk_mut() {
        Some(to) => *to = *from,
        None => to.iter_mut().zip(from).for_each(|(to, &from)| *to = from),
    }
}
