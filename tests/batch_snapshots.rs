//! A loaded batch continues to the same bits, with any memory and any width. An invalid snapshot is rejected with the
//! reason.

use std::fmt::Debug;

use acrobot::arithmetic::Arithmetic;
use acrobot::batch::{Autoreset, Batch, Block, LaneParams, StepBuffers, Storage, VecBatch};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::{Dynamics, ParamsRange, ResetBounds};
use acrobot::{Acrobot, Action, Fast, Params};
use bits::against;
use common::formats::again;
use common::params_range;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

const LEN: usize = 35;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Shared,
    Own,
    Drawn,
}

const KINDS: [Kind; 3] = [Kind::Shared, Kind::Own, Kind::Drawn];

/// A batch in the middle of episodes, of which some have ended.
fn running(kind: Kind, autoreset: Autoreset, noise: f32) -> VecBatch<Fast> {
    let seed = SeedSequence::new(42);
    let mut batch = match kind {
        Kind::Shared => VecBatch::new(seed, LEN).unwrap(),
        Kind::Own | Kind::Drawn => VecBatch::with_own_params(seed, LEN).unwrap(),
    };
    let range = params_range(Dynamics::Nips);
    let range = ParamsRange::new(
        Params {
            torque_noise: noise / 2.0,
            ..*range.low()
        },
        Params {
            torque_noise: noise,
            ..*range.high()
        },
    )
    .unwrap();
    let mut rng = Pcg64::new(5);
    match kind {
        Kind::Shared => batch.set_params(range.draw(&mut rng)).unwrap(),
        Kind::Own => {
            (0..LEN).for_each(|i| batch.set_params_of(i, range.draw(&mut rng)).unwrap());
            let zeros = |gravity| Params {
                gravity,
                torque_noise: noise,
                ..Params::DEFAULT
            };
            batch.set_params_of(0, zeros(0.0)).unwrap();
            batch.set_params_of(1, zeros(-0.0)).unwrap();
        }
        Kind::Drawn => batch.set_params_range(Some(range)).unwrap(),
    }
    batch.set_autoreset(autoreset);
    batch.set_reset_bounds(ResetBounds::new(-0.5, 0.25).unwrap());
    batch.set_limit(150.try_into().unwrap());
    batch.reset();
    let mut ends = 0;
    for step in 0.. {
        let results = step_of(&mut batch);
        ends += results.iter().filter(|one| one.1 || one.2).count();
        let now = (0..LEN).any(|i| batch.member(i).unwrap().reset_pending);
        if step > 50 && ends > 0 && (now || autoreset != Autoreset::NextStep) {
            break;
        }
    }
    // Half of a draw is left over.
    Action::sample(&mut batch.generators_mut()[0]);
    batch
}

/// The reward, both ends, the observation and the final observation of an acrobot, as bits.
type Results = (u32, bool, bool, [u32; 6], [u32; 6]);

/// A step under torque against θ̇1, which reaches the goal.
fn step_of<S: Storage<Fast, N>, const N: usize>(batch: &mut Batch<Fast, S, N>) -> Vec<Results> {
    let (mut rewards, mut terminated, mut truncated) = ([9.0; LEN], [true; LEN], [true; LEN]);
    let (mut rows, mut finals) = ([[9.0_f32; 6]; LEN], [[9.0_f32; 6]; LEN]);
    let actions: Vec<_> = (0..LEN)
        .map(|i| against(batch.state(i).unwrap().dtheta1))
        .collect();
    let buffers = StepBuffers::new(&mut rewards, &mut terminated, &mut truncated)
        .with_observations(&mut rows)
        .with_final_observations(&mut finals);
    batch.step(&actions, buffers).unwrap();
    let all = (0..LEN).map(|i| {
        let [row, last] = [rows[i], finals[i]].map(|row| row.map(f32::to_bits));
        let reward = rewards[i].to_bits();
        (reward, terminated[i], truncated[i], row, last)
    });
    all.collect()
}

/// Compares every bit of the members, and the settings.
fn assert_equal<S: Storage<Fast, N>, T: Storage<Fast, M>, const N: usize, const M: usize>(
    one: &Batch<Fast, S, N>,
    other: &Batch<Fast, T, M>,
) {
    assert_eq!(one.len(), other.len());
    assert_eq!(one.params_range(), other.params_range());
    assert_eq!(one.reset_bounds(), other.reset_bounds());
    assert_eq!(one.limit(), other.limit());
    assert_eq!(one.autoreset(), other.autoreset());
    for i in 0..one.len() {
        let [one, other] = [one.member(i).unwrap(), other.member(i).unwrap()];
        let [state, other_state] = [one.state, other.state].map(<[f32; 4]>::from);
        assert_eq!(state.map(f32::to_bits), other_state.map(f32::to_bits));
        let [gravity, other_gravity] = [one.params.gravity, other.params.gravity];
        assert_eq!(gravity.to_bits(), other_gravity.to_bits(), "member {i}");
        assert_eq!(one, other, "member {i}");
    }
}

/// Steps both, and compares every bit.
fn assert_continues<S: Storage<Fast, N>, const N: usize>(
    original: &VecBatch<Fast>,
    loaded: &mut Batch<Fast, S, N>,
    steps: u32,
) {
    let mut original = original.clone();
    assert_equal(&original, loaded);
    for step in 0..steps {
        assert_eq!(step_of(&mut original), step_of(loaded), "step {step}");
        assert_equal(&original, loaded);
    }
}

/// Every kind of parameters in every mode, with and without noise.
fn every_batch() -> impl Iterator<Item = VecBatch<Fast>> {
    let modes = [
        Autoreset::NextStep,
        Autoreset::SameStep,
        Autoreset::Disabled,
    ];
    let kinds = KINDS.into_iter().flat_map(move |kind| {
        let modes = modes.map(|autoreset| (kind, autoreset));
        modes.into_iter()
    });
    kinds.flat_map(|(kind, autoreset)| [0.0, 0.5].map(|noise| running(kind, autoreset, noise)))
}

fn has_own_params<const N: usize>(batch: &VecBatch<Fast, N>) -> bool {
    (0..LEN).any(|i| batch.params_of(i) != batch.params_of(0))
}

/// Loads with both formats into every kind of memory, with `N` lanes.
fn assert_resumes<const N: usize>(original: &VecBatch<Fast>) {
    let json = serde_json::to_string(original).unwrap();
    let bytes = postcard::to_stdvec(original).unwrap();
    let mut from_json: VecBatch<Fast, N> = serde_json::from_str(&json).unwrap();
    assert_continues(original, &mut from_json, 600);
    let mut from_bytes: VecBatch<Fast, N> = postcard::from_bytes(&bytes).unwrap();
    assert_continues(original, &mut from_bytes, 600);

    let mut blocks = vec![Block::EMPTY; LEN.div_ceil(N)];
    let mut lane_params = vec![LaneParams::default(); LEN.div_ceil(N)];
    let mut generators = [Pcg64::UNSEEDED; LEN];
    // Memory for own parameters takes both kinds.
    let memory = (&mut blocks[..], &mut generators[..], &mut lane_params[..]);
    let json = &mut serde_json::Deserializer::from_str(&json);
    let mut loaded = Batch::<Fast, _, N>::from_snapshot(memory, json).unwrap();
    assert_continues(original, &mut loaded, 600);
    if !has_own_params(original) {
        let memory = (&mut blocks[..], &mut generators[..]);
        let mut deserializer = postcard::Deserializer::from_bytes(&bytes);
        let mut loaded = Batch::<Fast, _, N>::from_snapshot(memory, &mut deserializer).unwrap();
        assert_continues(original, &mut loaded, 600);
    }
}

#[test]
fn loaded_batches_continue_to_the_same_bits() {
    for original in every_batch() {
        assert_resumes::<16>(&original);
        assert_resumes::<3>(&original);
    }
}

/// The snapshot does not depend on the memory and on the width.
#[test]
fn a_loaded_batch_is_saved_to_the_same_bytes() {
    for original in every_batch() {
        let bytes = postcard::to_stdvec(&original).unwrap();
        let wide: VecBatch<Fast, 32> = postcard::from_bytes(&bytes).unwrap();
        assert_eq!(postcard::to_stdvec(&wide).unwrap(), bytes);
        let mut deserializer = postcard::Deserializer::from_bytes(&bytes);
        let saved = if has_own_params(&original) {
            let lane_params = [LaneParams::default(); LEN];
            let memory = ([Block::EMPTY; LEN], [Pcg64::UNSEEDED; LEN], lane_params);
            let narrow = Batch::<Fast, _, 1>::from_snapshot(memory, &mut deserializer).unwrap();
            postcard::to_stdvec(&narrow)
        } else {
            let memory = ([Block::EMPTY; LEN], [Pcg64::UNSEEDED; LEN]);
            let narrow = Batch::<Fast, _, 1>::from_snapshot(memory, &mut deserializer).unwrap();
            postcard::to_stdvec(&narrow)
        };
        assert_eq!(saved.unwrap(), bytes);
    }
}

/// A struct, which some formats need.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Saved {
    batch: VecBatch<Fast>,
}

#[test]
fn every_format_stores_batches() {
    for kind in KINDS {
        let batch = running(kind, Autoreset::NextStep, 0.5);
        for (format, Saved { batch: mut loaded }) in again(&Saved {
            batch: batch.clone(),
        }) {
            println!("{kind:?}, {format}");
            assert_continues(&batch, &mut loaded, 60);
        }
    }
}

/// Fields in another order and unknown ones change nothing, as in the snapshot of an acrobot.
#[test]
fn fields_have_any_order_and_unknown_ones_are_ignored() {
    fn add(value: &mut Value) {
        match value {
            Value::Object(fields) => {
                fields.values_mut().for_each(add);
                fields.insert("an unknown field".into(), "new".into());
            }
            Value::Array(values) => values.iter_mut().for_each(add),
            _ => {}
        }
    }
    fn changed<T: Serialize + DeserializeOwned>(saved: &T) -> T {
        let mut value = serde_json::to_value(saved).unwrap();
        assert!(!value.to_string().contains("{\"snapshot\""), "not sorted");
        add(&mut value);
        serde_json::from_str(&value.to_string()).unwrap()
    }
    let acrobot = Acrobot::<Fast>::new(3);
    assert_eq!(changed(&acrobot), acrobot);
    for kind in KINDS {
        let batch = running(kind, Autoreset::NextStep, 0.5);
        let mut loaded = changed::<VecBatch<_>>(&batch);
        assert_continues(&batch, &mut loaded, 10);
    }
}

fn three(own_params: bool) -> VecBatch<Fast> {
    let seed = SeedSequence::new(1);
    match own_params {
        true => VecBatch::with_own_params(seed, 3).unwrap(),
        false => VecBatch::new(seed, 3).unwrap(),
    }
}

/// The error of loading JSON, without the position.
fn error<T: Debug>(loaded: Result<T, serde_json::Error>) -> String {
    let error = loaded.unwrap_err().to_string();
    error.split(" at line").next().unwrap().to_owned()
}

fn load<A: Arithmetic<Scalar: DeserializeOwned>>(json: &str) -> String {
    error(serde_json::from_str::<VecBatch<A>>(json))
}

/// Loads into memory for three acrobots that share their parameters.
fn load_shared(json: &str) -> String {
    let memory = ([Block::EMPTY; 1], [Pcg64::UNSEEDED; 3]);
    let json = &mut serde_json::Deserializer::from_str(json);
    error(Batch::<Fast, _>::from_snapshot(memory, json))
}

#[test]
fn invalid_snapshots_are_rejected() {
    let text = serde_json::to_string(&three(false)).unwrap();
    let replaced = |from: &str, to: &str| {
        assert!(text.contains(from), "{from} in {text}");
        text.replacen(from, to, 1)
    };
    for (from, to, message) in [
        (
            r#""of":"batch""#,
            r#""of":"acrobot""#,
            r#"the snapshot must be "batch", version 1, arithmetic "fast", got "acrobot", version 1, arithmetic "fast""#,
        ),
        (
            r#""version":1"#,
            r#""version":2"#,
            r#"the snapshot must be "batch", version 1, arithmetic "fast", got "batch", version 2, arithmetic "fast""#,
        ),
        (
            r#""fast""#,
            r#""micro""#,
            r#"the snapshot must be "batch", version 1, arithmetic "fast", got "batch", version 1, arithmetic "micro""#,
        ),
        (
            r#""limit":500"#,
            r#""limit":0"#,
            "invalid value: integer `0`, expected a nonzero u32",
        ),
        (
            r#""low":-0.1"#,
            r#""low":0.5"#,
            "the lower reset bound must not be above the upper one, got 0.5 and 0.1 rad and rad/s",
        ),
        (
            r#""high":0.1"#,
            r#""high":1e39"#,
            "high must be from -3.4e38 to 3.4e38 rad and rad/s, got 1000000000000000000000000000000000000000",
        ),
        (
            r#""autoreset":"NextStep""#,
            r#""autoreset":"Never""#,
            "unknown variant `Never`, expected one of `NextStep`, `SameStep`, `Disabled`",
        ),
        (
            r#""mass1":1.0"#,
            r#""mass1":-1.0"#,
            "mass1 must be finite and above 0 kg, got -1",
        ),
        // The first member has the parameters of all.
        (
            r#""mass1":1.0"#,
            r#""mass1":2.0"#,
            "a batch must have memory for the parameters of each acrobot",
        ),
        (r#""limit":500,"#, "", "missing field `limit`"),
        (r#""elapsed":0,"#, "", "missing field `elapsed`"),
        (r#""own_params":false,"#, "", "missing field `own_params`"),
    ] {
        let changed = replaced(from, to);
        assert_eq!(load::<Fast>(&changed), message);
        assert_eq!(load_shared(&changed), message);
    }

    let kind = |json: &str| load::<Fast>(json);
    let expected = "expected the settings of a batch and its members";
    assert_eq!(kind("[]"), format!("invalid length 0, {expected}"));
    let acrobot = serde_json::to_string(&Acrobot::<Fast>::new(1)).unwrap();
    assert_eq!(kind(&acrobot), format!("invalid type: map, {expected}"));
    let settings = format!("{}]", text.split_once(",{\"params\"").unwrap().0);
    let empty = "a batch must have at least 1 acrobot, got 0 generators";
    assert_eq!(kind(&settings), empty);
    let none = "members must have 3 elements, got 0";
    assert_eq!(load_shared(&settings), none);
}

/// JSON has neither NaN nor infinity, and TOML has.
#[test]
fn states_that_are_not_finite_are_rejected() {
    let batch = three(false);
    let text = toml::to_string(&Saved { batch }).unwrap();
    let state = text.match_indices("\ntheta1 = ").nth(1).unwrap().0 + 1;
    let (before, after) = text.split_at(state);
    let (_, after) = after.split_once('\n').unwrap();
    for (number, name) in [("nan", "NaN"), ("-inf", "-inf")] {
        let text = format!("{before}theta1 = {number}\n{after}");
        let error = toml::from_str::<Saved>(&text).unwrap_err();
        let message = format!("theta1 must be a finite number of rad, got {name}");
        assert_eq!(error.message(), message);
    }
}

#[test]
fn snapshots_that_do_not_fit_into_the_memory_are_rejected() {
    fn load<const LEN: usize>(batch: &VecBatch<Fast>, own: usize) -> String {
        let memory = (
            [Block::EMPTY; 1],
            [Pcg64::UNSEEDED; LEN],
            vec![LaneParams::default(); own],
        );
        let text = serde_json::to_string(batch).unwrap();
        let json = &mut serde_json::Deserializer::from_str(&text);
        error(Batch::<Fast, _>::from_snapshot(memory, json))
    }
    for own in [0, 1] {
        let batch = &three(own == 1);
        let message = "members must have 4 elements, got 3";
        assert_eq!(load::<4>(batch, own), message);
        let message = "members must have 2 elements, got 3";
        assert_eq!(load::<2>(batch, own), message);
    }
    let message = "a batch must have at least 1 acrobot, got 0 generators";
    assert_eq!(load::<0>(&three(false), 0), message);
    let message = "lane_params must have 1 elements, got 2";
    assert_eq!(load::<3>(&three(true), 2), message);

    let shared = "a batch must have memory for the parameters of each acrobot";
    let mut different = three(true);
    let heavy = Params {
        mass1: 2.0,
        ..Params::DEFAULT
    };
    different.set_params_of(2, heavy).unwrap();
    assert_eq!(load::<3>(&different, 0), shared);
    let mut drawn = three(true);
    let range = params_range(Dynamics::Book);
    drawn.set_params_range(Some(range)).unwrap();
    assert_eq!(load::<3>(&drawn, 0), shared);
}

#[test]
fn invalid_ranges_are_rejected() {
    let mut drawn = three(true);
    let range = params_range(Dynamics::Book);
    drawn.set_params_range(Some(range)).unwrap();
    let value = serde_json::to_value(&drawn).unwrap();
    let changed = |change: fn(&mut Vec<Value>)| {
        let mut value = value.clone();
        change(value[0]["params_range"].as_array_mut().unwrap());
        load::<Fast>(&value.to_string())
    };
    assert_eq!(
        changed(|range| range.reverse()),
        "the lower length1 must not be above the upper one, got 2 and 0.5 m"
    );
    assert_eq!(
        changed(|range| range[1]["dynamics"] = "Nips".into()),
        "dynamics must be the same in both bounds of a range"
    );
    assert_eq!(
        changed(|range| range[0]["dt"] = 0.into()),
        "dt must be finite and above 0 s, got 0"
    );
    assert_eq!(
        changed(|range| range.truncate(1)),
        "params_range must have 2 elements, got 1"
    );
    assert!(changed(|range| range.push(range[0].clone())).contains("invalid length 3"));
}
