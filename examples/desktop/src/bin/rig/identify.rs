//! From a recording to parameters.

use std::f64::consts::TAU;
use std::path::Path;

use acrobot::control::identify::{Fit, Regression, Sample};
use acrobot::{Error, Params};
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

/// The fit, and both counts of hanging: those with the least error of `moment1`.
fn fit(rows: &[Row], counts: [i32; 2], params: &Params) -> Result<(Fit, [i32; 2]), Error> {
    let solve = |zeros: [i32; 2]| {
        let angle = |row: &Row, i: usize| (row[i] - f64::from(zeros[i])) / f64::from(counts[i]);
        let sample = |row: &Row| Sample {
            angles: [angle(row, 0) * TAU, angle(row, 1) * TAU],
            torques: [0.0, row[2]],
        };
        let samples: Vec<Sample> = rows.iter().map(sample).collect();
        let mut regression = Regression::EMPTY;
        // Velocities from 5 angles, windows of half a second.
        let window = (0.5 / params.dt) as usize;
        regression.add(&samples, params.dt, params.gravity, 2, window)?;
        Ok::<_, Error>(regression.fit())
    };
    let (mut zeros, mut found) = ([0; 2], solve([0; 2])?);
    for step in [16, 8, 4, 2, 1] {
        for (joint, sign) in [(0, 1), (0, -1), (1, 1), (1, -1)].repeat(4) {
            let mut moved = zeros;
            moved[joint] += sign * step;
            let other = solve(moved)?;
            if other.std_errors[3] < found.std_errors[3] {
                (zeros, found) = (moved, other);
            }
        }
    }
    Ok((found, zeros))
}

/// Prints the fit, and writes the parameters for `run`, and as Rust and C.
pub fn identify(drawn: Rig, recording: &Path, out: &Path) -> anyhow::Result<()> {
    let (rows, given) = (read(recording)?, drawn.params()?);
    let (fit, zeros) = fit(&rows, drawn.counts, &given)?;
    for ((name, value), error) in Fit::NAMES.iter().zip(fit.values).zip(fit.std_errors) {
        println!("{name:8} {value:9.5} ± {error:.5}");
    }
    println!("zeros    {zeros:?} counts");
    let params = fit.params(given).context("shake it more: this recording fits no machine")?;
    let mut rig = drawn.with_params(params);
    rig.zeros = zeros;
    write(out, toml::to_string(&rig)?)?;
    write(&out.with_extension("rs"), code(&params, "Params {", false, "    ..Params::DEFAULT\n}"))?;
    let declaration = "static const acrobot_params_t params = {";
    write(&out.with_extension("h"), code(&params, declaration, true, "};"))
}

/// A constant of Rust or C.
fn code(params: &Params, head: &str, is_c: bool, end: &str) -> String {
    let field = |(name, value): (&str, f64)| match value {
        _ if name.contains('[') => String::new(), // torques of actions
        f64::INFINITY if is_c => format!("    .{name} = {:?}f,\n", f32::MAX),
        f64::INFINITY => format!("    {name}: f64::INFINITY,\n"),
        _ if is_c => format!("    .{name} = {:?}f,\n", value as f32),
        _ => format!("    {name}: {value:?},\n"),
    };
    format!("{head}\n{}{end}\n", params.numbers().into_iter().map(field).collect::<String>())
}
