//! A million episodes of the bang-bang policy, torque against θ̇1, over a grid of link masses and torques.
//! Writes each cell's steps to the goal as CSV, and their means as a heat map.
//!
//! ```text
//! cargo run --release --example sweep -- --episodes 1000000 --seed 0 --csv sweep.csv --picture sweep.svg
//! ```
//!
//! Each of the two links has the mass; lengths and moments of inertia are Gymnasium's. Every cell plays the same
//! initial states: acrobot `i` plays one episode with the seed's `i`-th child. The CSV is the same on every
//! machine and for every number of threads.
//!
//! An episode that does not reach the goal within 500 steps counts in `episodes` but not in the mean. So where
//! `share`, the part that reaches the goal, is below 1, the mean is too low.
//!
//! Result: from 0.5 kg on, the steps grow roughly with mass^0.7 and 1/torque. The energy to gain grows with the
//! mass, the gain of a swing grows with the torque, and heavier links swing faster because their moments of inertia
//! stay. Links of 0.1 kg reach the goal within ten steps of 2 N m.
//!
//! Heavy links that fail lack energy after 500 steps. Light ones have too much: link 1 rotates about its joint with
//! link 2 hanging from it, the policy adds energy to that, and the tip never reaches the target height.

use std::error::Error;
use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::ops::Range;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use acrobot::batch::VecBatch;
use acrobot::numpy::SeedSequence;
use acrobot::{Action, Fast, Params};
use clap::Parser;
use examples_common::{bang_bang, exit, files};
use indicatif::ProgressBar;
use plotters::prelude::*;
use rayon::prelude::*;

use examples_common::heat_map::{LABEL, NAME, color, draw_bar};
use examples_common::svg::{Area, svg};

/// Sweeps link masses and torques, and writes the steps to the goal as CSV and as a picture.
#[derive(Parser)]
#[command(allow_negative_numbers = true)]
struct Options {
    /// Episodes in all, the same number in every cell of the grid.
    #[arg(long, default_value_t = 1_000_000)]
    episodes: usize,
    /// Seed whose children seed the episodes: a decimal integer of any size.
    #[arg(long, default_value = "0")]
    seed: SeedSequence,
    /// Masses of each link, kg.
    #[arg(long, value_name = "KG", value_delimiter = ',', default_value = GRID)]
    #[arg(value_parser = |text: &str| positive(text, "kg"))]
    masses: Vec<f32>,
    /// Torques of the motor, N m.
    #[arg(long, value_name = "N_M", value_delimiter = ',', default_value = GRID)]
    #[arg(value_parser = |text: &str| positive(text, "N m"))]
    torques: Vec<f32>,
    /// CSV file to write.
    #[arg(long, value_name = "FILE", default_value = "sweep.csv")]
    #[arg(value_parser = files::named("csv"))]
    csv: PathBuf,
    /// SVG file to write: the heat map.
    #[arg(long, value_name = "FILE", default_value = "sweep.svg")]
    #[arg(value_parser = files::named("svg"))]
    picture: PathBuf,
}

/// 20 × 20 cells, with Gymnasium's 1 kg and 1 N m among them.
const GRID: &str = "0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9,1,1.1,1.2,1.3,1.4,1.5,1.6,1.7,1.8,1.9,2";

fn positive(text: &str, unit: &str) -> Result<f32, String> {
    match text.trim().parse() {
        Ok(value) if value > 0.0 && f32::is_finite(value) => Ok(value),
        _ => Err(format!("must be finite and above 0 {unit} in f32")),
    }
}

/// The results of one mass and one torque.
struct Cell {
    params: Params<f32>,
    episodes: usize,
    /// Episodes that reached the goal.
    reached: usize,
    /// The sum of their steps.
    steps: usize,
}

fn main() -> ExitCode {
    exit::run(run)
}

fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let grid = grid(options);
    let episodes = episodes_of_a_cell(options.episodes, grid.len())?;
    let seeded = VecBatch::new(options.seed.clone(), episodes)?;

    let began = Instant::now();
    let progress = ProgressBar::new(options.episodes as u64);
    let cells = grid.into_par_iter().map(|params| {
        let cell = play(seeded.clone(), params);
        progress.inc(episodes as u64);
        cell
    });
    let cells = cells.collect::<Result<Vec<Cell>, _>>()?;
    progress.finish_and_clear();
    let seconds = began.elapsed().as_secs_f64();

    let (csv, picture) = (&options.csv, &options.picture);
    files::write(csv, table(&cells))?;
    let map = svg((780, 720), |area| draw(area, options, &cells, episodes))?;
    files::write(picture, map)?;
    let reached: usize = cells.iter().map(|cell| cell.reached).sum();
    writeln!(
        io::stdout(),
        "{}, {}: {} episodes in {seconds:.1} s, of which {reached} reached the goal",
        csv.display(),
        picture.display(),
        options.episodes
    )?;
    Ok(())
}

/// Column by column: a mass with all torques, then the next mass.
fn grid(options: &Options) -> Vec<Params<f32>> {
    let of_mass = |&mass: &f32| {
        options.torques.iter().map(move |&torque| Params {
            mass1: mass,
            mass2: mass,
            torques: [-torque, 0.0, torque],
            ..Params::default()
        })
    };
    options.masses.iter().flat_map(of_mass).collect()
}

fn episodes_of_a_cell(episodes: usize, cells: usize) -> Result<usize, String> {
    /// The batch of so many acrobots takes about 100 MB.
    const MOST: usize = 1_000_000;
    let of_a_cell = episodes / cells;
    if (1..=MOST).contains(&of_a_cell) && episodes.is_multiple_of(cells) {
        return Ok(of_a_cell);
    }
    Err(format!(
        "--episodes must be a multiple of the grid's {cells} cells, from {cells} to {}, got {episodes}",
        cells.saturating_mul(MOST)
    ))
}

/// The steps of an episode before it is truncated, as in Gymnasium: 100 s.
const LIMIT: usize = 500;

/// Plays one episode of each acrobot. Acrobots that reached the goal step on, but no longer count. Counting the
/// episodes that end first would favour short ones.
fn play(mut batch: VecBatch<Fast>, params: Params<f32>) -> Result<Cell, acrobot::Error> {
    let against = |&[.., dtheta1, _]: &[f32; 6]| bang_bang(dtheta1);
    batch.set_params(params)?;
    let len = batch.len();
    let mut actions: Vec<Action> = batch.observations().iter().map(against).collect();
    let mut running = vec![true; len];

    let mut cell = Cell {
        params,
        episodes: len,
        reached: 0,
        steps: 0,
    };
    for step in 1..=LIMIT {
        let results = batch.step(&actions)?;
        for (action, observation) in actions.iter_mut().zip(&results.observations) {
            *action = against(observation);
        }
        for (running, &terminated) in running.iter_mut().zip(&results.terminated) {
            if *running && terminated {
                *running = false;
                cell.reached += 1;
                cell.steps += step;
            }
        }
        if cell.reached == len {
            break;
        }
    }
    Ok(cell)
}

impl Cell {
    fn share(&self) -> f64 {
        self.reached as f64 / self.episodes as f64
    }

    /// The mean steps of the episodes that reached the goal, if any did.
    fn mean(&self) -> Option<f64> {
        (self.reached > 0).then(|| self.steps as f64 / self.reached as f64)
    }

    /// Grey where fewer than half of the episodes reached the goal.
    fn color(&self) -> RGBColor {
        match self.mean() {
            Some(mean) if self.share() >= 0.5 => color(mean.log2(), &DOUBLINGS),
            _ => RGBColor(190, 190, 190),
        }
    }
}

/// The CSV. A mean is empty where no episode reached the goal.
fn table(cells: &[Cell]) -> String {
    let mut text =
        "mass_kg,torque_n_m,episodes,reached,share,steps_of_reached,mean_steps_of_reached\n"
            .to_owned();
    for cell in cells {
        let mean = cell
            .mean()
            .map_or(String::new(), |mean| format!("{mean:.3}"));
        writeln!(
            text,
            "{},{},{},{},{:.4},{},{mean}",
            cell.params.mass1,
            cell.params.torque(Action::Positive),
            cell.episodes,
            cell.reached,
            cell.share(),
            cell.steps,
        )
        .expect("a String grows");
    }
    text
}

/// The range of the colour map, as binary logarithms of steps: from 8 steps or fewer to 512.
const DOUBLINGS: Range<f64> = 3.0..9.0;

/// Draws the heat map and its colour bar.
fn draw(
    area: &Area,
    options: &Options,
    cells: &[Cell],
    episodes: usize,
) -> Result<(), Box<dyn Error>> {
    let caption = format!(
        "{episodes} episodes a cell; means of those that reach it within {LIMIT} steps; grey: fewer than half do"
    );
    let body = area
        .titled(
            "Steps to the goal, torque against the first link's velocity",
            ("sans-serif", 24),
        )?
        .titled(&caption, NAME)?;
    let (map, bar) = body.split_horizontally(660);

    let (masses, torques) = (&options.masses, &options.torques);
    let mut chart = ChartBuilder::on(&map)
        .margin(10)
        .x_label_area_size(44)
        .y_label_area_size(52)
        .build_cartesian_2d(around(masses), around(torques))?;
    chart
        .configure_mesh()
        .disable_mesh()
        .label_style(LABEL)
        .axis_desc_style(NAME)
        .x_desc("mass of each link (kg)")
        .y_desc("torque (N m)")
        .x_labels(masses.len())
        .y_labels(torques.len())
        .x_label_formatter(&|&x| name(masses, x))
        .y_label_formatter(&|&y| name(torques, y))
        .draw()?;
    chart.draw_series(cells.iter().enumerate().map(|(i, cell)| {
        let (x, y) = ((i / torques.len()) as f64, (i % torques.len()) as f64);
        Rectangle::new(
            [(x - 0.5, y - 0.5), (x + 0.5, y + 0.5)],
            cell.color().filled(),
        )
    }))?;

    draw_bar(
        &bar,
        &DOUBLINGS,
        "mean steps, of 0.2 s each",
        &|doublings| doublings.exp2().to_string(),
    )
}

/// An axis with one unit for each value, labelled in its middle.
fn around(values: &[f32]) -> Range<f64> {
    -0.5..values.len() as f64 - 0.5
}

fn name(values: &[f32], position: f64) -> String {
    match values.get(position as usize) {
        Some(value) if position.fract() == 0.0 => value.to_string(),
        _ => String::new(),
    }
}
