//! Promise 3: calls that are rejected, and their messages. `data/rejections.jsonl` has them for the
//! tests of the packages for C, Python and JavaScript. `UPDATE_SNAPSHOTS` writes it again.

use std::fmt::Write as _;

use acrobot::arithmetic::Damped;
use acrobot::physics::Pendulum;
use acrobot::task::{Draw, Draws, ResetBounds};
use acrobot::{Acrobot, Action, Error, Fast, Params, State};
use serde_json::{Value, json};

type Tested = Acrobot<Damped<Fast>>;

const VALUES: [f32; 5] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, -1.0];

/// A number of a call. JSON has no other way to write those that are not finite.
fn number(x: impl Into<f64>) -> Value {
    let x = x.into();
    if x.is_finite() { json!(x) } else { json!(x.to_string()) }
}

/// Adds a call that is rejected, and whose error names `name` and ends with the value.
fn add(lines: &mut String, call: Value, name: &str, result: Result<(), Error>) {
    let Err(error) = result else {
        return;
    };
    let message = error.to_string();
    assert!(message.starts_with(&format!("{name} must be ")), "{message}");
    assert_eq!(error.named("it").to_string(), message.replacen(name, "it", 1));
    let mut row = call;
    row["message"] = json!(message);
    writeln!(lines, "{row}").unwrap();
}

#[test]
fn rejected_calls_change_nothing_and_name_the_value_and_the_rule() {
    let new = Tested::new(42);
    let mut acrobot = new.clone();
    let mut lines = String::new();
    let params = Params::<f32>::DEFAULT;
    for (i, (name, _)) in params.numbers().into_iter().enumerate() {
        for value in VALUES {
            let mut params = params;
            *params.numbers_mut()[i] = value;
            let set = acrobot.set_params(params);
            let made = Pendulum::<Damped<Fast>>::new(params, State::HANGING);
            assert_eq!(set.is_ok(), made.is_ok());
            if set.is_ok() {
                acrobot = new.clone();
            }
            add(&mut lines, json!({ "call": "params", "set": { name: number(value) } }), name, set);
            assert_eq!(acrobot, new);
        }
    }
    for (inertia, center, massless) in [
        ("inertia1", "center_of_mass1", Params { inertia1: 0.0, center_of_mass1: 0.0, ..params }),
        ("inertia2", "center_of_mass2", Params { inertia2: 0.0, center_of_mass2: 0.0, ..params }),
    ] {
        let call = json!({ "call": "params", "set": { inertia: 0.0, center: 0.0 } });
        add(&mut lines, call, inertia, acrobot.set_params(massless));
    }
    for (i, name) in ["theta1", "theta2", "dtheta1", "dtheta2"].into_iter().enumerate() {
        for value in VALUES.into_iter().filter(|value| !value.is_finite()) {
            let mut state = [0.0; 4];
            state[i] = value;
            let call = json!({ "call": "state", "set": { name: number(value) } });
            add(&mut lines, call, name, acrobot.set_state(state.into()));
        }
    }
    for value in VALUES.into_iter().filter(|value| !value.is_finite()) {
        let call = json!({ "call": "torque", "value": number(value) });
        add(&mut lines, call, "torque", acrobot.step_torque(value).map(drop));
    }
    for value in [3, 255] {
        let call = json!({ "call": "action", "value": value });
        add(&mut lines, call, "action", Action::try_from(value).map(drop));
    }
    for (name, low, high) in [
        ("low", f64::NAN, 0.0),
        ("low", f64::NEG_INFINITY, 0.0),
        ("low", 0.5, -0.5),
        ("high", 0.0, f64::NAN),
        ("high", 0.0, f64::INFINITY),
    ] {
        let set = json!({ "low": number(low), "high": number(high) });
        let call = json!({ "call": "bounds", "set": set });
        add(&mut lines, call, name, ResetBounds::new(low, high).map(drop));
    }
    let (low, high) = (0.5, 2.0);
    for mass2 in [
        Draw::Uniform { low: high, high: low },
        Draw::Uniform { low: f32::NAN, high },
        Draw::Uniform { low, high: f32::INFINITY },
        Draw::Uniform { low: 0.0, high },
        Draw::Uniform { low: -1.0, high },
        Draw::LogUniform { low: 0.0, high },
        Draw::LogUniform { low: high, high: low },
        Draw::Normal { mean: 3.0, std: 1.0, low, high },
        Draw::Normal { mean: f32::NAN, std: 1.0, low, high },
        Draw::Normal { mean: 1.0, std: 0.0, low, high },
        Draw::Normal { mean: 1.0, std: f32::INFINITY, low, high },
    ] {
        let draws = Draws::new(Params { mass2, ..Draws::FIXED });
        let draw = match mass2 {
            Draw::LogUniform { low, high } => json!({ "LogUniform": [number(low), number(high)] }),
            Draw::Normal { mean, std, low, high } => {
                let numbers = [mean, std, low, high].map(number);
                json!({ "Normal": numbers })
            }
            Draw::Uniform { low, high } => json!({ "Uniform": [number(low), number(high)] }),
            _ => unreachable!(),
        };
        let call = json!({ "call": "draw", "set": { "mass2": draw } });
        let set = draws.and_then(|draws| acrobot.draw_params(&draws));
        assert!(set.is_err());
        add(&mut lines, call, "mass2", set);
    }
    assert_eq!(acrobot, new);
    common::assert_snapshot("rejections.jsonl", &lines);
}
