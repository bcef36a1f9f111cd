//! Any bytes in place of a snapshot of each type: rejected, or loaded as a valid one.

#![no_main]

use std::fs;
use std::num::NonZeroU32;
use std::path::Path;

use acrobot::arithmetic::{Arithmetic, Host, Micro, Real, Reference};
use acrobot::batch::{
    Autoreset, Batch, BatchMemory, Block, LaneParams, Member, OwnParams, VecBatch,
};
use acrobot::numpy::Pcg64;
use acrobot::physics::Dynamics;
use acrobot::task::{Draw, Draws, Gymnasium};
use acrobot::{Acrobot, Action, Fast, Params, Portable, TimeLimit};
use libfuzzer_sys::fuzz_target;
use serde::Serialize;
use serde::de::DeserializeOwned;

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

const KINDS: [Kind; 12] = [
    kind::<Acrobot<Reference>>(),
    kind::<Acrobot<Portable>>(),
    kind::<Acrobot<Fast>>(),
    kind::<Acrobot<Micro>>(),
    kind::<Acrobot<Host>>(),
    kind::<TimeLimit<Acrobot<Portable>>>(),
    kind::<TimeLimit<Acrobot<Fast>>>(),
    kind::<Member<Fast>>(),
    kind::<Member<Portable>>(),
    kind::<VecBatch<Fast>>(),
    kind::<VecBatch<Fast, Gymnasium, 1>>(),
    kind::<VecBatch<Portable, Gymnasium, 3>>(),
];

// The first byte chooses a type. Loads a snapshot of it from the other bytes, in each format.
fuzz_target!(init: write_seeds(), |bytes: &[u8]| {
    if let Some((kind, bytes)) = bytes.split_first() {
        let (load, _) = KINDS[usize::from(*kind) % KINDS.len()];
        load(bytes);
    }
});

/// Writes a snapshot of every type in every format, from which libFuzzer begins.
fn write_seeds() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/seeds");
    fs::create_dir_all(&folder).expect("a folder");
    for (kind, (_, save)) in (0_u8..).zip(KINDS) {
        for (format, bytes) in ["postcard", "json"].into_iter().zip(save()) {
            let seed = [&[kind], &bytes[..]].concat();
            fs::write(folder.join(format!("{kind}.{format}")), seed).expect("a file");
        }
    }
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

impl<A: Arithmetic> Snapshot for Acrobot<A> {
    fn sample() -> Self {
        let mut acrobot = Acrobot::new(42);
        let noisy = Params { torque_noise: A::Scalar::from_f64(0.1), ..Params::default() };
        assert!(acrobot.set_params(noisy).is_ok());
        Action::sample(acrobot.rng_mut()); // leaves half of a draw over
        acrobot.step(Action::Positive);
        acrobot
    }

    /// `tests/properties` proves the rest: steps of any valid acrobot keep their promises.
    fn check(mut self) -> bool {
        assert!(self == self.clone());
        assert!(self.params().validate().is_ok() && self.state().validate().is_ok());
        for action in Action::ALL {
            self.step(action);
            assert!(self.state().validate().is_ok());
        }
        self.reset();
        assert!(self.state().validate().is_ok());
        true
    }
}

impl<A: Arithmetic> Snapshot for TimeLimit<Acrobot<A>> {
    fn sample() -> Self {
        let mut limited = TimeLimit::with_task_limit(Acrobot::sample());
        limited.step(Action::Zero);
        limited
    }

    fn check(mut self) -> bool {
        let step = self.step(Action::Negative);
        assert_eq!(step.truncated, self.elapsed_steps() >= self.max_steps().get());
        self.inner().clone().check()
    }
}

impl<A: Arithmetic> Snapshot for Member<A> {
    fn sample() -> Self {
        let acrobot = Acrobot::<A>::sample();
        Self {
            params: Params { dynamics: Dynamics::Nips, ..*acrobot.params() },
            state: acrobot.state(),
            elapsed_steps: 3,
            is_done: true,
            rng: acrobot.rng().clone(),
        }
    }

    fn check(self) -> bool {
        let mut friction = self.params.numbers().into_iter().skip(16); // and the rotor
        let has_friction = friction.any(|(_, number)| number != A::Scalar::ZERO);
        let valid = self.state.validate().is_ok()
            && self.params.validate().is_ok()
            && (A::HAS_FRICTION || !has_friction);
        for autoreset in [Autoreset::NextStep, Autoreset::SameStep, Autoreset::Disabled] {
            let mut batch = VecBatch::<A>::new(0, 1).expect("memory for one");
            batch.own_params().expect("memory for one");
            batch.set_autoreset(autoreset);
            assert_eq!(batch.set_member(0, self.clone()).is_ok(), valid);
            assert_steps(&mut batch);
        }
        // Bounds of velocity may be infinite.
        valid && self.params.numbers().iter().all(|(_, number)| number.is_finite())
    }
}

fn assert_steps<A: Arithmetic, const N: usize>(batch: &mut VecBatch<A, Gymnasium, N>) {
    assert!(batch.step(&vec![2_u8; batch.len()]).is_ok());
    for index in 0..batch.len() {
        let member = batch.member(index).expect("it has as many");
        assert!(member.state.validate().is_ok() && member.params.validate().is_ok());
    }
}

/// With one or three lanes each acrobot has its own parameters.
impl<A: Arithmetic, const N: usize> Snapshot for VecBatch<A, Gymnasium, N> {
    fn sample() -> Self {
        let mut batch = Self::new(42, 4).expect("memory for four");
        if N < 4 {
            let [low, high] = [0.0, 0.5].map(A::Scalar::from_f64);
            let torque_noise = Draw::Uniform { low, high };
            let draws = Draws::new(Params { torque_noise, ..Draws::FIXED });
            batch.own_params().expect("memory for four");
            batch.set_draws(draws.expect("valid")).expect("valid");
            batch.reset();
        }
        batch.set_max_steps(NonZeroU32::MIN);
        assert!(batch.step(&[2_u8; 4]).is_ok());
        batch
    }

    fn check(mut self) -> bool {
        let len = self.len();
        let (blocks, generators) = (vec![Block::EMPTY; len], vec![Pcg64::UNSEEDED; len]);
        let own = OwnParams::new(vec![LaneParams::default(); len]);
        let memory = BatchMemory { blocks, generators, own };
        let bytes = binary(&self);
        let from = &mut postcard::Deserializer::from_bytes(&bytes);
        let loaded = Batch::<A, _, Gymnasium, 1>::from_snapshot(memory, from);
        let loaded = loaded.expect("it was saved");
        assert!((0..len).all(|index| loaded.member(index) == self.member(index)));
        assert_steps(&mut self);
        self.reset();
        assert_steps(&mut self);
        true
    }
}
