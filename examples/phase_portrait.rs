//! Plots an episode of the bang-bang policy, torque against θ̇1, as SVG: angles, velocities and energy over
//! time, and θ̇1 over θ1.
//!
//! ```text
//! cargo run --release --example phase_portrait -- --seed 42 --out portrait.svg
//! ```

use std::error::Error;
use std::io::{self, Write};
use std::ops::Range;
use std::path::PathBuf;
use std::process::ExitCode;

use acrobot::numpy::SeedSequence;
use acrobot::{Acrobot, Portable, State, TimeLimit};
use clap::Parser;
use examples_common::{bang_bang, exit, files};
use plotters::prelude::*;

use examples_common::svg::{Area, svg};

/// Plots the angles, velocities and energy of an episode, and its phase portrait, as SVG.
#[derive(Parser)]
struct Options {
    /// Seed of the initial state: a decimal integer of any size.
    #[arg(long, default_value = "42")]
    seed: SeedSequence,
    /// SVG file to write.
    #[arg(long, value_name = "FILE", default_value = "portrait.svg")]
    #[arg(value_parser = files::named("svg"))]
    out: PathBuf,
}

/// The episode at one time.
struct Sample {
    /// s since the initial state.
    time: f64,
    state: State,
    /// J; −19.6 hanging at rest.
    energy: f64,
}

fn main() -> ExitCode {
    exit::run(run)
}

fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let out = &options.out;
    let samples = record(&options.seed);
    files::write(out, svg((1000, 700), |area| plot(area, &samples))?)?;
    let (out, steps) = (out.display(), samples.len() - 1);
    writeln!(io::stdout(), "{out}: {steps} steps")?;
    Ok(())
}

fn record(seed: &SeedSequence) -> Vec<Sample> {
    let mut acrobot = TimeLimit::v1(Acrobot::<Portable>::with_rng(seed.clone().into()));
    let sample = |acrobot: &TimeLimit<Acrobot<Portable>>| Sample {
        time: f64::from(acrobot.elapsed()) * acrobot.params().dt,
        state: acrobot.state(),
        energy: acrobot.inner().pendulum().energy(),
    };
    let mut samples = vec![sample(&acrobot)];
    loop {
        let step = acrobot.step(bang_bang(acrobot.state().dtheta1));
        samples.push(sample(&acrobot));
        if step.done() {
            return samples;
        }
    }
}

type Line<'a> = (&'a str, RGBColor, Vec<(f64, f64)>);

fn plot(area: &Area, samples: &[Sample]) -> Result<(), Box<dyn Error>> {
    const BLUE: RGBColor = RGBColor(0, 114, 178);
    const ORANGE: RGBColor = RGBColor(213, 94, 0);

    let over_time = |of: fn(&Sample) -> f64| {
        samples
            .iter()
            .map(|sample| (sample.time, of(sample)))
            .collect()
    };
    let panels = area.split_evenly((2, 2));
    let [angles, velocities, energy, portrait] = &panels[..] else {
        unreachable!("2 × 2 panels")
    };
    chart(
        angles,
        "angles",
        "time (s)",
        "rad",
        vec![
            ("θ1", BLUE, over_time(|sample| sample.state.theta1)),
            ("θ2", ORANGE, over_time(|sample| sample.state.theta2)),
        ],
    )?;
    chart(
        velocities,
        "velocities",
        "time (s)",
        "rad/s",
        vec![
            ("dθ1/dt", BLUE, over_time(|sample| sample.state.dtheta1)),
            ("dθ2/dt", ORANGE, over_time(|sample| sample.state.dtheta2)),
        ],
    )?;
    chart(
        energy,
        "energy",
        "time (s)",
        "J",
        vec![("energy", BLUE, over_time(|sample| sample.energy))],
    )?;
    let path = samples
        .iter()
        .map(|sample| (sample.state.theta1, sample.state.dtheta1));
    chart(
        portrait,
        "phase portrait",
        "θ1 (rad)",
        "dθ1/dt (rad/s)",
        vec![("θ1", BLUE, path.collect())],
    )
}

/// Draws one panel, with a legend if there are several lines.
fn chart(
    area: &Area,
    title: &str,
    x: &str,
    y: &str,
    lines: Vec<Line>,
) -> Result<(), Box<dyn Error>> {
    let points = || lines.iter().flat_map(|(_, _, points)| points);
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 18))
        .margin(10)
        .x_label_area_size(36)
        .y_label_area_size(48)
        .build_cartesian_2d(
            span(points().map(|point| point.0)),
            span(points().map(|point| point.1)),
        )?;
    chart
        .configure_mesh()
        .x_desc(x)
        .y_desc(y)
        .light_line_style(TRANSPARENT)
        .draw()?;
    let named = lines.len() > 1;
    for (name, color, points) in lines {
        // An angle that wraps draws no line across the panel.
        for piece in points.chunk_by(|(_, from), (_, to)| (to - from).abs() < 5.0) {
            chart.draw_series(LineSeries::new(
                piece.iter().copied(),
                color.stroke_width(2),
            ))?;
        }
        if named {
            let key = move |(x, y)| PathElement::new([(x, y), (x + 16, y)], color.stroke_width(2));
            chart
                .draw_series(LineSeries::new([], color))?
                .label(name)
                .legend(key);
        }
    }
    if named {
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE.mix(0.8))
            .border_style(BLACK)
            .draw()?;
    }
    Ok(())
}

/// From the lowest to the highest value, with a margin, so that equal values have a range too.
fn span(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (low.min(x), high.max(x))
    });
    let margin = 0.05 * (high - low) + 1e-9;
    low - margin..high + margin
}
