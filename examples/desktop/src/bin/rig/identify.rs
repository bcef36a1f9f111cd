//! From a recording to parameters.

use std::f64::consts::TAU;
use std::path::Path;

use acrobot::control::identify::{Sample, calibrate};
use acrobot::control::mpc::Settings;
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
    let rows = read(recording)?;
    let limit = drawn.limit;
    if let Some([.., torque]) = rows.iter().find(|[.., torque]| torque.abs() as f32 > limit) {
        bail!("torques must be in N m and at most the limit of {limit}, got {torque}");
    }
    let samples: Vec<Sample> = rows.into_iter().map(sample).collect();
    let found = calibrate(&samples, drawn.params()?)
        .with_context(|| format!("{} identifies no machine", recording.display()))?;
    let mut rig = drawn.with_params(found.params);
    rig.zeros = [0, 1].map(|i| (found.zeros[i] / turns[i]).round() as i32);
    rig.delay = found.delay as f32;
    println!("{found}The zeros are {:?} counts.", rig.zeros);
    write(out, toml::to_string(&rig)?)?;
    let [rust, c] = code(&rig.settings()?, rig.zeros);
    write(&out.with_extension("rs"), rust)?;
    write(&out.with_extension("h"), c)
}

/// The settings as constants of Rust, which prints a struct as it is written, and of C.
fn code(settings: &Settings, [zero1, zero2]: [i32; 2]) -> [String; 2] {
    let printed = format!("{settings:#?}");
    let rust = format!(
        "use acrobot::Params;\nuse acrobot::control::mpc::Settings;\n\
         use acrobot::physics::Dynamics::Book;\n\n/// Subtract these from the counts.\n\
         pub const ZEROS: [i32; 2] = [{zero1}, {zero2}];\n\
         pub const SETTINGS: Settings = {};\n",
        printed.replace(" inf,", " f32::INFINITY,")
    );
    let mut c = format!(
        "#include <acrobot.h>\n#include <math.h>\n\n/* Subtract these from the counts. */\n\
         static const int32_t zeros[] = {{{zero1}, {zero2}}};\n\
         static const acrobot_settings_t settings = {{\n"
    );
    for line in printed.lines().skip(1).filter(|line| !line.contains("dynamics")) {
        let (indent, field) = line.split_at(line.len() - line.trim_start().len());
        c += &match field.split_once(": ") {
            Some((name, value)) if value.contains('.') => {
                format!("{indent}.{name} = {}\n", value.replace(',', "f,"))
            }
            Some((name, value)) => format!("{indent}.{name} = {value}\n"),
            None => format!("{line}\n"),
        };
    }
    let words = [("Params {", "{"), ("= [", "= {"), ("],", "},"), ("inf,", "INFINITY,")];
    let c = words.iter().fold(c, |c, (rust, word)| c.replace(rust, word));
    [rust, c.trim_end().to_string() + ";\n"]
}
