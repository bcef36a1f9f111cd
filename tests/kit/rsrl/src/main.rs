//! Answers the kit for ports with `rsrl_domains`, whose Acrobot has Gymnasium's parameters only: `rsrl-port acrobot-kit.jsonl`

use rsrl_domains::{Acrobot, Domain};
use serde_json::{Value, json};

/// Reads C's hexadecimal notation of a double: `-0x1.8p-3`.
fn number(text: &str) -> f64 {
    let (sign, digits) = match text.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, text),
    };
    let (mantissa, exponent) = digits.trim_start_matches("0x").split_once('p').unwrap();
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let bits = u64::from_str_radix(&format!("{whole}{fraction}"), 16).unwrap();
    let exponent = exponent.parse::<i32>().unwrap() - 4 * fraction.len() as i32;
    // Two factors, because a power of 2 may be subnormal where the product is not.
    sign * bits as f64 * 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2)
}

fn main() {
    let path = std::env::args().nth(1).expect("the path of the kit");
    let kit = std::fs::read_to_string(path).expect("a text file");
    let default: Value = json!({"l1": 1.0, "l2": 1.0, "m1": 1.0, "m2": 1.0, "lc1": 0.5, "lc2": 0.5, "I1": 1.0, "I2": 1.0, "g": 9.8,
        "dt": 0.2, "max_vel_1": 4.0 * std::f64::consts::PI, "max_vel_2": 9.0 * std::f64::consts::PI, "torques": [-1.0, 0.0, 1.0]});
    for line in kit.lines() {
        let run: Value = serde_json::from_str(line).unwrap();
        if run["params"] != default || run["equations"] != "book" {
            println!("null");
            continue;
        }
        let (mut states, mut rewards, mut ends) = (Vec::new(), Vec::new(), Vec::new());
        let before = run["states"].as_array().unwrap();
        for (state, action) in before.iter().zip(run["actions"].as_array().unwrap()) {
            let [theta1, theta2, dtheta1, dtheta2] =
                [0, 1, 2, 3].map(|i| number(state[i].as_str().unwrap()));
            let mut acrobot = Acrobot::new(theta1, theta2, dtheta1, dtheta2);
            let (observation, reward) = acrobot.step(&(action.as_u64().unwrap() as usize));
            states.push(observation.state().clone());
            rewards.push(reward);
            ends.push(observation.is_terminal());
        }
        println!(
            "{}",
            json!({"states": states, "rewards": rewards, "terminated": ends})
        );
    }
}
