//! Promise 2 for batches: acrobot `i` is bit-identical to an `Acrobot` seeded with the seed's `i`-th child.

use std::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Host, Micro, Real, Reference};
use acrobot::batch::{Autoreset, Batch, Block, Observations, SimdLevel, StepBuffers};
use acrobot::numpy::{Pcg64, SeedSequence, uniform};
use acrobot::physics::{Dynamics, ResetBounds};
use acrobot::{
    Acrobot, Action, Error, Fast, Params, Portable, ResetOptions, State, Step, TimeLimit,
};
use bits::against;

type Vecs<A, const N: usize> = Batch<A, Vec<Block<A, N>>, Vec<Pcg64>, N>;

/// A batch and its scalar twins.
struct Twins<A: Arithmetic, const N: usize = 16> {
    batch: Vecs<A, N>,
    alone: Vec<TimeLimit<Acrobot<A>>>,
    /// Whether the next step resets each of `alone`.
    waiting: Vec<bool>,
}

impl<A: Arithmetic, const N: usize> Twins<A, N> {
    fn new(len: usize, autoreset: Autoreset) -> Self {
        let blocks = vec![Block::EMPTY; len.div_ceil(N)];
        let mut batch = Batch::new(42, blocks, vec![Pcg64::UNSEEDED; len]).unwrap();
        batch.set_autoreset(autoreset);
        Self {
            batch,
            alone: SeedSequence::new(42)
                .spawn(len as u64)
                .map(|seed| TimeLimit::v1(Acrobot::with_rng(seed.into())))
                .collect(),
            waiting: vec![false; len],
        }
    }

    fn set_params(&mut self, params: Params<A::Scalar>) {
        self.batch.set_params(params).unwrap();
        for alone in &mut self.alone {
            alone.set_params(params).unwrap();
        }
    }

    fn set_noise(&mut self, noise: f64) {
        self.set_params(Params {
            torque_noise: A::Scalar::from_f64(noise),
            ..*self.batch.params()
        });
    }

    fn reset_within(&mut self, low: f64, high: f64) {
        let bounds = ResetBounds::new(low, high).unwrap();
        self.batch.set_reset_bounds(bounds);
        self.batch.reset();
        self.reset_alone(|_, alone| {
            alone.reset_with(bounds.into());
        });
    }

    /// Call it after a reset of the batch. It resets each scalar twin by its index, and compares every bit.
    fn reset_alone(&mut self, reset: impl Fn(u64, &mut TimeLimit<Acrobot<A>>)) {
        for (alone, i) in self.alone.iter_mut().zip(0..) {
            reset(i, alone);
        }
        self.waiting.fill(false);
        self.assert_equal();
    }

    /// Steps both with the same actions and compares every bit. Returns which episodes ended.
    fn step(&mut self, actions: &[Action]) -> Vec<bool> {
        self.step_by(
            |batch, buffers| batch.step(actions, buffers),
            |i, alone| alone.step(actions[i]),
        )
    }

    /// [`step`](Self::step) with torques, on one core or on all.
    fn step_torques(&mut self, torques: &[A::Scalar], parallel: bool) -> Vec<bool> {
        self.step_by(
            |batch, buffers| match parallel {
                true => batch.par_step(torques, buffers),
                false => batch.step(torques, buffers),
            },
            |i, alone| alone.step_torque(torques[i]).unwrap(),
        )
    }

    fn step_by(
        &mut self,
        step: impl FnOnce(&mut Vecs<A, N>, StepBuffers<'_>) -> Result<(), Error>,
        step_alone: impl Fn(usize, &mut TimeLimit<Acrobot<A>>) -> Step,
    ) -> Vec<bool> {
        let len = self.alone.len();
        let (mut rewards, mut terminated, mut truncated) =
            (vec![9.0; len], vec![true; len], vec![true; len]);
        let (mut rows, mut finals) = (vec![[9.0; 6]; len], vec![[9.0; 6]; len]);
        let buffers = StepBuffers::new(&mut rewards, &mut terminated, &mut truncated)
            .with_observations(Observations::Rows(&mut rows))
            .with_final_observations(Observations::Rows(&mut finals));
        step(&mut self.batch, buffers).unwrap();
        let (autoreset, bounds) = (self.batch.autoreset(), self.batch.reset_bounds());
        let mut done = vec![false; len];
        for (i, alone) in self.alone.iter_mut().enumerate() {
            let mut last = [9.0; 6];
            let expected = if std::mem::take(&mut self.waiting[i]) {
                (alone.reset_with(bounds.into()), 0.0, false, false)
            } else {
                let step = step_alone(i, alone);
                done[i] = step.done();
                let mut observation = step.observation;
                match autoreset {
                    Autoreset::SameStep if done[i] => {
                        last = observation.to_array();
                        observation = alone.reset_with(bounds.into());
                    }
                    Autoreset::NextStep => self.waiting[i] = done[i],
                    _ => {}
                }
                (observation, step.reward, step.terminated, step.truncated)
            };
            let observation = expected.0.to_array();
            assert_eq!(rows[i].map(f32::to_bits), observation.map(f32::to_bits));
            assert_eq!(finals[i].map(f32::to_bits), last.map(f32::to_bits));
            assert_eq!(
                (rewards[i], terminated[i], truncated[i]),
                (expected.1, expected.2, expected.3)
            );
        }
        self.assert_equal();
        done
    }

    /// Compares every bit of the states, the steps since the last reset, and the generators.
    fn assert_equal(&self) {
        for (i, alone) in self.alone.iter().enumerate() {
            let member = self.batch.member(i).unwrap();
            let inner = alone.inner();
            assert_eq!(bits(member.state), bits(inner.state()), "acrobot {i}");
            assert_eq!(member.elapsed, alone.elapsed(), "acrobot {i}");
            assert_eq!(member.ended, self.waiting[i], "acrobot {i}");
            assert_eq!(member.rng, *inner.rng(), "acrobot {i}");
        }
    }

    /// Torque against θ̇1, which reaches the goal.
    fn swinging(&self) -> Vec<Action> {
        let velocities = self.alone.iter().map(|alone| alone.state().dtheta1);
        velocities.map(against).collect()
    }

    fn swing(&mut self, steps: u32) {
        for _ in 0..steps {
            self.step(&self.swinging());
        }
    }

    fn play_randomly(&mut self, steps: u32) {
        let mut rng = Pcg64::new(7);
        for _ in 0..steps {
            let random = self.alone.iter().map(|_| Action::sample(&mut rng));
            self.step(&random.collect::<Vec<_>>());
        }
    }
}

/// The bits of a state, which distinguish 0 from −0.
fn bits<S: Real>(state: State<S>) -> [u64; 4] {
    <[S; 4]>::from(state).map(|x| x.to_f64().to_bits())
}

const MODES: [Autoreset; 3] = [
    Autoreset::NextStep,
    Autoreset::SameStep,
    Autoreset::Disabled,
];

const LEVELS: [SimdLevel; 3] = [SimdLevel::Baseline, SimdLevel::Avx2, SimdLevel::Avx512];

/// Plays through ends and resets in every mode. `len` is more than one block, and not a whole number of blocks.
fn assert_equals_single_acrobots<A: Arithmetic>(len: usize, steps: u32) {
    for autoreset in MODES {
        let mut twins = Twins::<A>::new(len, autoreset);
        twins.swing(steps);
        twins.play_randomly(steps);
    }
}

#[test]
fn fast_equals_single_acrobots() {
    assert_equals_single_acrobots::<Fast>(35, 1200);
}

#[test]
fn other_arithmetics_equal_single_acrobots() {
    assert_equals_single_acrobots::<Reference>(17, 600);
    assert_equals_single_acrobots::<Portable>(17, 600);
    assert_equals_single_acrobots::<Micro>(17, 600);
    assert_equals_single_acrobots::<Host>(17, 600);
}

/// Tries every width with every SIMD level. A level that the machine does not have acts as the baseline.
#[test]
fn a_thousand_acrobots_equal_single_ones_for_ten_thousand_steps() {
    fn play<const N: usize>() {
        // With optimization the larger numbers take seconds.
        let (len, steps) = match cfg!(debug_assertions) {
            true => (100, 600),
            false => (1000, 10_000),
        };
        for level in LEVELS {
            println!("{N} lanes, {level:?}, available: {}", level.is_available());
            let mut twins = Twins::<Fast, N>::new(len, Autoreset::NextStep);
            twins.batch.set_simd_level(level);
            twins.swing(steps);
        }
    }
    play::<1>();
    play::<4>();
    play::<8>();
    play::<16>();
}

/// Tries every arithmetic with every SIMD level, in widths below, at and above that of a vector. Initial states are far
/// outside the bounds, and there is noise.
#[test]
fn any_width_equals_single_acrobots() {
    fn play<A: Arithmetic, const N: usize>() {
        for level in LEVELS {
            let mut twins = Twins::<A, N>::new(37, Autoreset::SameStep);
            twins.batch.set_simd_level(level);
            twins.swing(200);
            twins.set_noise(0.5);
            twins.reset_within(-100.0, 100.0);
            // After an episode's end the links turn over, which wraps angles.
            twins.batch.set_autoreset(Autoreset::Disabled);
            twins.swing(200);
        }
    }
    play::<Fast, 7>();
    play::<Fast, 32>();
    play::<Micro, 7>();
    play::<Portable, 4>();
    play::<Portable, 16>();
    play::<Reference, 16>();
    play::<Host, 16>();
}

#[test]
fn any_size_equals_single_acrobots() {
    for len in [1, 2, 15, 16, 17, 31, 32, 33, 100] {
        Twins::<Fast>::new(len, Autoreset::SameStep).swing(200);
    }
}

#[test]
fn other_parameters_noise_and_initial_states_equal_single_acrobots() {
    let mut rng = Pcg64::new(11);
    for dynamics in [Dynamics::Book, Dynamics::Nips] {
        for noise in [0.0, 0.5] {
            for (size, dt) in [(0.1, 0.2), (3.2, 0.05), (100.0, 0.2), (1e5, 1.0)] {
                let mut twins = Twins::<Fast>::new(40, Autoreset::NextStep);
                let mut draw = || uniform(&mut rng, 0.5, 2.0) as f32;
                twins.set_params(Params {
                    mass1: draw(),
                    mass2: draw(),
                    length1: draw(),
                    torques: [-draw(), draw() - 1.0, draw()],
                    torque_noise: noise,
                    dt,
                    dynamics,
                    ..Params::default()
                });
                twins.reset_within(-size, size);
                twins.swing(700);
            }
        }
    }
}

/// Steps on all cores equal those on one: with actions, with torques, and with observations in columns.
#[test]
fn threads_change_no_bit() {
    let len = 50_003_usize;
    let blocks = vec![Block::EMPTY; len.div_ceil(Block::<Fast>::LANES)];
    let mut one = Batch::new(3, blocks, vec![Pcg64::UNSEEDED; len]).unwrap();
    one.set_autoreset(Autoreset::SameStep);
    one.set_limit(NonZeroU32::new(7).unwrap());
    let mut many = one.clone();
    let mut rng = Pcg64::new(1);
    type Fasts = Vecs<Fast, 16>;
    let run = |batch: &mut Fasts, step: &dyn Fn(&mut Fasts, StepBuffers) -> Result<(), Error>| {
        let (mut rewards, mut terminated, mut truncated) =
            (vec![9.0; len], vec![true; len], vec![true; len]);
        let mut columns = [(); 6].map(|()| vec![9.0; len]);
        let mut finals = columns.clone();
        let [columns_to, finals_to] = [&mut columns, &mut finals]
            .map(|to| Observations::Columns(to.each_mut().map(|column| &mut column[..])));
        let buffers = StepBuffers::new(&mut rewards, &mut terminated, &mut truncated)
            .with_observations(columns_to)
            .with_final_observations(finals_to);
        step(batch, buffers).unwrap();
        let bits = |xs: Vec<f32>| xs.into_iter().map(f32::to_bits).collect::<Vec<_>>();
        let seen = [columns, finals].map(|columns| columns.map(bits));
        (bits(rewards), terminated, truncated, seen)
    };
    // This exceeds the limit of steps twice, with optimization eight times.
    for _ in 0..if cfg!(debug_assertions) { 16 } else { 60 } {
        let actions: Vec<Action> = (0..len).map(|_| Action::sample(&mut rng)).collect();
        let alone = run(&mut one, &|batch, buffers| batch.step(&actions, buffers));
        let shared = run(&mut many, &|batch, buffers| {
            batch.par_step(&actions, buffers)
        });
        assert!(alone == shared);
        let torques: Vec<f32> = (0..len)
            .map(|_| uniform(&mut rng, -2.0, 2.0) as f32)
            .collect();
        let alone = run(&mut one, &|batch, buffers| batch.step(&torques, buffers));
        let shared = run(&mut many, &|batch, buffers| {
            batch.par_step(&torques, buffers)
        });
        assert!(alone == shared);
    }
    for i in 0..len {
        let [one, many] = [&one, &many].map(|batch| batch.state(i).unwrap());
        assert_eq!(bits(one), bits(many), "acrobot {i}");
    }
}

/// A user's slices can differ in length from one call to the next. Steps on all cores and on one then do the same.
#[test]
fn slices_that_change_their_length_cannot_panic() {
    #[derive(Clone)]
    struct Fickle<T> {
        all: Vec<T>,
        changed: usize,
    }

    impl<T> AsRef<[T]> for Fickle<T> {
        fn as_ref(&self) -> &[T] {
            &self.all
        }
    }

    impl<T> AsMut<[T]> for Fickle<T> {
        fn as_mut(&mut self) -> &mut [T] {
            &mut self.all[..self.changed]
        }
    }

    let len = 5000_usize;
    let all = len.div_ceil(Block::<Portable>::LANES);
    for (blocks, generators) in [(all, 17), (all, 0), (100, len), (0, len), (all, len)] {
        let blocks = Fickle {
            all: vec![Block::EMPTY; all],
            changed: blocks,
        };
        let generators = Fickle {
            all: vec![Pcg64::UNSEEDED; len],
            changed: generators,
        };
        let mut one = Batch::<Portable, _, _>::new(3, blocks, generators).unwrap();
        one.set_limit(NonZeroU32::MIN);
        let mut many = one.clone();
        for _ in 0..2 {
            let step = |batch: &mut Batch<Portable, Fickle<_>, Fickle<_>>, parallel| {
                let (mut rewards, mut terminated, mut truncated) =
                    (vec![9.0; len], vec![true; len], vec![true; len]);
                let mut rows = vec![[9.0; 6]; len];
                let buffers = StepBuffers::new(&mut rewards, &mut terminated, &mut truncated)
                    .with_observations(Observations::Rows(&mut rows));
                let torques = &vec![1.0; len];
                if parallel {
                    batch.par_step(torques, buffers).unwrap();
                } else {
                    batch.step(torques, buffers).unwrap();
                }
                (rewards, terminated, truncated, rows)
            };
            assert!(step(&mut one, false) == step(&mut many, true));
        }
    }
}

/// Here every force is 0 or −0, and beyond 2¹⁹ rad sines can be 0.
#[test]
fn zeros_have_the_same_sign_as_in_single_acrobots() {
    for autoreset in MODES {
        let mut twins = Twins::<Fast>::new(20, autoreset);
        twins.set_params(Params {
            gravity: -0.0,
            torques: [-0.0; 3],
            ..Params::DEFAULT
        });
        let far = [18_800_440.0, -18_800_440.0, 6_597_069_800_000.0, 1e30];
        for (theta1, theta2) in far
            .into_iter()
            .flat_map(|x| [(0.0, x), (x, 0.0), (-0.0, x), (x, x)])
        {
            let state = State {
                theta1,
                theta2,
                dtheta1: -0.0,
                dtheta2: -0.0,
            };
            twins.batch.reset_to(&[state; 20]).unwrap();
            twins.reset_alone(|_, alone| {
                let mut inner = alone.inner().clone();
                inner.set_state(state).unwrap();
                *alone = TimeLimit::v1(inner);
            });
            twins.swing(2);
        }
    }
}

#[test]
fn given_initial_states_equal_single_acrobots() {
    let mut rng = Pcg64::new(3);
    let mut twins = Twins::<Fast>::new(35, Autoreset::NextStep);
    // After 500 steps most have ended and wait for their reset.
    for steps in [500, 3, 8] {
        twins.play_randomly(steps);
        let mut number = || uniform(&mut rng, -10.0, 10.0) as f32;
        let states: Vec<State<f32>> = (0..35)
            .map(|_| State::from([(); 4].map(|()| number())))
            .collect();
        twins.batch.reset_to(&states).unwrap();
        twins.reset_alone(|i, alone| {
            let mut inner = alone.inner().clone();
            inner.set_state(states[i as usize]).unwrap();
            *alone = TimeLimit::v1(inner);
        });
    }
    twins.swing(520);
}

/// Each kind of reset equals that of the same name for every scalar twin. None changes the batch's bounds.
#[test]
fn resets_equal_those_of_single_acrobots() {
    let mut twins = Twins::<Fast>::new(35, Autoreset::NextStep);
    let bounds = ResetBounds::new(1.0, 2.0).unwrap();
    // After 500 steps most acrobots wait for their reset. These resets replace it.
    for steps in [500, 3] {
        twins.play_randomly(steps);
        twins.batch.reset();
        twins.reset_alone(|_, alone| {
            alone.reset();
        });

        twins.play_randomly(steps);
        twins.batch.reset_within(bounds);
        twins.reset_alone(|_, alone| {
            alone.reset_with(bounds.into());
        });

        twins.play_randomly(steps);
        twins.batch.reset_with_seed(7);
        twins.reset_alone(|i, alone| {
            let child = SeedSequence::new(7).child(i);
            *alone = TimeLimit::v1(Acrobot::with_rng(child.into()));
        });

        twins.play_randomly(steps);
        for seed in [Some(SeedSequence::new(8)), None] {
            let options = ResetOptions {
                seed,
                bounds: Some(bounds),
            };
            twins.batch.reset_with(options.clone());
            twins.reset_alone(|i, alone| {
                let seed = options.seed.as_ref().map(|seed| seed.child(i));
                let bounds = options.bounds;
                alone.reset_with(ResetOptions { seed, bounds });
            });
        }
    }
    assert_eq!(twins.batch.reset_bounds(), ResetBounds::DEFAULT);
}

/// Plays through ends in every mode, without and with noise.
#[test]
fn torques_equal_single_acrobots() {
    fn play<A: Arithmetic, const N: usize>(len: usize, steps: u32, parallel: bool) {
        for autoreset in MODES {
            let mut twins = Twins::<A, N>::new(len, autoreset);
            let mut rng = Pcg64::new(7);
            let mut ends = 0;
            for noise in [0.0, 0.5] {
                twins.set_noise(noise);
                twins.reset_within(-2.0, 2.0);
                for _ in 0..steps {
                    let torques = twins.alone.iter().map(|alone| {
                        let size = uniform(&mut rng, 0.0, 3.0);
                        let falling = alone.state().dtheta1 > A::Scalar::ZERO;
                        A::Scalar::from_f64(if falling { -size } else { size })
                    });
                    let torques: Vec<_> = torques.collect();
                    let done = twins.step_torques(&torques, parallel);
                    ends += done.iter().filter(|done| **done).count();
                }
            }
            assert!(ends > len / 10, "{ends} ends in {autoreset:?}");
        }
    }
    play::<Fast, 16>(35, 300, false);
    play::<Micro, 16>(35, 300, false);
    play::<Portable, 16>(35, 300, false);
    play::<Host, 16>(35, 300, false);
    // These are more acrobots than a thread takes at once.
    play::<Portable, 16>(2100, 12, true);
    play::<Fast, 16>(33_000, 4, true);
}

/// With `Autoreset::Disabled`, `reset_masked` equals resets of single acrobots, at ends and after them.
#[test]
fn masked_resets_equal_resets_of_single_acrobots() {
    fn play<A: Arithmetic, const N: usize>() {
        let mut twins = Twins::<A, N>::new(35, Autoreset::Disabled);
        twins.set_noise(0.3);
        twins.reset_within(-1.0, 1.0);
        let bounds = twins.batch.reset_bounds();
        let mut rng = Pcg64::new(7);
        let (mut ends, mut past) = (0, 0);
        let mut before = vec![false; 35];
        for step in 0..700 {
            let done = twins.step(&twins.swinging());
            ends += done.iter().filter(|done| **done).count();
            // Some acrobots step on after their end, and some are reset before it.
            let mask: Vec<bool> = done
                .iter()
                .map(|&done| uniform(&mut rng, 0.0, 1.0) < if done { 0.5 } else { 0.005 })
                .collect();
            past += before.iter().zip(&mask).filter(|(x, y)| **x && **y).count();
            before = done.iter().zip(&mask).map(|(x, y)| *x && !y).collect();
            // Every 50th reset has a seed, and acrobot i takes its i-th child.
            let seed = (step % 50 == 0).then(|| SeedSequence::new(step));
            let options = ResetOptions { seed, bounds: None };
            twins.batch.reset_masked(&mask, options.clone()).unwrap();
            twins.reset_alone(|i, alone| {
                if mask[i as usize] {
                    let seed = options.seed.as_ref().map(|seed| seed.child(i));
                    let bounds = Some(bounds);
                    alone.reset_with(ResetOptions { seed, bounds });
                }
            });
        }
        assert!(
            ends > 100 && past > 10,
            "{ends} ends, {past} resets after a step past the end"
        );
    }
    play::<Fast, 16>();
    play::<Micro, 16>();
    play::<Portable, 16>();
    play::<Host, 16>();
}

/// Waiting acrobots continue when the mode changes to `Disabled`.
#[test]
fn waiting_acrobots_continue_in_mode_disabled_as_single_acrobots() {
    let mut twins = Twins::<Fast>::new(35, Autoreset::NextStep);
    twins.set_noise(0.3);
    for _ in 0..3 {
        while !twins.waiting.contains(&true) {
            twins.swing(1);
        }
        twins.batch.set_autoreset(Autoreset::Disabled);
        twins.waiting.fill(false);
        twins.assert_equal();
        twins.swing(100);
        twins.batch.set_autoreset(Autoreset::NextStep);
        twins.swing(100);
    }
}

/// Setting the state of one acrobot keeps its episode, and changes no other acrobot.
#[test]
fn set_state_equals_that_of_a_single_acrobot() {
    fn check<A: Arithmetic, const N: usize>() {
        let mut twins = Twins::<A, N>::new(35, Autoreset::NextStep);
        twins.set_noise(0.3);
        let mut rng = Pcg64::new(3);
        for index in [Some(0), Some(15), Some(16), Some(34), None] {
            twins.swing(50);
            // The last one waits for its reset, and continues to wait.
            let index = index.unwrap_or_else(|| {
                while !twins.waiting.contains(&true) {
                    twins.swing(1);
                }
                twins.waiting.iter().position(|x| *x).unwrap()
            });
            let numbers = [(); 4].map(|()| A::Scalar::from_f64(uniform(&mut rng, -10.0, 10.0)));
            let state = State::from(numbers);
            twins.batch.set_state(index, state).unwrap();
            twins.alone[index].set_state(state).unwrap();
            twins.assert_equal();
            let mut rows = [[0.0; 6]; 35];
            twins.batch.observe(Observations::Rows(&mut rows)).unwrap();
            let observation = twins.alone[index].inner().observation();
            let [row, alone] = [rows[index], observation.to_array()];
            assert_eq!(row.map(f32::to_bits), alone.map(f32::to_bits));
        }
        twins.swing(100);
    }
    check::<Fast, 16>();
    check::<Micro, 16>();
    check::<Portable, 16>();
    check::<Reference, 16>();
    check::<Host, 16>();
}

/// The members are stored in the middle of episodes or just after their end, with noise.
#[test]
fn members_resume_in_another_batch() {
    let mut twins = Twins::<Fast>::new(35, Autoreset::NextStep);
    twins.set_noise(0.3);
    for steps in [70, 430] {
        twins.swing(steps);
        let members: Vec<_> = (0..35).map(|i| twins.batch.member(i).unwrap()).collect();
        assert!(members.iter().any(|member| member.elapsed > 0));
        let (blocks, generators) = (vec![Block::EMPTY; 3], vec![Pcg64::UNSEEDED; 35]);
        let params = *twins.batch.params();
        twins.batch = Batch::new(7, blocks, generators).unwrap();
        twins.batch.set_params(params).unwrap();
        for (index, member) in members.into_iter().enumerate() {
            twins.batch.set_member(index, member).unwrap();
        }
    }
    twins.play_randomly(600);
}

/// Gymnasium's `SyncVectorEnv` seeds environment `i` with `seed + i`.
#[test]
fn replaced_generators_equal_those_of_single_acrobots() {
    let mut twins = Twins::<Host>::new(19, Autoreset::NextStep);
    for (rng, i) in twins.batch.generators_mut().iter_mut().zip(0..) {
        *rng = Pcg64::new(7 + i);
    }
    twins.batch.reset();
    twins.reset_alone(|i, alone| {
        alone.reset_with_seed(7 + i);
    });
    twins.swing(100);
}
