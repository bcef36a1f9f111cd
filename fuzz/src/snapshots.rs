//! All types that can be saved, and checks of what was loaded.

use std::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Host, Micro, Real, Reference};
use acrobot::batch::{Autoreset, Batch, Block, LaneParams, Member, VecBatch};
use acrobot::numpy::{Pcg64, SeedSequence, uniform};
use acrobot::physics::{Dynamics, ParamsRange};
use acrobot::{Acrobot, Action, Fast, Params, Portable, State, TimeLimit};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::{assert_settled, assert_stepped};

/// A type that can be saved.
trait Snapshot: Serialize + DeserializeOwned {
    /// A value that a user might save.
    fn sample() -> Self;

    /// Uses the loaded value. Returns whether it is valid. Plain data can be invalid.
    fn check(self) -> bool;
}

/// Loads a type from bytes, and saves its sample in every format.
type Kind = (fn(&[u8]), fn() -> [Vec<u8>; 2]);

const fn kind<T: Snapshot>() -> Kind {
    (load::<T>, save::<T>)
}

const KINDS: [Kind; 18] = [
    kind::<Acrobot<Reference>>(),
    kind::<Acrobot<Portable>>(),
    kind::<Acrobot<Fast>>(),
    kind::<Acrobot<Micro>>(),
    kind::<Acrobot<Host>>(),
    kind::<TimeLimit<Acrobot<Portable>>>(),
    kind::<TimeLimit<Acrobot<Fast>>>(),
    kind::<Member<Fast>>(),
    kind::<Member<Portable>>(),
    kind::<Pcg64>(),
    kind::<Params<f64>>(),
    kind::<Params<f32>>(),
    kind::<State<f64>>(),
    kind::<Action>(),
    kind::<Dynamics>(),
    kind::<VecBatch<Fast>>(),
    kind::<VecBatch<Fast, 1>>(),
    kind::<VecBatch<Portable, 3>>(),
];

/// The first byte chooses a type. Loads a snapshot of it from the other bytes, in each format.
pub fn check(input: &[u8]) {
    let Some((kind, bytes)) = input.split_first() else {
        return;
    };
    let (load, _) = KINDS[usize::from(*kind) % KINDS.len()];
    load(bytes);
}

/// Valid inputs of [`check`]: every type in every format.
pub fn samples() -> impl Iterator<Item = Vec<u8>> {
    let kinds = (0_u8..).zip(KINDS);
    kinds.flat_map(|(kind, (_, save))| save().map(|bytes| [vec![kind], bytes].concat()))
}

fn save<T: Snapshot>() -> [Vec<u8>; 2] {
    [binary(&T::sample()), json(&T::sample())]
}

fn binary(value: &impl Serialize) -> Vec<u8> {
    postcard::to_stdvec(value).expect("there is memory")
}

fn json(value: &impl Serialize) -> Vec<u8> {
    serde_json::to_vec(value).expect("there is memory")
}

fn load<T: Snapshot>(bytes: &[u8]) {
    let binaries = postcard::from_bytes::<T>(bytes).ok();
    let texts = serde_json::from_slice::<T>(bytes).ok();
    for loaded in binaries.into_iter().chain(texts) {
        // Compared as bytes, because plain data may be NaN.
        let (saved, text) = (binary(&loaded), json(&loaded));
        let again: T = postcard::from_bytes(&saved).expect("it was saved");
        assert_eq!(binary(&again), saved);
        // JSON has neither NaN nor infinity.
        if loaded.check() {
            let again: T = serde_json::from_slice(&text).expect("it was saved");
            assert_eq!(binary(&again), saved);
        }
    }
}

impl<A> Snapshot for Acrobot<A>
where
    A: Arithmetic<Scalar: Serialize + DeserializeOwned>,
{
    fn sample() -> Self {
        let mut acrobot = Acrobot::new(42);
        let noisy = Params {
            torque_noise: A::Scalar::from_f64(0.1),
            ..Params::default()
        };
        assert!(acrobot.set_params(noisy).is_ok());
        Action::sample(acrobot.rng_mut()); // leaves half of a draw over
        acrobot.step(Action::Positive);
        acrobot
    }

    fn check(mut self) -> bool {
        assert!(self == self.clone());
        assert!(self.params().validate().is_ok() && self.state().validate().is_ok());
        for action in Action::ALL {
            assert_stepped(self.step(action), self.state(), self.params());
        }
        self.reset();
        assert!(self.state().validate().is_ok());
        true
    }
}

impl<A> Snapshot for TimeLimit<Acrobot<A>>
where
    A: Arithmetic<Scalar: Serialize + DeserializeOwned>,
{
    fn sample() -> Self {
        let mut limited = TimeLimit::v1(Acrobot::sample());
        limited.step(Action::Zero);
        limited
    }

    fn check(mut self) -> bool {
        let elapsed = self.elapsed();
        let step = self.step(Action::Negative);
        assert_eq!(self.elapsed(), elapsed.saturating_add(1));
        assert_eq!(step.truncated, self.elapsed() >= self.limit().get());
        self.inner().clone().check()
    }
}

impl<A> Snapshot for Member<A>
where
    A: Arithmetic<Scalar: Serialize + DeserializeOwned>,
{
    fn sample() -> Self {
        Self {
            params: Params::sample(),
            state: State::sample(),
            elapsed: 3,
            reset_pending: true,
            rng: Pcg64::sample(),
        }
    }

    fn check(self) -> bool {
        let valid = self.state.validate().is_ok() && self.params.validate().is_ok();
        for autoreset in [
            Autoreset::NextStep,
            Autoreset::SameStep,
            Autoreset::Disabled,
        ] {
            let seed = SeedSequence::new(0);
            let mut batch = VecBatch::<A>::with_own_params(seed, 1).expect("memory for one");
            batch.set_autoreset(autoreset);
            batch.set_limit(NonZeroU32::MAX);
            assert_eq!(batch.set_member(0, self.clone()).is_ok(), valid);
            assert_steps(&mut batch);
        }
        valid
    }
}

fn assert_steps<A: Arithmetic, const N: usize>(batch: &mut VecBatch<A, N>) {
    let pending: Vec<_> = (0..batch.len()).map(|i| batch.member(i)).collect();
    assert!(batch.step(&vec![2_u8; batch.len()]).is_ok());
    for (index, before) in pending.into_iter().enumerate() {
        let member = batch.member(index).expect("it has as many");
        assert!(member.state.validate().is_ok() && member.params.validate().is_ok());
        if !before.is_some_and(|before| before.reset_pending) && member.elapsed > 0 {
            assert_settled(member.state, &member.params);
        }
    }
}

/// With one or three lanes each acrobot has its own parameters.
impl<A, const N: usize> Snapshot for VecBatch<A, N>
where
    A: Arithmetic<Scalar: Serialize + DeserializeOwned>,
{
    fn sample() -> Self {
        let seed = SeedSequence::new(42);
        let low = Params::<A::Scalar>::default();
        let mut high = low;
        high.torque_noise = A::Scalar::from_f64(0.5);
        let batch = if N < 4 {
            let range = ParamsRange::new(low, high);
            VecBatch::with_own_params(seed, 4).and_then(|mut batch: Self| {
                batch.set_params_range(Some(range?))?;
                batch.reset();
                Ok(batch)
            })
        } else {
            VecBatch::new(seed, 4)
        };
        let mut batch = batch.expect("memory for four");
        batch.set_limit(NonZeroU32::MIN);
        assert!(batch.step(&[2_u8; 4]).is_ok());
        batch
    }

    fn check(mut self) -> bool {
        let (len, bytes) = (self.len(), binary(&self));
        let first = self.params_of(0);
        let same = (0..len).all(|index| self.params_of(index) == first);
        let fits = same && self.params_range().is_none();
        let mut blocks = vec![Block::EMPTY; len];
        let mut generators = vec![Pcg64::UNSEEDED; len];
        let mut from = postcard::Deserializer::from_bytes(&bytes);
        let memory = (&mut blocks[..], &mut generators[..]);
        let shared = Batch::<A, _, 1>::from_snapshot(memory, &mut from);
        assert_eq!(shared.is_ok(), fits);
        let mut from = postcard::Deserializer::from_bytes(&bytes);
        let memory = (blocks, generators, vec![LaneParams::default(); len]);
        let own = Batch::<A, _, 1>::from_snapshot(memory, &mut from).expect("it was saved");
        for index in 0..len {
            assert_eq!(own.member(index), self.member(index));
        }
        self.reset_masked(&vec![false; len], 1.into())
            .expect("the length");
        assert!(binary(&self) == bytes);
        assert_steps(&mut self);
        self.reset();
        assert_steps(&mut self);
        true
    }
}

impl Snapshot for Pcg64 {
    fn sample() -> Self {
        let mut rng = Self::new(42);
        Action::sample(&mut rng);
        rng
    }

    fn check(mut self) -> bool {
        Action::sample(&mut self);
        assert!((-1.0..1.0).contains(&uniform(&mut self, -1.0, 1.0)));
        true
    }
}

impl<S: Real + Serialize + DeserializeOwned> Snapshot for Params<S> {
    fn sample() -> Self {
        Self {
            dynamics: Dynamics::Nips,
            ..Self::default()
        }
    }

    fn check(self) -> bool {
        let mut acrobot = Acrobot::<Host>::new(0);
        let params = self.cast();
        assert_eq!(
            acrobot.set_params(params).is_ok(),
            params.validate().is_ok()
        );
        assert_stepped(
            acrobot.step(Action::Positive),
            acrobot.state(),
            acrobot.params(),
        );
        self.validate().is_ok()
    }
}

impl<S: Real + Serialize + DeserializeOwned> Snapshot for State<S> {
    fn sample() -> Self {
        State::from([0.5, -0.25, 1.0, -2.0]).cast()
    }

    fn check(self) -> bool {
        let mut acrobot = Acrobot::<Portable>::new(0);
        let valid = self.validate().is_ok();
        assert_eq!(acrobot.set_state(self.cast()).is_ok(), valid);
        assert_stepped(
            acrobot.step(Action::Positive),
            acrobot.state(),
            acrobot.params(),
        );
        valid
    }
}

impl Snapshot for Action {
    fn sample() -> Self {
        Self::Positive
    }

    fn check(self) -> bool {
        Self::try_from(u8::from(self)) == Ok(self)
    }
}

impl Snapshot for Dynamics {
    fn sample() -> Self {
        Self::Nips
    }

    fn check(self) -> bool {
        true
    }
}
