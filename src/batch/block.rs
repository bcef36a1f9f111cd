//! `N` acrobots side by side, and their step.

use super::buffers::{StepBuffers, set, take_mut};
use super::inputs::Inputs;
use super::lane_params::{LaneParams, Own};
use super::settings::{Autoreset, Settings};
use crate::arithmetic::{Arithmetic, Fast};
use crate::math::{Lanes, SinCos, Zeros};
use crate::numpy::Pcg64;
use crate::physics::State;
use crate::task::{Memory, Observation, Pose, ResetBounds, Task, episode};

/// The states of `N` acrobots that are stepped side by side. A [`Batch`](super::Batch) has several.
///
/// `N` = 16 suits a machine with SIMD. For a few acrobots, a smaller `N` wastes less memory: in
/// `Fast` a block has 640 bytes with 16, and 64 bytes with 1.
///
/// ```
/// use acrobot::{Fast, batch::Block};
///
/// let three: [Block<Fast, 1>; 3] = [Block::EMPTY; 3]; // for 3 acrobots
/// assert_eq!(size_of_val(&three), 192); // bytes
/// assert_eq!(size_of::<Block>(), 640); // for up to 16
/// ```
///
/// `M` is what the [task remembers](Task::Memory): a number takes 4 bytes an acrobot.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Block<A: Arithmetic = Fast, const N: usize = 16, M: Memory = ()> {
    /// θ1, θ2, θ̇1 and θ̇2.
    pub(super) y: [Lanes<A::Scalar, N>; 4],
    /// Sines and cosines of θ1 and θ2, for the observation and the next step.
    pub(super) sin_cos: [SinCos<Lanes<A::Scalar, N>>; 2],
    elapsed_steps: [u32; N],
    /// Whether the lane's episode has ended and it waits for a reset.
    done: [bool; N],
    /// What the task remembers.
    memory: M::Of<Lanes<A::Scalar, N>>,
}

impl<A: Arithmetic, const N: usize, M: Memory> Block<A, N, M> {
    /// A block to create a batch with, which resets it.
    pub const EMPTY: Self = Self {
        y: Zeros::ZEROS,
        sin_cos: Zeros::ZEROS,
        elapsed_steps: [0; N],
        done: [false; N],
        memory: Zeros::ZEROS,
    };
}

// Lanes are accessed by iterators or `get`, so no compiler has to prove that an index cannot panic.
impl<A: Arithmetic, const N: usize, M: Memory> Block<A, N, M> {
    /// The state of a lane below `N`.
    pub(super) fn state(&self, lane: usize) -> State<A::Scalar> {
        let number = |numbers: &Lanes<_, N>| numbers.0.get(lane).copied().unwrap_or_default();
        self.y.each_ref().map(number).into()
    }

    /// Sets the state of a lane. Its episode continues.
    pub(super) fn set_state(&mut self, lane: usize, state: State<A::Scalar>) {
        self.set_pose(lane, &Pose::of::<A>(state));
    }

    fn set_pose(&mut self, lane: usize, pose: &Pose<A::Scalar>) {
        for (numbers, number) in self.y.iter_mut().zip(<[A::Scalar; 4]>::from(pose.state)) {
            set(&mut numbers.0, lane, number);
        }
        for ((sines, cosines), (sin, cos)) in self.sin_cos.iter_mut().zip(pose.sin_cos) {
            set(&mut sines.0, lane, sin);
            set(&mut cosines.0, lane, cos);
        }
    }

    /// The number of steps of a lane's episode, and whether that has ended, for a lane below `N`.
    pub(super) fn progress(&self, lane: usize) -> (u32, bool) {
        let (elapsed_steps, done) = (self.elapsed_steps.get(lane), self.done.get(lane));
        (elapsed_steps.copied().unwrap_or_default(), done.copied().unwrap_or_default())
    }

    pub(super) fn set_progress(&mut self, lane: usize, elapsed_steps: u32, is_done: bool) {
        set(&mut self.elapsed_steps, lane, elapsed_steps);
        set(&mut self.done, lane, is_done);
    }

    /// What the task remembers of a lane below `N`.
    pub(super) fn memory(&self, lane: usize) -> M::Of<A::Scalar> {
        let mut memory = Zeros::ZEROS;
        M::zip(&self.memory, &mut memory, &mut |Lanes(numbers): Lanes<A::Scalar, N>, to| {
            *to = numbers.get(lane).copied().unwrap_or_default();
        });
        memory
    }

    pub(super) fn set_memory(&mut self, lane: usize, memory: &M::Of<A::Scalar>) {
        M::zip(memory, &mut self.memory, &mut |number, to: &mut Lanes<A::Scalar, N>| {
            set(&mut to.0, lane, number);
        });
    }

    /// Sets the state of a lane, where the task begins what it remembers. The episode continues.
    pub(super) fn begin<T: Task<Memory = M>>(
        &mut self,
        lane: usize,
        task: &T,
        state: State<A::Scalar>,
        rng: Option<&mut Pcg64>,
    ) {
        let pose = Pose::of::<A>(state);
        self.set_pose(lane, &pose);
        let mut memory = self.memory(lane);
        task.begin::<A, _>(&mut memory, &pose, rng);
        self.set_memory(lane, &memory);
    }

    /// Resets the lanes in `mask`, each with its generator, from which it draws own
    /// parameters after the state. A lane without one has no acrobot and hangs at rest.
    #[cold]
    pub(super) fn reset<T: Task<Memory = M>>(
        &mut self,
        mask: &[bool; N],
        settings: &Settings<A, T>,
        bounds: ResetBounds,
        generators: &mut [Pcg64],
        mut own: Option<Own<'_, A, N>>,
    ) {
        let mut generators = generators.iter_mut();
        for (lane, resets) in mask.iter().enumerate() {
            let mut rng = generators.next();
            if *resets {
                let draw = |rng| settings.task.draw(bounds, rng).cast();
                let state = rng.as_deref_mut().map_or(State::HANGING, draw);
                self.begin(lane, &settings.task, state, rng.as_deref_mut());
                self.set_progress(lane, 0, false);
                if let (Some(rng), Some((params, draws))) = (rng, &mut own) {
                    params.set(lane, draws.draw(&params.get(lane), rng));
                }
            }
        }
    }

    /// With `SameStep` no lane waits: resets those whose episode has ended.
    pub(super) fn reset_done<T: Task<Memory = M>>(
        &mut self,
        settings: &Settings<A, T>,
        generators: &mut [Pcg64],
        own: Option<Own<'_, A, N>>,
    ) {
        if settings.autoreset == Autoreset::SameStep {
            let done = self.done;
            self.reset(&done, settings, settings.bounds, generators, own);
        }
    }

    /// The observations of all lanes.
    #[inline(always)]
    fn numbers<T: Task<Memory = M>>(&self, task: &T) -> Numbered<A, T, N> {
        let pose = Pose::new(self.y.into(), self.sin_cos);
        task.observe::<A, Lanes<_, N>>(&pose.with(&self.memory))
    }

    /// The observations of a task that remembers nothing, one after another: with AVX2 a step takes
    /// 5 % longer if they are computed by lanes.
    #[inline(always)]
    fn rows<T: Task>(&self, task: &T) -> impl Iterator<Item = T::Observation> {
        let [(sin1, cos1), (sin2, cos2)] = &self.sin_cos;
        let [theta1, theta2, dtheta1, dtheta2] = &self.y;
        let sines = (sin1.0.iter().zip(&cos1.0)).zip(sin2.0.iter().zip(&cos2.0));
        let states = (theta1.0.iter().zip(&theta2.0)).zip(dtheta1.0.iter().zip(&dtheta2.0));
        sines.zip(states).map(|(((sin1, cos1), (sin2, cos2)), (angles, velocities))| {
            let ((theta1, theta2), (dtheta1, dtheta2)) = (angles, velocities);
            let state = [*theta1, *theta2, *dtheta1, *dtheta2].into();
            let pose = Pose::new(state, [(*sin1, *cos1), (*sin2, *cos2)]);
            let mut row = T::Observation::ZEROS;
            let numbers = task.observe::<A, A::Scalar>(&pose.with(&Zeros::ZEROS));
            row.write::<_, A::Scalar>(&numbers, 0);
            row
        })
    }

    /// Writes the observations, and removes the written elements from `to`.
    #[inline(always)]
    pub(super) fn observe<T: Task<Memory = M>>(&self, task: &T, to: &mut &mut [T::Observation]) {
        let to = take_mut(to, N);
        if const { M::LEN == 0 } {
            to.iter_mut().zip(self.rows(task)).for_each(|(to, row)| *to = row);
            return;
        }
        let numbers = self.numbers(task);
        match <&mut [T::Observation; N]>::try_from(&mut *to) {
            Ok(rows) => write_rows::<A, T, N>(rows, &numbers),
            Err(_) => self.observe_masked(task, &[true; N], to),
        }
    }

    /// Writes the observations of some lanes. Out of line, also for the last block: a constant
    /// number of rows takes less time.
    #[cold]
    #[inline(never)]
    fn observe_masked<T: Task<Memory = M>>(
        &self,
        task: &T,
        mask: &[bool; N],
        to: &mut [T::Observation],
    ) {
        let numbers = self.numbers(task);
        for ((lane, to), mask) in to.iter_mut().enumerate().zip(mask) {
            if *mask {
                to.write::<_, Lanes<A::Scalar, N>>(&numbers, lane);
            }
        }
    }

    /// One step of all lanes, without resets.
    #[inline(always)]
    pub(super) fn advance<T: Task<Memory = M>>(
        &mut self,
        settings: &Settings<A, T>,
        LaneParams { model }: &LaneParams<A, N>,
        inputs: Inputs<'_, A::Scalar>,
        generators: &mut [Pcg64],
    ) -> Results<N> {
        let (task, memory) = (&settings.task, &mut self.memory);
        let torques = inputs.torques(&model.params.torques);
        let torques = task.act::<A, Lanes<_, N>>(memory, &model.params, torques);
        let resets = settings.autoreset == Autoreset::NextStep;
        let generators = generators.iter_mut().zip(&self.done);
        let generators = generators.map(|(rng, done)| (!(resets & done)).then_some(rng));
        let torques = episode::disturb(torques, model.params.torque_noise, generators);
        let (y, sin_cos) = (&mut self.y, &mut self.sin_cos);
        let (Lanes(rewards), terminated) =
            episode::step::<A, T, Lanes<_, N>>(model, y, sin_cos, torques, task, memory);
        let (mut truncated, mut done) = ([false; N], [false; N]);
        let results = truncated.iter_mut().zip(&mut done);
        for ((elapsed_steps, terminated), (truncated, done)) in
            self.elapsed_steps.iter_mut().zip(&terminated).zip(results)
        {
            *truncated = episode::count(elapsed_steps, settings.max_steps);
            *done = *terminated | *truncated;
        }
        let resets = match settings.autoreset {
            Autoreset::NextStep => core::mem::replace(&mut self.done, done),
            Autoreset::SameStep => done,
            Autoreset::Disabled => {
                self.done.iter_mut().zip(done).for_each(|(waits, done)| *waits |= done);
                [false; N]
            }
        };
        Results { rewards, terminated, truncated, resets }
    }

    /// Resets lanes whose episodes ended, writes the results, and removes the written elements from
    /// `buffers`.
    #[inline(always)]
    pub(super) fn finish<T: Task<Memory = M>>(
        &mut self,
        settings: &Settings<A, T>,
        mut results: Results<N>,
        generators: &mut [Pcg64],
        own: Option<Own<'_, A, N>>,
        buffers: &mut StepBuffers<'_, T::Observation>,
    ) {
        let finals = buffers.final_observations.as_mut();
        let finals = finals.map(|rows| take_mut(rows, N));
        if results.resets.iter().fold(false, |any, &reset| any | reset) {
            if settings.autoreset == Autoreset::NextStep {
                results.clear();
            } else if let Some(finals) = finals {
                self.observe_masked(&settings.task, &results.resets, finals);
            }
            let (mask, bounds) = (&results.resets, settings.bounds);
            self.reset(mask, settings, bounds, generators, own);
        }
        write(&mut buffers.rewards, &results.rewards);
        write(&mut buffers.terminated, &results.terminated);
        write(&mut buffers.truncated, &results.truncated);
        if let Some(rows) = &mut buffers.observations {
            self.observe(&settings.task, rows);
        }
    }
}

/// The observations of `N` lanes.
type Numbered<A, T, const N: usize> =
    <<T as Task>::Observation as Observation>::Of<Lanes<<A as Arithmetic>::Scalar, N>>;

#[inline(always)]
fn write_rows<A: Arithmetic, T: Task, const N: usize>(
    rows: &mut [T::Observation],
    numbers: &Numbered<A, T, N>,
) {
    for (lane, row) in rows.iter_mut().enumerate().take(N) {
        row.write::<_, Lanes<A::Scalar, N>>(numbers, lane);
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
