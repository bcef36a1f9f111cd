//! Promise 2 for batches: acrobot i of a batch is one alone with the i-th child of the seed, to the bit.

use std::num::NonZeroU32;

use acrobot::{
    Acrobot, Action, Arithmetic, Autoreset, Batch, Block, Dynamics, Error, Fast, Host, Micro,
    Observations, Output, Params, Pcg64, Portable, Real, SeedSequence, StartBounds, State,
    TimeLimit, Vectors,
};

type Blocks<A, const N: usize> = Vec<Block<<A as Arithmetic>::Scalar, N>>;

/// A batch and its scalar twins, and the memory for what a step returns.
struct Twins<A: Arithmetic, const N: usize = 16> {
    batch: Batch<A, Blocks<A, N>, Vec<Pcg64>, N>,
    alone: Vec<TimeLimit<Acrobot<A>>>,
    /// Whether each of `alone` is reset by the next step.
    ended: Vec<bool>,
    autoreset: Autoreset,
    bounds: StartBounds,
}

impl<A: Arithmetic, const N: usize> Twins<A, N> {
    fn new(len: usize, autoreset: Autoreset) -> Self {
        Self::with_vectors(len, autoreset, Vectors::widest())
    }

    fn with_vectors(len: usize, autoreset: Autoreset, vectors: Vectors) -> Self {
        let blocks = vec![Block::EMPTY; len.div_ceil(N)];
        let mut batch = Batch::new(42, blocks, vec![Pcg64::UNSEEDED; len]).unwrap();
        batch.set_autoreset(autoreset);
        batch.set_vectors(vectors);
        Self {
            batch,
            alone: SeedSequence::from(42)
                .spawn(len as u64)
                .map(|seed| TimeLimit::v1(Acrobot::new(seed)))
                .collect(),
            ended: vec![false; len],
            autoreset,
            bounds: StartBounds::DEFAULT,
        }
    }

    fn set_params(&mut self, params: Params<A::Scalar>) {
        self.batch.set_params(params).unwrap();
        for alone in &mut self.alone {
            alone.inner_mut().set_params(params).unwrap();
        }
    }

    fn start_within(&mut self, low: f64, high: f64) {
        self.bounds = StartBounds::new(low, high).unwrap();
        self.batch.set_start_bounds(self.bounds);
        self.batch.reset();
        for alone in &mut self.alone {
            alone.reset_within(self.bounds);
        }
    }

    /// Steps both with the same actions, and compares every bit.
    fn step(&mut self, actions: &[Action]) {
        let len = self.alone.len();
        let (mut rewards, mut terminated, mut truncated) =
            (vec![9.0; len], vec![true; len], vec![true; len]);
        let (mut rows, mut finals) = (vec![[9.0; 6]; len], vec![[9.0; 6]; len]);
        let output = Output {
            rewards: &mut rewards,
            terminated: &mut terminated,
            truncated: &mut truncated,
            observations: Observations::Rows(&mut rows),
            final_observations: Observations::Rows(&mut finals),
        };
        self.batch.step(actions, output).unwrap();
        for (i, alone) in self.alone.iter_mut().enumerate() {
            let mut last = [9.0; 6];
            let expected = if std::mem::take(&mut self.ended[i]) {
                (alone.reset_within(self.bounds), 0.0, false, false)
            } else {
                let step = alone.step(actions[i]);
                let observation = match (step.ended(), self.autoreset) {
                    (true, Autoreset::SameStep) => {
                        last = *step.observation;
                        alone.reset_within(self.bounds)
                    }
                    (ended, _) => {
                        self.ended[i] = ended;
                        step.observation
                    }
                };
                (observation, step.reward, step.terminated, step.truncated)
            };
            let bits = |state: State<A::Scalar>| {
                <[A::Scalar; 4]>::from(state).map(|x| x.to_f64().to_bits())
            };
            assert_eq!(
                bits(self.batch.state(i).unwrap()),
                bits(alone.inner().state()),
                "acrobot {i}"
            );
            assert_eq!(rows[i].map(f32::to_bits), expected.0.map(f32::to_bits));
            assert_eq!(finals[i].map(f32::to_bits), last.map(f32::to_bits));
            assert_eq!(
                (rewards[i], terminated[i], truncated[i]),
                (expected.1, expected.2, expected.3)
            );
        }
    }

    /// Random actions, or where `swinging` torque against θ̇1, which reaches the goal.
    fn play(&mut self, steps: u32, swinging: bool) {
        let mut rng = Pcg64::new(7);
        for _ in 0..steps {
            let actions: Vec<Action> = self
                .alone
                .iter()
                .map(|alone| {
                    let random = Action::sample(&mut rng);
                    match alone.inner().state().dtheta1 > A::Scalar::ZERO {
                        _ if !swinging => random,
                        true => Action::Negative,
                        false => Action::Positive,
                    }
                })
                .collect();
            self.step(&actions);
        }
    }
}

/// More than a block, and not a whole number of them; through ends and resets of either kind.
fn plays_as_one_alone<A: Arithmetic>(len: usize, steps: u32) {
    for autoreset in [Autoreset::NextStep, Autoreset::SameStep] {
        let mut twins = Twins::<A>::new(len, autoreset);
        twins.play(steps, true);
        twins.play(steps, false);
    }
}

#[test]
fn fast_plays_as_one_alone() {
    plays_as_one_alone::<Fast>(35, 1200);
}

#[test]
fn other_arithmetics_play_as_one_alone() {
    plays_as_one_alone::<Portable>(17, 600);
    plays_as_one_alone::<Micro>(17, 600);
    plays_as_one_alone::<Host>(17, 600);
}

/// In every width, with every kind of vectors that the machine has; the others are as the baseline.
#[test]
fn a_thousand_play_ten_thousand_steps_as_one_alone() {
    fn play<const N: usize>() {
        // Optimized they take seconds.
        let (len, steps) = match cfg!(debug_assertions) {
            true => (100, 600),
            false => (1000, 10_000),
        };
        for vectors in [Vectors::Baseline, Vectors::Avx2, Vectors::Avx512] {
            println!("{N} by {vectors:?}, available: {}", vectors.is_available());
            Twins::<Fast, N>::with_vectors(len, Autoreset::NextStep, vectors).play(steps, true);
        }
    }
    play::<1>();
    play::<4>();
    play::<8>();
    play::<16>();
}

/// Also a width that is no whole number of any vectors, and one beyond them.
#[test]
fn any_width_plays_as_one_alone() {
    Twins::<Fast, 7>::new(100, Autoreset::SameStep).play(600, true);
    Twins::<Fast, 32>::new(100, Autoreset::SameStep).play(600, true);
    Twins::<Portable, 4>::new(9, Autoreset::SameStep).play(600, true);
}

#[test]
fn any_size_plays_as_one_alone() {
    for len in [1, 2, 15, 16, 17, 31, 32, 33, 100] {
        Twins::<Fast>::new(len, Autoreset::SameStep).play(200, true);
    }
}

#[test]
fn other_parameters_noise_and_starts_play_as_one_alone() {
    let mut rng = Pcg64::new(11);
    for dynamics in [Dynamics::Book, Dynamics::Nips] {
        for noise in [0.0, 0.5] {
            for (size, dt) in [(0.1, 0.2), (3.2, 0.05), (100.0, 0.2), (1e5, 1.0)] {
                let mut twins = Twins::<Fast>::new(40, Autoreset::NextStep);
                let mut draw = || acrobot::uniform(&mut rng, 0.5, 2.0) as f32;
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
                twins.start_within(-size, size);
                twins.play(700, true);
            }
        }
    }
}

/// As many threads as there are, and columns.
#[test]
fn threads_change_no_bit() {
    let len = 50_003_usize;
    let blocks = vec![Block::EMPTY; len.div_ceil(Block::<f32>::LANES)];
    let mut one = Batch::new(3, blocks, vec![Pcg64::UNSEEDED; len]).unwrap();
    one.set_autoreset(Autoreset::SameStep);
    one.set_limit(NonZeroU32::new(7).unwrap());
    let mut many = one.clone();
    let mut rng = Pcg64::new(1);
    type Fasts = Batch<Fast, Blocks<Fast, 16>, Vec<Pcg64>>;
    type Step = fn(&mut Fasts, &[Action], Output<'_>) -> Result<(), Error>;
    let run = |batch: &mut Fasts, actions: &[Action], step: Step| {
        let (mut rewards, mut terminated, mut truncated) =
            (vec![9.0; len], vec![true; len], vec![true; len]);
        let mut columns = [(); 6].map(|()| vec![9.0; len]);
        let mut finals = columns.clone();
        let output = Output {
            rewards: &mut rewards,
            terminated: &mut terminated,
            truncated: &mut truncated,
            observations: Observations::Columns(columns.each_mut().map(|column| &mut column[..])),
            final_observations: Observations::Columns(
                finals.each_mut().map(|column| &mut column[..]),
            ),
        };
        step(batch, actions, output).unwrap();
        (rewards, terminated, truncated, columns, finals)
    };
    // Past two limits; optimized, past eight.
    for _ in 0..if cfg!(debug_assertions) { 16 } else { 60 } {
        let actions: Vec<Action> = (0..len).map(|_| Action::sample(&mut rng)).collect();
        let alone = run(&mut one, &actions, |batch, actions, output| {
            batch.step(actions, output)
        });
        let shared = run(&mut many, &actions, |batch, actions, output| {
            batch.par_step(actions, output)
        });
        assert!(alone == shared);
    }
    assert!((0..len).all(|i| one.state(i) == many.state(i)));
}

#[test]
fn begins_in_given_states_as_one_alone() {
    let mut rng = Pcg64::new(3);
    let mut twins = Twins::<Fast>::new(35, Autoreset::NextStep);
    // After 500 steps all have ended, and would be reset.
    for steps in [500, 3, 8] {
        twins.play(steps, false);
        let mut number = || acrobot::uniform(&mut rng, -10.0, 10.0) as f32;
        let states: Vec<State<f32>> = (0..35)
            .map(|_| State::from([(); 4].map(|()| number())))
            .collect();
        twins.batch.reset_to(&states).unwrap();
        for ((alone, ended), state) in twins.alone.iter_mut().zip(&mut twins.ended).zip(&states) {
            let rng = alone.inner().rng().clone();
            alone.reset();
            alone.inner_mut().set_state(*state).unwrap();
            *alone.inner_mut().rng_mut() = rng;
            *ended = false;
        }
    }
    twins.play(520, true);

    let before = twins.batch.state(0);
    let infinite = State {
        theta1: f32::INFINITY,
        ..State::default()
    };
    let mut states = [State::default(); 35];
    states[34] = infinite;
    let refused = twins.batch.reset_to(&states).unwrap_err();
    assert!(
        matches!(refused, Error::OutOfRange { name: "theta1", .. }),
        "{refused}"
    );
    let refused = twins.batch.reset_to(&states[..34]).unwrap_err();
    assert_eq!(refused.to_string(), "states has 34 elements; allowed is 35");
    assert_eq!(twins.batch.state(0), before);
}

/// In the middle of episodes, of which some have just ended, with noise to come.
#[test]
fn members_go_on_in_another_batch() {
    let mut twins = Twins::<Fast>::new(35, Autoreset::NextStep);
    let params = Params {
        torque_noise: 0.3,
        ..Params::default()
    };
    twins.set_params(params);
    for steps in [70, 430] {
        twins.play(steps, true);
        let members: Vec<_> = (0..35).map(|i| twins.batch.member(i).unwrap()).collect();
        assert!(members.iter().any(|member| member.elapsed > 0));
        let (blocks, generators) = (vec![Block::EMPTY; 3], vec![Pcg64::UNSEEDED; 35]);
        twins.batch = Batch::new(7, blocks, generators).unwrap();
        twins.batch.set_params(params).unwrap();
        for (index, member) in members.into_iter().enumerate() {
            twins.batch.set_member(index, member).unwrap();
        }
    }
    twins.play(600, false);

    assert_eq!(twins.batch.member(35), None);
    let mut member = twins.batch.member(34).unwrap();
    let refused = twins.batch.set_member(35, member.clone()).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "index is 35 acrobots; allowed is one below the length of the batch"
    );
    member.state.dtheta2 = f32::NAN;
    let before = twins.batch.member(34);
    assert!(twins.batch.set_member(34, member).is_err());
    assert_eq!(twins.batch.member(34), before);
}
