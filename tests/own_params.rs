//! Promise 2 for batches in which each acrobot has its own parameters.

use acrobot::arithmetic::{Arithmetic, Host, Micro, Real, Reference};
use acrobot::batch::{Autoreset, OwnParams, SimdLevel, VecBatch};
use acrobot::numpy::{Pcg64, SeedSequence, uniform};
use acrobot::physics::{Dynamics, ParamsRange};
use acrobot::{Acrobot, Action, Error, Fast, Params, Portable, State, TimeLimit};
use bits::against;

/// All parameters, each from a wide range.
fn range<S: Real>(dynamics: Dynamics) -> ParamsRange<S> {
    let low = Params {
        length1: 0.5,
        length2: 0.5,
        mass1: 0.5,
        mass2: 0.5,
        center_of_mass1: 0.0,
        center_of_mass2: 0.0,
        inertia1: 0.5,
        inertia2: 0.5,
        gravity: 1.6,
        dt: 0.05,
        max_velocity1: 5.0,
        max_velocity2: 5.0,
        torques: [-2.0, -0.5, 0.5],
        torque_noise: 0.0,
        dynamics,
    };
    let high = Params {
        length1: 2.0,
        length2: 2.0,
        mass1: 2.0,
        mass2: 2.0,
        center_of_mass1: 1.0,
        center_of_mass2: 1.0,
        inertia1: 2.0,
        inertia2: 2.0,
        gravity: 24.8,
        dt: 0.3,
        max_velocity1: 20.0,
        max_velocity2: 40.0,
        torques: [-0.5, 0.5, 2.0],
        torque_noise: 0.5,
        dynamics,
    };
    ParamsRange::new(low.cast(), high.cast()).unwrap()
}

/// A batch and its scalar twins.
struct Twins<A: Arithmetic> {
    batch: VecBatch<A, OwnParams>,
    alone: Vec<TimeLimit<Acrobot<A>>>,
    waiting: Vec<bool>,
}

impl<A: Arithmetic> Twins<A> {
    fn new(len: usize, autoreset: Autoreset) -> Self {
        let mut batch = VecBatch::new(SeedSequence::new(42), len).unwrap();
        batch.set_autoreset(autoreset);
        let seeds = SeedSequence::new(42).spawn(len as u64);
        Self {
            batch,
            alone: seeds
                .map(|seed| TimeLimit::v1(Acrobot::with_rng(seed.into())))
                .collect(),
            waiting: vec![false; len],
        }
    }

    /// What a reset does to acrobot `i`.
    fn reset_alone(batch: &VecBatch<A, OwnParams>, alone: &mut TimeLimit<Acrobot<A>>) -> [f32; 6] {
        if let Some(range) = batch.params_range() {
            let params = range.draw(alone.inner_mut().rng_mut());
            alone.set_params(params).unwrap();
        }
        alone.reset_with(batch.reset_bounds().into()).to_array()
    }

    fn reset(&mut self) {
        self.batch.reset();
        for alone in &mut self.alone {
            Self::reset_alone(&self.batch, alone);
        }
        self.waiting.fill(false);
        self.assert_equal();
    }

    fn set_params(&mut self, params: impl Fn(usize) -> Params<A::Scalar>) {
        for (i, alone) in self.alone.iter_mut().enumerate() {
            self.batch.set_params_of(i, params(i)).unwrap();
            alone.set_params(params(i)).unwrap();
        }
        self.assert_equal();
    }

    /// Steps with torque against θ̇1, and compares every bit.
    fn swing(&mut self, steps: u32) {
        for _ in 0..steps {
            let states = (0..self.batch.len()).map(|i| self.batch.state(i).unwrap());
            let actions: Vec<Action> = states.map(|state| against(state.dtheta1)).collect();
            let autoreset = self.batch.autoreset();
            let results = self.batch.step(&actions).unwrap();
            let [rewards, terminated, truncated] = [
                results.rewards.to_vec(),
                results.terminated.iter().map(|x| f32::from(*x)).collect(),
                results.truncated.iter().map(|x| f32::from(*x)).collect(),
            ];
            let rows = results.observations.to_vec();
            let finals = results.final_observations.to_vec();
            for (i, alone) in self.alone.iter_mut().enumerate() {
                let expected = if std::mem::take(&mut self.waiting[i]) {
                    (Self::reset_alone(&self.batch, alone), 0.0, false, false)
                } else {
                    let step = alone.step(actions[i]);
                    let mut row = step.observation.to_array();
                    match autoreset {
                        Autoreset::SameStep if step.done() => {
                            assert_eq!(finals[i].map(f32::to_bits), row.map(f32::to_bits));
                            row = Self::reset_alone(&self.batch, alone);
                        }
                        Autoreset::NextStep => self.waiting[i] = step.done(),
                        _ => {}
                    }
                    (row, step.reward, step.terminated, step.truncated)
                };
                assert_eq!(rows[i].map(f32::to_bits), expected.0.map(f32::to_bits));
                assert_eq!(
                    (rewards[i], terminated[i], truncated[i]),
                    (expected.1, expected.2.into(), expected.3.into())
                );
            }
            self.assert_equal();
        }
    }

    fn assert_equal(&self) {
        for (i, alone) in self.alone.iter().enumerate() {
            let member = self.batch.member(i).unwrap();
            let inner = alone.inner();
            assert_eq!(bits(member.state), bits(inner.state()), "acrobot {i}");
            assert_eq!(member.elapsed, alone.elapsed(), "acrobot {i}");
            assert_eq!(self.batch.elapsed(i), Some(member.elapsed));
            assert_eq!(member.rng, *inner.rng(), "acrobot {i}");
            assert_eq!(self.batch.params_of(i), Some(inner.params()), "acrobot {i}");
        }
    }
}

/// The bits of a state, which distinguish 0 from −0.
fn bits<S: Real>(state: State<S>) -> [u64; 4] {
    <[S; 4]>::from(state).map(|x| x.to_f64().to_bits())
}

const LEVELS: [SimdLevel; 3] = [SimdLevel::Baseline, SimdLevel::Avx2, SimdLevel::Avx512];

/// Each reset draws all parameters. A level that the machine does not have acts as the baseline.
#[test]
fn a_thousand_acrobots_equal_single_ones_for_ten_thousand_steps() {
    // With optimization the larger numbers take seconds.
    let (len, steps) = match cfg!(debug_assertions) {
        true => (100, 600),
        false => (1000, 10_000),
    };
    for level in LEVELS {
        println!("{level:?}, available: {}", level.is_available());
        let mut twins = Twins::<Fast>::new(len, Autoreset::NextStep);
        twins.batch.set_simd_level(level);
        twins.batch.set_params_range(Some(range(Dynamics::Book)));
        twins.reset();
        twins.swing(steps);
    }
}

/// Every other acrobot has the equations of the 1996 paper, and a third has no noise.
#[test]
fn every_arithmetic_and_mode_equals_single_acrobots() {
    fn play<A: Arithmetic>() {
        for level in LEVELS {
            for autoreset in [
                Autoreset::NextStep,
                Autoreset::SameStep,
                Autoreset::Disabled,
            ] {
                let mut twins = Twins::<A>::new(37, autoreset);
                twins.batch.set_simd_level(level);
                twins.swing(50); // the default parameters
                let mut rng = Pcg64::new(5);
                let drawn: Vec<_> = (0..37)
                    .map(|i| {
                        let dynamics = match i % 2 {
                            0 => Dynamics::Book,
                            _ => Dynamics::Nips,
                        };
                        let mut params = range(dynamics).draw(&mut rng);
                        if i % 3 == 0 {
                            params.torque_noise = A::Scalar::ZERO;
                        }
                        params
                    })
                    .collect();
                twins.set_params(|i| drawn[i]);
                twins.swing(600);
                // Later resets keep these parameters.
                twins.reset();
                twins.swing(50);
            }
        }
    }
    play::<Fast>();
    play::<Micro>();
    play::<Portable>();
    play::<Reference>();
    play::<Host>();
}

#[test]
fn equal_parameters_equal_shared_ones() {
    let mut own = VecBatch::<Fast, OwnParams>::new(SeedSequence::new(3), 100).unwrap();
    let mut shared = VecBatch::<Fast>::new(SeedSequence::new(3), 100).unwrap();
    let params = range(Dynamics::Nips).draw(&mut Pcg64::new(1));
    shared.set_params(params).unwrap();
    for i in 0..100 {
        own.set_params_of(i, params).unwrap();
    }
    for step in 0..600 {
        let actions = [step as u8 / 7 % 3; 100];
        assert_eq!(own.step(&actions).unwrap(), shared.step(&actions).unwrap());
    }
}

#[test]
fn threads_change_no_bit() {
    let mut one = VecBatch::<Fast, OwnParams>::new(SeedSequence::new(3), 50_003).unwrap();
    one.set_params_range(Some(range(Dynamics::Book)));
    one.set_autoreset(Autoreset::SameStep);
    one.set_limit(7.try_into().unwrap());
    one.reset();
    let mut many = one.clone();
    let mut rng = Pcg64::new(1);
    for _ in 0..8 {
        let actions: Vec<Action> = (0..one.len()).map(|_| Action::sample(&mut rng)).collect();
        let torques: Vec<f32> = actions
            .iter()
            .map(|_| uniform(&mut rng, -2.0, 2.0) as f32)
            .collect();
        assert!(one.step(&actions).unwrap() == many.par_step(&actions).unwrap());
        assert!(one.step(&torques).unwrap() == many.par_step(&torques).unwrap());
    }
}

#[test]
fn a_rejected_call_changes_nothing() {
    let mut batch = VecBatch::<Fast, OwnParams>::new(SeedSequence::new(3), 20).unwrap();
    let params = Params {
        mass1: 2.0,
        ..Params::DEFAULT
    };
    assert_eq!(
        batch.set_params_of(20, params).unwrap_err().to_string(),
        "member index must be below 20, got 20"
    );
    let negative = Params {
        mass1: -1.0,
        ..params
    };
    assert_eq!(
        batch.set_params_of(0, negative).unwrap_err().to_string(),
        "mass1 must be finite and above 0 kg, got -1"
    );
    assert!((0..20).all(|i| batch.params_of(i) == Some(&Params::DEFAULT)));
    assert_eq!(batch.params_of(20), None);
    assert_eq!(batch.elapsed(20), None);
    assert!(matches!(
        batch.step(&[1_u8; 19]),
        Err(Error::WrongLength { .. })
    ));
}

#[test]
fn invalid_ranges_are_rejected() {
    let new = |low, high| ParamsRange::new(low, high).unwrap_err().to_string();
    let params = Params::<f64>::DEFAULT;
    let heavy = Params {
        mass2: 3.0,
        ..params
    };
    assert_eq!(
        new(heavy, params),
        "the lower mass2 must not be above the upper one, got 3 and 1 kg"
    );
    let weightless = Params {
        gravity: -f64::MAX,
        ..params
    };
    let crushing = Params {
        gravity: f64::MAX,
        ..params
    };
    assert_eq!(
        new(weightless, crushing),
        "gravity must be a range of finite width in m/s², got inf"
    );
    let negative = Params { dt: -0.1, ..params };
    assert_eq!(
        new(negative, params),
        "dt must be finite and above 0 s, got -0.1"
    );
    let nips = Params {
        dynamics: Dynamics::Nips,
        ..params
    };
    assert_eq!(
        new(params, nips),
        "dynamics must be the same in both bounds of a range"
    );
}

/// The largest draw of a generator can round to a number above the upper bound.
#[test]
fn draws_are_within_the_range() {
    struct Largest;
    impl rand_core::TryRng for Largest {
        type Error = core::convert::Infallible;
        fn try_next_u32(&mut self) -> Result<u32, Self::Error> {
            Ok(u32::MAX)
        }
        fn try_next_u64(&mut self) -> Result<u64, Self::Error> {
            Ok(u64::MAX)
        }
        fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Self::Error> {
            bytes.fill(u8::MAX);
            Ok(())
        }
    }
    let range = range::<f32>(Dynamics::Book);
    let drawn = range.draw(&mut Largest);
    assert_eq!(drawn, *range.high());
    let mut rng = Pcg64::new(0);
    for _ in 0..1000 {
        let drawn = range.draw(&mut rng);
        assert!(ParamsRange::new(*range.low(), drawn).is_ok());
        assert!(ParamsRange::new(drawn, *range.high()).is_ok());
    }
}
