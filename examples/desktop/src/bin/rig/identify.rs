//! From a recording to parameters.

use std::f64::consts::TAU;
use std::path::Path;

use acrobot::Params;
use acrobot::control::identify::{Calibration, Fit, Sample, calibrate};
use anyhow::{Context, bail};
use desktop::write;

use crate::machine::Rig;

/// A line of a recording: both counts, and the torque from then on, N m.
pub type Row = [f64; 3];

pub const HEAD: &str = "count1,count2,torque";

pub fn read(path: &Path) -> anyhow::Result<Vec<Row>> {
    let text =
        std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    let mut lines = text.lines();
    if lines.next() != Some(HEAD) {
        bail!("{} must begin with the line {HEAD}", path.display());
    }
    let row = |(i, line): (usize, &str)| {
        let numbers: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
        let row = numbers.ok().and_then(|numbers| Row::try_from(numbers).ok());
        row.with_context(|| format!("{}:{}: not three numbers: {line}", path.display(), i + 2))
    };
    lines.enumerate().map(row).collect()
}

/// Prints what a recording tells, and writes the machine for `run`, and its settings as Rust and C.
pub fn identify(drawn: Rig, recording: &Path, out: &Path) -> anyhow::Result<()> {
    let turns = drawn.counts.map(|turn| TAU / f64::from(turn));
    let sample = |[count1, count2, torque]: Row| Sample {
        angles: [count1 * turns[0], count2 * turns[1]],
        torques: [0.0, torque],
    };
    let samples: Vec<Sample> = read(recording)?.into_iter().map(sample).collect();
    let Calibration { params, fit, zeros, delay, prediction_error } =
        calibrate(&samples, drawn.params()?)
            .with_context(|| format!("{} identifies no machine", recording.display()))?;
    let mut rig = drawn.with_params(params);
    rig.zeros = [0, 1].map(|i| (zeros[i] / turns[i]).round() as i32);
    rig.delay = delay as f32;
    for ((name, value), error) in Fit::NAMES.iter().zip(fit.values).zip(fit.std_errors) {
        println!("{name:8} {value:9.5} ± {error:.5}");
    }
    println!("zeros    {:?} counts\ndelay    {delay:9.5} s", rig.zeros);
    println!("predicts {prediction_error:9.5} rad wrong");
    write(out, toml::to_string(&rig)?)?;
    write(&out.with_extension("rs"), code(&rig, &params, false))?;
    write(&out.with_extension("h"), code(&rig, &params, true))
}

/// The settings as constants of Rust or C.
fn code(rig: &Rig, params: &Params, is_c: bool) -> String {
    let number = |value: f32| match value {
        f32::INFINITY if is_c => "INFINITY".to_string(),
        f32::INFINITY => "f32::INFINITY".to_string(),
        _ if is_c => format!("{value:?}f"),
        _ => format!("{value:?}"),
    };
    let fields: String = (params.numbers().into_iter())
        .filter(|(name, _)| !name.contains('[')) // torques of actions
        .map(|(name, value)| match number(value as f32) {
            value if is_c => format!("        .{name} = {value},\n"),
            value => format!("        {name}: {value},\n"),
        })
        .collect();
    let Rig { counts: [turn1, turn2], zeros: [zero1, zero2], .. } = rig;
    let [limit, delay, plan_timeout] = [rig.limit, rig.delay, rig.plan_timeout].map(number);
    if is_c {
        format!(
            "#include <acrobot.h>
#include <math.h>

/* Subtract these from the counts. */
static const int32_t zeros[] = {{{zero1}, {zero2}}};
static const acrobot_settings_t settings = {{
    .params = {{
{fields}    }},
    .limit = {limit},
    .counts = {{{turn1}, {turn2}}},
    .delay = {delay},
    .plan_timeout = {plan_timeout},
}};
"
        )
    } else {
        format!(
            "use acrobot::Params;
use acrobot::control::mpc::Settings;

/// Subtract these from the counts.
pub const ZEROS: [i32; 2] = [{zero1}, {zero2}];
pub const SETTINGS: Settings = Settings {{
    params: Params {{
{fields}        ..Params::DEFAULT
    }},
    limit: {limit},
    counts: [{turn1}, {turn2}],
    delay: {delay},
    plan_timeout: {plan_timeout},
}};
"
        )
    }
}
