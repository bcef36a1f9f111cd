//! A batch beside single acrobots.

use acrobot::arithmetic::{Arithmetic, Real};
use acrobot::batch::{Autoreset, Member, SimdLevel, StepResults, VecBatch};
use acrobot::numpy::SeedSequence;
use acrobot::task::{Gymnasium, ResetBounds, Task};
use acrobot::{Acrobot, Action, Params, ResetOptions, State, Step, TimeLimit};
use bits::against;

use crate::{bits, draws};

pub const MODES: [Autoreset; 3] = [Autoreset::NextStep, Autoreset::SameStep, Autoreset::Disabled];

/// A level that the machine does not have acts as the baseline.
pub const LEVELS: [SimdLevel; 3] = [SimdLevel::Baseline, SimdLevel::Avx2, SimdLevel::Avx512];

pub struct Twins<A: Arithmetic, const N: usize = 16, T: Task = Gymnasium> {
    pub batch: VecBatch<A, T, N>,
    pub alone: Vec<TimeLimit<Acrobot<A, T>>>,
    /// Whether the episode of each of `alone` has ended and it waits for a reset.
    pub done: Vec<bool>,
}

impl<A: Arithmetic, const N: usize, T: Task> Twins<A, N, T> {
    pub fn new(len: usize, own_params: bool, autoreset: Autoreset) -> Self {
        let seed = SeedSequence::new(42);
        let mut batch = VecBatch::new(seed.clone(), len).unwrap();
        if own_params {
            batch.own_params().unwrap();
        }
        batch.set_autoreset(autoreset);
        let alone = |i| TimeLimit::new(Acrobot::new(seed.child(i)), T::MAX_STEPS);
        Self { batch, alone: (0..len as u64).map(alone).collect(), done: vec![false; len] }
    }

    pub fn set_params(&mut self, params: Params<A::Scalar>) {
        self.batch.set_all_params(params).unwrap();
        for alone in &mut self.alone {
            alone.inner_mut().set_params(params).unwrap();
        }
        self.assert_equal();
    }

    /// Resets all acrobots, or those of a mask.
    pub fn reset(&mut self, mask: Option<&[bool]>, options: ResetOptions) {
        match mask {
            Some(mask) => self.batch.reset_masked(mask, options.clone()).unwrap(),
            None => self.batch.reset_with(options.clone()),
        }
        let rows = self.batch.observations().to_vec();
        for (i, alone) in self.alone.iter_mut().enumerate() {
            if mask.is_none_or(|mask| mask[i]) {
                let seed = options.seed.as_ref().map(|seed| seed.child(i as u64));
                reset_one(&self.batch, alone, ResetOptions { seed, ..options });
                self.done[i] = false;
            }
            assert!(equal(&rows[i], &alone.observation()));
        }
        self.assert_equal();
    }

    /// Call it when the batch has reset those whose episode had ended.
    pub fn reset_done(&mut self) {
        for (alone, done) in self.alone.iter_mut().zip(&mut self.done) {
            if std::mem::take(done) {
                reset_one(&self.batch, alone, ResetOptions::default());
            }
        }
        self.assert_equal();
    }

    /// Begins an episode of each in a given state.
    pub fn reset_to(&mut self, states: &[State<A::Scalar>]) {
        self.batch.reset_to(states).unwrap();
        for (alone, state) in self.alone.iter_mut().zip(states) {
            *alone = TimeLimit::new(alone.inner().clone(), alone.max_steps());
            alone.inner_mut().set_state(*state).unwrap();
        }
        self.done.fill(false);
        self.assert_equal();
    }

    /// Steps both with the same actions and compares every bit.
    pub fn step(&mut self, actions: &[Action]) {
        let results = self.batch.step(actions).unwrap().clone();
        self.step_alone(&results, |i, alone| alone.step(actions[i]));
    }

    /// [`step`](Self::step) with torques.
    pub fn step_torques(&mut self, torques: &[A::Scalar]) {
        let results = self.batch.step(torques).unwrap().clone();
        self.step_alone(&results, |i, alone| alone.step_torque(torques[i]).unwrap());
    }

    fn step_alone(
        &mut self,
        results: &StepResults<T::Observation>,
        step: impl Fn(usize, &mut TimeLimit<Acrobot<A, T>>) -> Step<T::Observation>,
    ) {
        let autoreset = self.batch.autoreset();
        let reset = |alone: &mut _| reset_one(&self.batch, alone, ResetOptions::default());
        for (i, alone) in self.alone.iter_mut().enumerate() {
            let (observation, reward, terminated, truncated);
            let waits = std::mem::take(&mut self.done[i]);
            if waits && autoreset == Autoreset::NextStep {
                (observation, reward, terminated, truncated) = (reset(alone), 0.0, false, false);
            } else {
                let step = step(i, alone);
                (reward, terminated, truncated) = (step.reward, step.terminated, step.truncated);
                self.done[i] = (waits || step.is_done()) && autoreset != Autoreset::SameStep;
                if step.is_done() && autoreset == Autoreset::SameStep {
                    let last = &results.final_observations[i];
                    assert!(equal(last, &step.observation), "acrobot {i}");
                    observation = reset(alone);
                } else {
                    observation = step.observation;
                }
            }
            assert!(equal(&results.observations[i], &observation), "acrobot {i}");
            assert_eq!(
                (results.rewards[i], results.terminated[i], results.truncated[i]),
                (reward, terminated, truncated)
            );
        }
        self.assert_equal();
    }

    /// Compares every bit of the states, the observations, the steps since the last reset, the
    /// generators and the parameters.
    pub fn assert_equal(&self) {
        let other = self.alone[0].inner().clone().step(Action::Zero).observation;
        let mut rows = vec![other; self.alone.len()];
        self.batch.observe(&mut rows).unwrap();
        for (i, alone) in self.alone.iter().enumerate() {
            let batch = &self.batch;
            let inner = alone.inner();
            let expected = Member {
                params: *inner.params(),
                state: inner.state(),
                elapsed_steps: alone.elapsed_steps(),
                is_done: self.done[i],
                rng: inner.rng().clone(),
                memory: *inner.memory(),
            };
            let member = batch.member(i).unwrap();
            assert_eq!(member, expected, "acrobot {i}");
            assert_eq!(bits(member.state), bits(expected.state), "acrobot {i}");
            assert!(equal(&rows[i], &inner.observation()), "acrobot {i}");
            assert_eq!(batch.elapsed_steps(i), Ok(member.elapsed_steps));
            assert_eq!(batch.is_done(i), Ok(member.is_done));
            assert_eq!(batch.params(i), Ok(member.params));
        }
    }

    /// Steps with torque against θ̇1, which reaches the goal.
    pub fn swing(&mut self, steps: u32) {
        for _ in 0..steps {
            let velocities = self.alone.iter().map(|alone| alone.state().dtheta1);
            self.step(&velocities.map(against).collect::<Vec<_>>());
        }
    }

    /// Plays with every SIMD level, with shared parameters and with drawn ones. Initial states are
    /// far outside of the bounds, and there is noise.
    pub fn at_every_level() {
        for level in LEVELS {
            let mut shared = Self::new(37, false, Autoreset::SameStep);
            let mut drawn = Self::new(37, true, Autoreset::NextStep);
            drawn.batch.set_draws(draws::<A>()).unwrap();
            for twins in [&mut shared, &mut drawn] {
                twins.batch.set_simd_level(level);
                twins.swing(150);
            }
            shared.set_params(Params {
                torque_noise: Real::from_f64(0.5),
                ..shared.batch.params(0).unwrap()
            });
            for twins in [&mut shared, &mut drawn] {
                twins.batch.set_reset_bounds(ResetBounds::new(-100.0, 100.0).unwrap());
                twins.reset(None, ResetOptions::default());
                // After an episode's end the links turn over, which wraps angles.
                twins.batch.set_autoreset(Autoreset::Disabled);
                twins.swing(100);
            }
        }
    }
}

impl<A: Arithmetic<Scalar = f32>> Twins<A> {
    /// Lanes have the sines of one number at any angle, also where they overflow.
    pub fn at_any_angle() {
        const STRIDE: usize = if cfg!(debug_assertions) { 16_384 } else { 256 };

        let mut twins = Self::new(1024, false, Autoreset::Disabled);
        // At rest and without a torque a step changes the angles little.
        for first in (0..f32::INFINITY.to_bits()).step_by(1024 * STRIDE) {
            for sign in [1.0, -1.0] {
                let angle = |i| sign * f32::from_bits(first + i);
                let states = (0..1024).map(|i| State::from([angle(i), angle(1023 - i), 0.0, 0.0]));
                twins.reset_to(&states.collect::<Vec<_>>());
                twins.step(&[Action::Zero; 1024]);
            }
        }
    }
}

/// What a reset of a batch does to one acrobot. Its seed is the acrobot's own.
fn reset_one<A: Arithmetic, T: Task, const N: usize>(
    batch: &VecBatch<A, T, N>,
    alone: &mut TimeLimit<Acrobot<A, T>>,
    ResetOptions { seed, bounds }: ResetOptions,
) -> T::Observation {
    let bounds = Some(bounds.unwrap_or(batch.reset_bounds()));
    let seen = alone.reset_with(ResetOptions { seed, bounds });
    alone.inner_mut().draw_params(batch.draws()).unwrap();
    seen
}

fn equal<O: AsRef<[f32]>>(x: &O, y: &O) -> bool {
    let [x, y] = [x, y].map(|numbers| numbers.as_ref().iter().map(|x| x.to_bits()));
    x.eq(y)
}
