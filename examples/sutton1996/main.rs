//! Sutton's experiment as published, and this crate's learner in the same simulator. Writes median and
//! quartiles of the steps to the goal in each episode over many runs, as a table, as CSV and as a picture.
//!
//! ```text
//! cargo run --release --example sutton1996 -- --runs 40 --episodes 500 --seed 0 --csv sutton1996.csv --picture sutton1996.svg
//! ```
//!
//! R. S. Sutton, *Generalization in Reinforcement Learning: Successful Examples Using Sparse Coarse
//! Coding*, NIPS 8 (1996); R. S. Sutton and A. G. Barto, *Reinforcement Learning: An Introduction*, 1st
//! edition (1998), 11.3. Both give only one number, in the text: about 75 steps in the end. The table therefore
//! includes the numbers of another replication. Unpublished details follow Sutton's Lisp: the goal ends a decision at
//! any of its time steps. One detail differs: traces below 0.05 are cut, after 29 steps. With 64 steps his learner's
//! last 300 episodes take 84.5 and 81.5 steps with seeds 0 and 1, and with 29 they take 84.5 and 82.5.
//!
//! Every episode begins at rest and has no step limit. Only the learners are random: run `i` has the seed's `i`-th
//! child, for offsets in Sutton's learner and for exploration in this crate's. The CSV is the same for every number of
//! threads.

mod agents;
mod simulator;

use std::error::Error;
use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::ops::Range;
use std::path::PathBuf;
use std::process::ExitCode;

use acrobot::numpy::SeedSequence;
use clap::{Parser, value_parser};
use examples_common::{exit, files};
use indicatif::ProgressBar;
use plotters::coord::combinators::{LogCoord, WithKeyPoints};
use plotters::prelude::*;
use rayon::prelude::*;

use agents::{ours, sutton};
use examples_common::svg::{Area, svg};

/// Repeats Sutton's experiment of 1996, also with this crate's learner.
#[derive(Parser)]
#[command(allow_negative_numbers = true)]
struct Options {
    /// Runs of each learner. Each begins untrained.
    #[arg(long, default_value_t = 40, value_parser = value_parser!(u16).range(1..=10_000))]
    runs: u16,
    /// Episodes per run.
    #[arg(long, default_value_t = 500, value_parser = value_parser!(u16).range(2..=10_000))]
    episodes: u16,
    /// Seed whose children seed the runs: a decimal integer of any size.
    #[arg(long, default_value = "0")]
    seed: SeedSequence,
    /// CSV file to write.
    #[arg(long, value_name = "FILE", default_value = "sutton1996.csv")]
    #[arg(value_parser = files::named("csv"))]
    csv: PathBuf,
    /// SVG file to write: the learning curves.
    #[arg(long, value_name = "FILE", default_value = "sutton1996.svg")]
    #[arg(value_parser = files::named("svg"))]
    picture: PathBuf,
}

fn main() -> ExitCode {
    exit::run(run)
}

fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let progress = ProgressBar::new(2 * u64::from(options.runs));
    let learnt = |learner: fn(_, _) -> Result<_, _>| {
        let run = |run: u16| {
            let steps = learner(options.seed.child(run.into()), options.episodes.into());
            progress.inc(1);
            steps
        };
        let runs = (0..options.runs).into_par_iter().map(run);
        runs.collect::<Result<_, learners::Error>>().map(Experiment)
    };
    let experiments = [learnt(sutton)?, learnt(ours)?];
    progress.finish_and_clear();

    let curves = experiments.each_ref().map(Experiment::curve);
    files::write(&options.csv, rows(&curves))?;
    let picture = svg((900, 600), |area| draw(area, options, &curves))?;
    files::write(&options.picture, picture)?;
    write!(io::stdout(), "{}", table(&experiments, &curves))?;
    Ok(())
}

/// Steps to the goal of every run and episode.
struct Experiment(Vec<Vec<u32>>);

impl Experiment {
    /// The quartiles of each episode over the runs. The second is the median.
    fn curve(&self) -> Vec<[f64; 3]> {
        let of = |episode| {
            let mut steps: Vec<u32> = self.0.iter().map(|run| run[episode]).collect();
            steps.sort_unstable();
            [0.25, 0.5, 0.75].map(|share| quantile(&steps, share))
        };
        (0..self.0[0].len()).map(of).collect()
    }

    /// The mean steps from one episode to another: mean and standard deviation over the runs. None if the runs end
    /// before.
    fn block(&self, [first, last]: [usize; 2]) -> Option<[f64; 2]> {
        let mean_of = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let means = self.0.iter().map(|run| {
            let steps = run.get(first - 1..last)?;
            Some(f64::from(steps.iter().sum::<u32>()) / steps.len() as f64)
        });
        let means: Vec<f64> = means.collect::<Option<_>>()?;
        let mean = mean_of(&means);
        let squares: Vec<f64> = means.iter().map(|x| (x - mean).powi(2)).collect();
        Some([mean, mean_of(&squares).sqrt()])
    }
}

/// A quantile, interpolated between two values as NumPy does.
fn quantile(sorted: &[u32], share: f64) -> f64 {
    let place = share * (sorted.len() - 1) as f64;
    let [below, above] = [place.floor(), place.ceil()].map(|i| f64::from(sorted[i as usize]));
    below + (above - below) * place.fract()
}

const NAMES: [&str; 2] = ["Sutton's learner", "this crate's learner"];

/// The episodes whose median is printed, and the medians of Sutton's learner in another replication of 20 runs.
const MEDIANS: [(usize, f64); 7] = [
    (1, 602.0),
    (5, 338.0),
    (10, 219.0),
    (20, 116.0),
    (50, 85.5),
    (100, 82.5),
    (500, 81.5),
];

/// The blocks of episodes whose mean is printed, and the means in the same replication.
const BLOCKS: [([usize; 2], f64); 5] = [
    ([1, 10], 372.0),
    ([11, 50], 123.0),
    ([51, 100], 87.1),
    ([101, 200], 82.8),
    ([201, 500], 82.2),
];

const REPLICATION: &str = "another replication";

/// The printed table.
fn table(experiments: &[Experiment; 2], curves: &[Vec<[f64; 3]>; 2]) -> String {
    let heads = MEDIANS.map(|(episode, _)| episode.to_string());
    let mut text = line("median steps in episode", &heads);
    for (name, curve) in NAMES.iter().zip(curves) {
        let median = |(episode, _): (usize, f64)| Some(curve.get(episode - 1)?[1]);
        text += &line(name, &MEDIANS.map(|row| cell(median(row))));
    }
    text += &line(REPLICATION, &MEDIANS.map(|(_, steps)| cell(Some(steps))));

    let heads = BLOCKS.map(|([first, last], _)| format!("{first}–{last}"));
    text += &format!("\n{}", line("mean steps in episodes", &heads));
    for (name, experiment) in NAMES.iter().zip(experiments) {
        let mean = |(block, _)| match experiment.block(block) {
            Some([mean, sd]) => format!("{mean:.1} ± {sd:.1}"),
            None => cell(None),
        };
        text += &line(name, &BLOCKS.map(mean));
    }
    text + &line(REPLICATION, &BLOCKS.map(|(_, steps)| cell(Some(steps))))
}

fn line(name: &str, cells: &[String]) -> String {
    let width = if cells.len() == MEDIANS.len() { 7 } else { 14 };
    let cells: String = cells.iter().map(|cell| format!("{cell:>width$}")).collect();
    format!("{name:<24}{cells}\n")
}

fn cell(steps: Option<f64>) -> String {
    steps.map_or("–".into(), |steps| format!("{steps:.1}"))
}

/// The CSV.
fn rows(curves: &[Vec<[f64; 3]>; 2]) -> String {
    let mut text = "episode,\
        sutton_lower_quartile,sutton_median,sutton_upper_quartile,\
        ours_lower_quartile,ours_median,ours_upper_quartile\n"
        .to_owned();
    let [sutton, ours] = curves;
    for (([a, b, c], [d, e, f]), episode) in sutton.iter().zip(ours).zip(1..) {
        writeln!(text, "{episode},{a},{b},{c},{d},{e},{f}").expect("a String grows");
    }
    text
}

/// Draws the learning curves: medians in bands from quartile to quartile.
fn draw(area: &Area, options: &Options, curves: &[Vec<[f64; 3]>; 2]) -> Result<(), Box<dyn Error>> {
    const BLUE: RGBColor = RGBColor(0, 114, 178);
    const ORANGE: RGBColor = RGBColor(213, 94, 0);
    const LABEL: (&str, i32) = ("sans-serif", 15);
    const NAME: (&str, i32) = ("sans-serif", 18);

    let caption = format!(
        "Sutton's experiment: median and quartiles of {} runs",
        options.runs
    );
    let all = || curves.iter().flatten().flatten();
    let least = all().copied().fold(f64::INFINITY, f64::min);
    let most = all().copied().fold(0.0, f64::max);
    let mut chart = ChartBuilder::on(area)
        .caption(caption, ("sans-serif", 24))
        .margin(14)
        .x_label_area_size(44)
        .y_label_area_size(60)
        .build_cartesian_2d(
            logarithmic(1.0..f64::from(options.episodes), &[1.0, 2.0, 5.0]),
            logarithmic(
                0.9 * least..1.1 * most,
                &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0],
            ),
        )?;
    chart
        .configure_mesh()
        .label_style(LABEL)
        .axis_desc_style(NAME)
        .x_desc("episode")
        .y_desc("steps to the goal, of 0.2 s each")
        .light_line_style(TRANSPARENT)
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| format!("{y:.0}"))
        .draw()?;
    for ((name, color), curve) in NAMES.iter().zip([BLUE, ORANGE]).zip(curves) {
        let line = |quartile: usize| {
            let point = move |(steps, episode): (&[f64; 3], u16)| (episode.into(), steps[quartile]);
            curve.iter().zip(1..).map(point)
        };
        let mut band: Vec<(f64, f64)> = line(0).collect();
        band.extend(line(2).collect::<Vec<_>>().iter().rev());
        chart.draw_series([Polygon::new(band, color.mix(0.2))])?;
        let key = move |(x, y)| PathElement::new([(x, y), (x + 16, y)], color.stroke_width(2));
        chart
            .draw_series(LineSeries::new(line(1), color.stroke_width(2)))?
            .label(*name)
            .legend(key);
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .label_font(NAME)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK)
        .draw()?;
    Ok(())
}

/// An axis with labels at these multiples of each power of ten.
fn logarithmic(range: Range<f64>, multiples: &[f64]) -> WithKeyPoints<LogCoord<f64>> {
    let labels = (0..9).flat_map(|power| multiples.iter().map(move |x| x * 10_f64.powi(power)));
    let labels = labels
        .filter(|x| (range.start..=range.end).contains(x))
        .collect();
    range.log_scale().with_key_points(labels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_are_interpolated_and_blocks_are_means_of_runs() {
        let runs = vec![vec![40, 4], vec![10, 8], vec![20, 6], vec![30, 6]];
        let experiment = Experiment(runs);
        assert_eq!(experiment.curve(), [[17.5, 25.0, 32.5], [5.5, 6.0, 6.5]]);
        // The means of the runs are 22, 9, 13 and 18.
        let [mean, deviation] = experiment.block([1, 2]).unwrap();
        assert_eq!((mean, deviation), (15.5, 24.25_f64.sqrt()));
        assert_eq!(experiment.block([2, 3]), None);
    }
}
