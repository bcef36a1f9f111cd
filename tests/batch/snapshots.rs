//! A snapshot of a batch loads into any memory of the right size. An invalid one is rejected with
//! the reason. `cargo test -p properties` continues from snapshots to the same bits.

use std::fmt::Debug;

use acrobot::batch::{Batch, BatchMemory, Block, LaneParams, OwnParams, VecBatch};
use acrobot::numpy::Pcg64;
use acrobot::task::Gymnasium;
use acrobot::{Acrobot, Fast};
use common::draws;
use serde_json::json;

fn three(own_params: bool) -> VecBatch<Fast> {
    let mut batch = VecBatch::new(1, 3).unwrap();
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
    let (blocks, generators) = ([Block::EMPTY; 1], [Pcg64::UNSEEDED; LEN]);
    let own = OwnParams::new(vec![LaneParams::default(); own]);
    let memory = BatchMemory { blocks, generators, own };
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
            "the snapshot must be \"batch\", version 6, task \"gymnasium\", arithmetic \"fast\", \
                got \"acrobot\", version 6, task \"gymnasium\", arithmetic \"fast\"",
        ),
        (r#""low":-0.1"#, r#""low":0.5"#, "low must be at most high, in rad and rad/s, got 0.5"),
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
    let mut drawn = serde_json::to_value(three_drawn()).unwrap();
    drawn[0]["draws"]["length1"] = json!({ "Uniform": { "low": 0.0, "high": 0.5 } });
    let message = "length1 must be finite and above 0 m, got 0";
    assert_eq!(load(&drawn.to_string()), message);
}

/// The snapshot depends neither on the memory nor on the width.
#[test]
fn snapshots_load_into_other_memory() {
    for (stored, own) in [(three(false), 0), (three_drawn(), 3)] {
        let bytes = postcard::to_stdvec(&stored).unwrap();
        let (blocks, generators) = ([Block::EMPTY; 3], [Pcg64::UNSEEDED; 3]);
        let own = OwnParams::new(vec![LaneParams::default(); own]);
        let memory = BatchMemory { blocks, generators, own };
        let from = &mut postcard::Deserializer::from_bytes(&bytes);
        let narrow = Batch::<Fast, _, Gymnasium, 1>::from_snapshot(memory, from).unwrap();
        assert_eq!(postcard::to_stdvec(&narrow).unwrap(), bytes);
    }
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
