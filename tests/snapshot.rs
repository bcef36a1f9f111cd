//! A snapshot of an older release loads. An invalid snapshot, or one of another type, is rejected
//! with the reason. `cargo test -p properties` resumes snapshots in more formats.

use acrobot::arithmetic::{Arithmetic, Damped, Reference};
use acrobot::batch::{Member, VecBatch};
use acrobot::control::estimate::{Noise, ParameterEstimator, ParameterStd};
use acrobot::task::ResetBounds;
use acrobot::{Acrobot, Action, Fast, Params, Portable, TimeLimit};
use serde::Serialize;
use serde::de::DeserializeOwned;

type Limited = TimeLimit<Acrobot<Portable>>;

/// An acrobot in the middle of an episode with noise. Its generator keeps half a draw.
fn busy() -> Limited {
    let mut acrobot = TimeLimit::with_task_limit(Acrobot::<Portable>::new(u64::MAX));
    let inner = acrobot.inner_mut();
    inner.set_params(Params { torque_noise: 0.1, mass2: 1.5, ..Params::DEFAULT }).unwrap();
    Action::sample(inner.rng_mut());
    for _ in 0..10 {
        acrobot.step(Action::Positive);
    }
    acrobot
}

#[test]
fn snapshots_that_are_invalid_or_of_another_type_are_rejected() {
    let text = serde_json::to_string(&busy()).unwrap();
    assert!(serde_json::from_str::<TimeLimit<Acrobot<Damped<Portable>>>>(&text).is_ok());
    let error = |from: &str, to: &str| {
        assert!(text.contains(from), "{from} in {text}");
        let changed = serde_json::from_str::<Limited>(&text.replacen(from, to, 1));
        let error = changed.unwrap_err().to_string();
        error.rsplit_once(" at line").unwrap().0.to_owned()
    };
    let ours = r#""acrobot", version 6, task "gymnasium", arithmetic "portable""#;
    let header = r#""snapshot":{"of":"acrobot","version":6,"task":"gymnasium","arithmetic":"portable","data":{}},"#;
    for (from, to) in
        [(r#""acrobot""#, r#""batch""#), ("6", "5"), ("gymnasium", "swingup"), ("portable", "host")]
    {
        let expected = format!("the snapshot must be {ours}, got {}", ours.replace(from, to));
        assert_eq!(error(from, to), expected);
        // The header is checked before anything else is read.
        let [unread, changed] = [header.to_owned(), header.replace(from, to)];
        let found = error(&(unread + r#""params":{"#), &(changed + r#""params":{}"#));
        assert_eq!(found, expected);
    }
    let no_snapshot = "; the input must be a snapshot of version 6";
    assert!(error(r#""acrobot""#, r#""an environment of another kind""#).ends_with(no_snapshot));
    assert_eq!(error(header, ""), format!("missing field `snapshot`{no_snapshot}"));
    let rule = "mass2 must be finite and above 0 kg, got -1.5";
    assert_eq!(error(r#""mass2":1.5"#, r#""mass2":-1.5"#), rule);
    // A binary format can hold NaN, JSON cannot.
    let acrobot = Acrobot::<Portable>::new(0);
    let state = postcard::to_stdvec(&acrobot.state()).unwrap();
    let mut bytes = postcard::to_stdvec(&acrobot).unwrap();
    let at = bytes.windows(state.len()).position(|window| window == state).unwrap();
    bytes[at..at + 8].copy_from_slice(&f64::NAN.to_le_bytes());
    assert!(postcard::from_bytes::<Acrobot<Portable>>(&bytes).is_err());
}

/// A batch whose resets draw parameters, after a step.
fn batch() -> VecBatch<Fast> {
    let mut batch = VecBatch::new(42, 2).unwrap();
    batch.own_params().unwrap();
    batch.set_draws(common::draws::<Fast>()).unwrap();
    batch.set_reset_bounds(ResetBounds::new(-0.5, 0.25).unwrap());
    batch.set_max_steps(30.try_into().unwrap());
    batch.reset();
    // Each steps alone, to the same bits: a batch's step takes seconds to compile.
    for i in 0..2 {
        let member = batch.member(i).unwrap();
        let mut alone = Acrobot::<Fast>::hanging(member.rng);
        alone.set_params(member.params).unwrap();
        alone.set_state(member.state).unwrap();
        alone.step(Action::Positive);
        let (state, rng) = (alone.state(), alone.rng().clone());
        batch.set_member(i, Member { state, rng, elapsed_steps: 1, ..member }).unwrap();
    }
    batch
}

fn to_hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn from_hex(text: &str) -> Vec<u8> {
    let pairs = text.as_bytes().chunks(2);
    let byte = |pair| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16).unwrap();
    pairs.map(byte).collect()
}

/// Two lines: `original` as JSON and as postcard. The lines of the file must load as `original`.
fn stored<T: Serialize + DeserializeOwned>(original: T, lines: &mut std::str::Lines<'_>) -> String {
    let [json, hex] = [(); 2].map(|()| lines.next().unwrap());
    let from_json: T = serde_json::from_str(json).unwrap();
    let from_bytes: T = postcard::from_bytes(&from_hex(hex)).unwrap();
    let json = serde_json::to_string(&original).unwrap();
    let [hex, ref loaded @ ..] =
        [original, from_json, from_bytes].map(|x| to_hex(&postcard::to_stdvec(&x).unwrap()));
    assert_eq!(*loaded, [&*hex; 2]);
    format!("{json}\n{hex}\n")
}

/// Each version has its own file.
#[test]
fn snapshots_of_version_6_stay_readable() {
    let file = include_str!("data/snapshots_6.txt");
    let mut lines = file.lines();
    let found = [
        stored(busy(), &mut lines),
        stored(Acrobot::<Fast>::new(3), &mut lines),
        stored(batch(), &mut lines),
    ];
    assert_eq!(found.concat(), file);
}

/// The largest snapshot: all integers of the generator and of the limit have their largest value.
/// The last arithmetic's name has 16 bytes, the most that a snapshot holds.
#[test]
fn an_estimator_continues_bit_identically() {
    let std = ParameterStd { mass2: 0.1, ..ParameterStd::default() }; // kg
    let noise = Noise { angle_std: 1e-3, torque_std: 0.01 }; // rad, N m
    let mut estimator = ParameterEstimator::<Fast>::new(Params::DEFAULT, std, noise).unwrap();
    for tick in 0..20 {
        let bytes = postcard::to_stdvec(&estimator).unwrap();
        let mut loaded: ParameterEstimator<Fast> = postcard::from_bytes(&bytes).unwrap();
        for each in [&mut estimator, &mut loaded] {
            each.correct([0.1 * tick as f32, 0.2]).unwrap(); // rad
            each.predict(0.3).unwrap(); // N m
        }
        assert_eq!(postcard::to_stdvec(&loaded), postcard::to_stdvec(&estimator));
        assert_eq!(loaded.params(), estimator.params());
    }
    assert_ne!(estimator.params().mass2, 1.0);
}

#[test]
fn no_snapshot_is_larger_than_its_constant() {
    fn check<A: Arithmetic>() {
        let mut largest =
            serde_json::to_value(TimeLimit::with_task_limit(Acrobot::<A>::new(0))).unwrap();
        largest["inner"]["rng"] = serde_json::json!({
            "seed": ([u32::MAX; 8]), "position": u64::MAX, "has_half": true, "half": u32::MAX
        });
        largest["max_steps"] = u32::MAX.into();
        largest["elapsed_steps"] = u32::MAX.into();
        let largest: TimeLimit<Acrobot<A>> = serde_json::from_value(largest).unwrap();
        let bytes = postcard::to_stdvec(&largest).unwrap();
        assert_eq!(bytes.len(), TimeLimit::<Acrobot<A>>::MAX_SNAPSHOT_SIZE);
        let bytes = postcard::to_stdvec(largest.inner()).unwrap();
        assert_eq!(bytes.len(), Acrobot::<A>::MAX_SNAPSHOT_SIZE);
    }
    check::<Fast>();
    check::<Portable>();
    check::<Damped<Reference>>();
}
