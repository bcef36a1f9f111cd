//! A batch beside single acrobots.

use acrobot::arithmetic::{Arithmetic, Real};
use acrobot::batch::{Autoreset, Batch, Block, LaneParams, SimdLevel, StepBuffers, VecBatch};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::{Dynamics, ResetBounds};
use acrobot::{Acrobot, Action, Error, Observation, Params, ResetOptions, State, Step, TimeLimit};
use bits::against;

use crate::{bits, params_range};

pub const MODES: [Autoreset; 3] = [Autoreset::NextStep, Autoreset::SameStep, Autoreset::Disabled];

/// A level that the machine does not have acts as the baseline.
pub const LEVELS: [SimdLevel; 3] = [SimdLevel::Baseline, SimdLevel::Avx2, SimdLevel::Avx512];

pub type InVecs<A, const N: usize> =
    Batch<A, (Vec<Block<A, N>>, Vec<Pcg64>, Vec<LaneParams<A, N>>), N>;

/// A batch and its scalar twins.
pub struct Twins<A: Arithmetic, const N: usize = 16> {
    pub batch: VecBatch<A, N>,
    pub alone: Vec<TimeLimit<Acrobot<A>>>,
    /// Whether the next step resets each of `alone`.
    pub pending: Vec<bool>,
}

impl<A: Arithmetic, const N: usize> Twins<A, N> {
    pub fn new(len: usize, autoreset: Autoreset) -> Self {
        Self::of(VecBatch::new(SeedSequence::new(42), len), autoreset)
    }

    pub fn with_own_params(len: usize, autoreset: Autoreset) -> Self {
        let batch = VecBatch::with_own_params(SeedSequence::new(42), len);
        Self::of(batch, autoreset)
    }

    /// Twins of a new batch with the seed 42.
    fn of(batch: Result<VecBatch<A, N>, Error>, autoreset: Autoreset) -> Self {
        let mut batch = batch.unwrap();
        batch.set_autoreset(autoreset);
        let seeds = SeedSequence::new(42).spawn(batch.len() as u64);
        Self {
            alone: seeds
                .map(|seed| TimeLimit::new(Acrobot::with_rng(seed.into()), A::TASK.limit()))
                .collect(),
            pending: vec![false; batch.len()],
            batch,
        }
    }

    pub fn set_params(&mut self, params: Params<A::Scalar>) {
        self.batch.set_params(params).unwrap();
        for alone in &mut self.alone {
            alone.set_params(params).unwrap();
        }
        self.assert_equal();
    }

    pub fn set_params_of_each(&mut self, params: &[Params<A::Scalar>]) {
        for (i, alone) in self.alone.iter_mut().enumerate() {
            self.batch.set_params_of(i, params[i]).unwrap();
            alone.set_params(params[i]).unwrap();
        }
        self.assert_equal();
    }

    pub fn reset(&mut self, options: ResetOptions) {
        self.reset_some(None, options);
    }

    /// Resets all acrobots, or those of a mask.
    pub fn reset_some(&mut self, mask: Option<&[bool]>, options: ResetOptions) {
        let rows = match mask {
            Some(mask) => self.batch.reset_masked(mask, options.clone()).unwrap(),
            None => self.batch.reset_with(options.clone()),
        };
        let rows = rows.to_vec();
        for (i, alone) in self.alone.iter_mut().enumerate() {
            if mask.is_none_or(|mask| mask[i]) {
                let seed = options.seed.as_ref().map(|seed| seed.child(i as u64));
                reset_one(&self.batch, alone, ResetOptions { seed, ..options });
                self.pending[i] = false;
            }
            assert!(equal(&rows[i], &alone.inner().observation()));
        }
        self.assert_equal();
    }

    /// Sets the bounds of initial states, and resets all.
    pub fn set_bounds(&mut self, low: f64, high: f64) {
        let bounds = ResetBounds::new(low, high).unwrap();
        self.batch.set_reset_bounds(bounds);
        self.reset(ResetOptions::default());
    }

    /// Call it when the batch has reset those whose reset was pending.
    pub fn reset_pending(&mut self) {
        for (alone, pending) in self.alone.iter_mut().zip(&mut self.pending) {
            if std::mem::take(pending) {
                reset_one(&self.batch, alone, ResetOptions::default());
            }
        }
        self.assert_equal();
    }

    /// Begins an episode of each in a given state.
    pub fn reset_to(&mut self, states: &[State<A::Scalar>]) {
        self.batch.reset_to(states).unwrap();
        for (alone, state) in self.alone.iter_mut().zip(states) {
            *alone = TimeLimit::new(alone.inner().clone(), alone.limit());
            alone.set_state(*state).unwrap();
        }
        self.pending.fill(false);
        self.assert_equal();
    }

    /// Steps both with the same actions and compares every bit.
    pub fn step(&mut self, actions: &[Action]) {
        self.step_by(
            |batch, buffers| batch.step(actions, buffers),
            |i, alone| alone.step(actions[i]),
        );
    }

    /// [`step`](Self::step) with torques.
    pub fn step_torques(&mut self, torques: &[A::Scalar]) {
        self.step_by(
            |batch, buffers| batch.step(torques, buffers),
            |i, alone| alone.step_torque(torques[i]).unwrap(),
        );
    }

    fn step_by(
        &mut self,
        step: impl FnOnce(&mut InVecs<A, N>, StepBuffers<'_>) -> Result<(), Error>,
        step_alone: impl Fn(usize, &mut TimeLimit<Acrobot<A>>) -> Step,
    ) {
        let len = self.alone.len();
        let (mut rewards, mut terminated, mut truncated) =
            (vec![9.0; len], vec![true; len], vec![true; len]);
        let (mut rows, mut finals) = (vec![[9.0; 6]; len], vec![[9.0; 6]; len]);
        let buffers = StepBuffers::new(&mut rewards, &mut terminated, &mut truncated)
            .with_observations(&mut rows)
            .with_final_observations(&mut finals);
        step(&mut self.batch, buffers).unwrap();
        let autoreset = self.batch.autoreset();
        let reset = |alone: &mut _| reset_one(&self.batch, alone, ResetOptions::default());
        for (i, alone) in self.alone.iter_mut().enumerate() {
            let mut last = [9.0; 6].into();
            let expected = if std::mem::take(&mut self.pending[i]) {
                (reset(alone), 0.0, false, false)
            } else {
                let step = step_alone(i, alone);
                let mut observation = step.observation;
                match autoreset {
                    Autoreset::SameStep if step.done() => {
                        last = observation;
                        observation = reset(alone);
                    }
                    Autoreset::NextStep => self.pending[i] = step.done(),
                    _ => {}
                }
                (observation, step.reward, step.terminated, step.truncated)
            };
            assert!(equal(&rows[i], &expected.0), "acrobot {i}");
            assert!(equal(&finals[i], &last), "acrobot {i}");
            assert_eq!(
                (rewards[i], terminated[i], truncated[i]),
                (expected.1, expected.2, expected.3)
            );
        }
        self.assert_equal();
    }

    /// Compares every bit of the states, the observations, the steps since the last reset, the
    /// generators and the parameters.
    pub fn assert_equal(&self) {
        let mut rows = vec![[9.0; 6]; self.alone.len()];
        self.batch.observe(&mut rows).unwrap();
        for (i, alone) in self.alone.iter().enumerate() {
            let member = self.batch.member(i).unwrap();
            let inner = alone.inner();
            assert!(equal(&rows[i], &inner.observation()), "acrobot {i}");
            assert_eq!(bits(member.state), bits(inner.state()), "acrobot {i}");
            assert_eq!(member.elapsed, alone.elapsed(), "acrobot {i}");
            assert_eq!(self.batch.elapsed(i), Some(member.elapsed));
            assert_eq!(member.reset_pending, self.pending[i], "acrobot {i}");
            assert_eq!(member.rng, *inner.rng(), "acrobot {i}");
            assert_eq!(member.params, *inner.params(), "acrobot {i}");
            assert_eq!(self.batch.params_of(i), Some(member.params));
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
        let range = params_range::<A>(Dynamics::Book);
        for level in LEVELS {
            let mut shared = Self::new(37, Autoreset::SameStep);
            let mut drawn = Self::with_own_params(37, Autoreset::NextStep);
            drawn.batch.set_params_range(Some(range)).unwrap();
            for twins in [&mut shared, &mut drawn] {
                twins.batch.set_simd_level(level);
                twins.swing(200);
            }
            shared.set_params(Params {
                torque_noise: Real::from_f64(0.5),
                ..shared.batch.params_of(0).unwrap()
            });
            for twins in [&mut shared, &mut drawn] {
                twins.set_bounds(-100.0, 100.0);
                // After an episode's end the links turn over, which wraps angles.
                twins.batch.set_autoreset(Autoreset::Disabled);
                twins.swing(200);
            }
        }
    }
}

/// What a reset of a batch does to one acrobot. Its seed is the acrobot's own.
fn reset_one<A: Arithmetic, const N: usize>(
    batch: &VecBatch<A, N>,
    alone: &mut TimeLimit<Acrobot<A>>,
    ResetOptions { mut seed, bounds }: ResetOptions,
) -> Observation {
    if let Some(range) = batch.params_range() {
        let rng = alone.inner_mut().rng_mut();
        if let Some(seed) = seed.take() {
            *rng = seed.into();
        }
        let params = range.draw(rng);
        alone.set_params(params).unwrap();
    }
    let bounds = Some(bounds.unwrap_or(batch.reset_bounds()));
    alone.reset_with(ResetOptions { seed, bounds })
}

/// Whether a row has the bits of an observation.
fn equal(row: &[f32; 6], observation: &Observation) -> bool {
    row.map(f32::to_bits) == observation.to_array().map(f32::to_bits)
}
