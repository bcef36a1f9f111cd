//! A loaded batch continues to the same bits, with any memory and any width. An invalid snapshot is
//! rejected with the reason.

use std::fmt::Debug;

use acrobot::batch::{Autoreset, Batch, Block, LaneParams, VecBatch};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::Dynamics;
use acrobot::task::{Draws, Gymnasium};
use acrobot::{Acrobot, Action, Fast, Params};
use common::draws;
use common::twins::{MODES, Twins};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

const LEN: usize = 35;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Shared,
    Own,
    Drawn,
}

/// A batch in the middle of episodes, of which some have ended.
fn running(kind: Kind, autoreset: Autoreset, noise: f32) -> Twins<Fast> {
    let mut rng = Pcg64::new(5);
    let nips = Params { dynamics: Dynamics::Nips, ..Params::DEFAULT };
    let mut draw = || Params { torque_noise: noise, ..draws::<Fast>().draw(&nips, &mut rng) };
    let mut twins = Twins::new(LEN, kind != Kind::Shared, autoreset);
    let limit = 150.try_into().unwrap();
    twins.batch.set_max_steps(limit);
    twins.alone.iter_mut().for_each(|alone| alone.set_max_steps(limit));
    match kind {
        Kind::Shared => twins.set_params(draw()),
        Kind::Own => {
            for (i, alone) in twins.alone.iter_mut().enumerate() {
                let drawn = draw();
                let params = if i == 0 { Params { gravity: -0.0, ..drawn } } else { drawn };
                twins.batch.set_params_of(i, params).unwrap();
                alone.set_params(params).unwrap();
            }
        }
        Kind::Drawn => twins.batch.set_draws(draws::<Fast>()).unwrap(),
    }
    twins.set_bounds(-0.5, 0.25);
    twins.swing(200);
    if autoreset == Autoreset::NextStep {
        while !twins.ended.contains(&true) {
            twins.swing(1);
        }
    }
    // Half of a draw is left over.
    Action::sample(&mut twins.batch.generators_mut()[0]);
    Action::sample(twins.alone[0].inner_mut().rng_mut());
    twins
}

/// Every kind of parameters in every mode, with and without noise.
fn every_batch() -> impl Iterator<Item = Twins<Fast>> {
    let kinds = [Kind::Shared, Kind::Own, Kind::Drawn].into_iter();
    let settings = kinds.flat_map(|kind| MODES.map(|autoreset| (kind, autoreset)));
    settings.flat_map(|(kind, autoreset)| [0.0, 0.5].map(|noise| running(kind, autoreset, noise)))
}

/// Continues beside the single acrobots that the stored batch was beside.
fn assert_continues<const N: usize>(stored: &Twins<Fast>, loaded: VecBatch<Fast, Gymnasium, N>) {
    assert_eq!(loaded.draws(), stored.batch.draws());
    assert_eq!(loaded.reset_bounds(), stored.batch.reset_bounds());
    assert_eq!(loaded.max_steps(), stored.batch.max_steps());
    assert_eq!(loaded.autoreset(), stored.batch.autoreset());
    let mut twins =
        Twins { batch: loaded, alone: stored.alone.clone(), ended: stored.ended.clone() };
    twins.assert_equal();
    twins.swing(300);
}

/// The snapshot depends neither on the memory nor on the width.
#[test]
fn loaded_batches_continue_to_the_same_bits_and_are_saved_to_the_same_bytes() {
    for stored in every_batch() {
        let json = serde_json::to_string(&stored.batch).unwrap();
        assert_continues::<16>(&stored, serde_json::from_str(&json).unwrap());
        let bytes = postcard::to_stdvec(&stored.batch).unwrap();
        let loaded: VecBatch<Fast, Gymnasium, 3> = postcard::from_bytes(&bytes).unwrap();
        assert_eq!(postcard::to_stdvec(&loaded).unwrap(), bytes);
        assert_continues(&stored, loaded);
        let mut deserializer = postcard::Deserializer::from_bytes(&bytes);
        let own = if stored.batch.params_of(0) == stored.batch.params_of(1) { 0 } else { LEN };
        let own = vec![LaneParams::default(); own];
        let memory = ([Block::EMPTY; LEN], [Pcg64::UNSEEDED; LEN], own, Draws::NONE);
        let narrow =
            Batch::<Fast, _, Gymnasium, 1>::from_snapshot(memory, &mut deserializer).unwrap();
        assert_eq!(postcard::to_stdvec(&narrow).unwrap(), bytes);
    }
}

/// Fields in another order and unknown ones change nothing, as in the snapshot of an acrobot.
#[test]
fn fields_have_any_order_and_unknown_ones_are_ignored() {
    fn add(value: &mut Value) {
        match value {
            // The name of a draw, and not a field.
            Value::Object(fields) if fields.contains_key("Uniform") => {}
            Value::Object(fields) => {
                fields.values_mut().for_each(add);
                fields.insert("an unknown field".into(), "new".into());
            }
            Value::Array(values) => values.iter_mut().for_each(add),
            _ => {}
        }
    }
    fn check<T: Serialize + DeserializeOwned>(saved: &T) {
        let mut value = serde_json::to_value(saved).unwrap();
        assert!(!value.to_string().contains("{\"snapshot\""), "not sorted");
        add(&mut value);
        let loaded: T = serde_json::from_str(&value.to_string()).unwrap();
        let [loaded, saved] = [&loaded, saved].map(|x| serde_json::to_string(x).unwrap());
        assert_eq!(loaded, saved);
    }
    check(&Acrobot::<Fast>::new(3));
    for kind in [Kind::Shared, Kind::Own, Kind::Drawn] {
        check(&running(kind, Autoreset::NextStep, 0.5).batch);
    }
}

fn three(own_params: bool) -> VecBatch<Fast> {
    let mut batch = VecBatch::new(SeedSequence::new(1), 3).unwrap();
    if own_params {
        batch.own_params().unwrap();
    }
    batch
}

/// Three, whose resets draw parameters.
fn three_drawn() -> VecBatch<Fast> {
    let mut batch = three(true);
    batch.set_draws(draws::<Fast>()).unwrap();
    batch
}

/// The error of loading JSON, without the position.
fn error<T: Debug>(loaded: Result<T, serde_json::Error>) -> String {
    let error = loaded.unwrap_err().to_string();
    error.split(" at line").next().unwrap().to_owned()
}

fn load(json: &str) -> String {
    error(serde_json::from_str::<VecBatch<Fast>>(json))
}

/// Loads into memory for `LEN` acrobots in one block, with this many elements of parameters.
fn load_into<const LEN: usize>(json: &str, own: usize) -> String {
    let own = vec![LaneParams::default(); own];
    let memory = ([Block::EMPTY; 1], [Pcg64::UNSEEDED; LEN], own, Draws::NONE);
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
            "the snapshot must be \"batch\", version 4, task \"gymnasium\", arithmetic \"fast\", \
                friction false, got \"acrobot\", version 4, task \"gymnasium\", \
                arithmetic \"fast\", friction false",
        ),
        (
            r#""max_steps":500"#,
            r#""max_steps":0"#,
            "invalid value: integer `0`, expected a nonzero u32",
        ),
        (r#""low":-0.1"#, r#""low":0.5"#, "low must be at most high, in rad and rad/s, got 0.5"),
        (
            r#""autoreset":"NextStep""#,
            r#""autoreset":"Never""#,
            "unknown variant `Never`, expected one of `NextStep`, `SameStep`, `Disabled`",
        ),
        (r#""mass1":1.0"#, r#""mass1":-1.0"#, "mass1 must be finite and above 0 kg, got -1"),
        // The first member has the parameters of all.
        (
            r#""mass1":1.0"#,
            r#""mass1":2.0"#,
            "a batch must have memory for the parameters of each acrobot",
        ),
    ] {
        let changed = replaced(from, to);
        assert_eq!(load(&changed), message);
        assert_eq!(load_into::<3>(&changed, 0), message);
    }

    let expected = "expected the settings of a batch and its members";
    assert_eq!(load("[]"), format!("invalid length 0, {expected}"));
    let acrobot = serde_json::to_string(&Acrobot::<Fast>::new(1)).unwrap();
    assert_eq!(load(&acrobot), format!("invalid type: map, {expected}"));
    let settings = format!("{}]", text.split_once(",{\"params\"").unwrap().0);
    assert_eq!(load(&settings), "a batch must have at least 1 acrobot, got 0 generators");
    assert_eq!(load_into::<3>(&settings, 0), "members must have 3 elements, got 0");
}

#[test]
fn snapshots_that_do_not_fit_into_the_memory_are_rejected() {
    let [shared, own, drawn] = [three(false), three(true), three_drawn()]
        .map(|batch| serde_json::to_string(&batch).unwrap());
    for (json, elements) in [(&shared, 0), (&own, 1)] {
        assert_eq!(load_into::<4>(json, elements), "members must have 4 elements, got 3");
        assert_eq!(load_into::<2>(json, elements), "members must have 2 elements, got 3");
    }
    let message = "a batch must have at least 1 acrobot, got 0 generators";
    assert_eq!(load_into::<0>(&shared, 0), message);
    assert_eq!(load_into::<3>(&own, 2), "lane_params must have 1 elements, got 2");
    let different = own.replacen("\"mass2\":1.0", "\"mass2\":2.0", 1);
    for json in [different, drawn] {
        let message = "a batch must have memory for the parameters of each acrobot";
        assert_eq!(load_into::<3>(&json, 0), message);
    }
}

#[test]
fn invalid_draws_are_rejected() {
    let value = serde_json::to_value(three_drawn()).unwrap();
    let changed = |draw: Value| {
        let mut value = value.clone();
        value[0]["draws"]["length1"] = draw;
        load(&value.to_string())
    };
    assert_eq!(
        changed(json!({ "Uniform": { "low": 2.0, "high": 0.5 } })),
        "length1 must be drawn from a low of at most its high, in m, got 2"
    );
    assert_eq!(
        changed(json!({ "Uniform": { "low": 0.0, "high": 0.5 } })),
        "length1 must be finite and above 0 m, got 0"
    );
    assert!(changed(json!("Sometimes")).starts_with("unknown variant `Sometimes`"));
}
