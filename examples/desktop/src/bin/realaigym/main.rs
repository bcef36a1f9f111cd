//! Plays RealAIGym's simulated boards of the acrobot.
//!
//! ```text
//! cargo run --release -p desktop --bin realaigym
//! ```

mod resets;
mod robot;
mod score;
mod swing_up;
mod task;
mod uptime;

use std::path::PathBuf;
use std::time::Duration;

use clap::{Parser, value_parser};
use resets::{OF_NUMPYS_SEEDS, Reset};
use score::{Costs, Version, costs};
use task::{HISTORY_SAC, MC_PILCO};

/// Of the resets. The settings were chosen with other seeds, below 200.
const SEEDS: std::ops::Range<u64> = 200..211;

/// Plays RealAIGym's simulated boards of the acrobot by planning.
#[derive(Parser)]
struct Options {
    /// Tries of each plan.
    #[arg(long, default_value_t = 128, value_parser = value_parser!(u32).range(1..))]
    tries: u32,
    /// A folder for the trajectories.
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
}

fn main() -> anyhow::Result<()> {
    let Options { tries, out } = Options::parse();
    let save = |name: String, robot: &robot::Robot| match &out {
        Some(folder) => robot.save(&folder.join(name)),
        None => Ok(()),
    };
    println!(
        "| | score | s | J | largest N m | N m s | N² m² s | smoothness, N m | rad²/s | up, s |"
    );
    println!("|{}", "---|".repeat(10));
    let print = |name: &str, version: Version, costs: Costs| {
        let numbers = costs.map(|cost| format!(" | {cost:.4}")).concat();
        println!("| {version:?}: {name} | {:.4}{numbers} |", version.score(costs));
    };
    for (version, params, name, published) in [
        (Version::V2, task::C1, "History SAC", HISTORY_SAC),
        (Version::V1, task::c0(), "MC-PILCO", MC_PILCO),
    ] {
        let (costs, robot) = swing_up::search(version, params, tries)?;
        print("Planner", version, costs);
        print(name, version, published);
        save(format!("{version:?}.csv"), &robot)?;
    }
    let mut longest = Duration::ZERO;
    let mut play = |seed, resets: &[Reset]| -> anyhow::Result<Costs> {
        let (robot, took) = uptime::play(seed, resets, tries)?;
        longest = longest.max(took);
        save(format!("V3_{seed}.csv"), &robot)?;
        costs(task::C1, &robot.rows)
    };
    for (seed, resets) in OF_NUMPYS_SEEDS {
        print(&format!("Planner, NumPy's seed {seed}"), Version::V3, play(seed, &resets)?);
    }
    let played = SEEDS.map(|seed| Ok(Version::V3.score(play(seed, &[])?)));
    let scores = played.collect::<anyhow::Result<Vec<f64>>>()?;
    let mean = scores.iter().sum::<f64>() / scores.len() as f64;
    let (least, most) = scores.iter().fold((1.0_f64, 0.0_f64), |(a, b), x| (a.min(*x), b.max(*x)));
    let count = scores.len();
    println!("\nV3, {count} runs with other resets: mean {mean:.4}, {least:.4} to {most:.4}");
    println!("A plan of V3 took at most {:.3} s.", longest.as_secs_f64());
    println!("Published: real_ai_gym_leaderboard, data/acrobot, 26 September 2025");
    Ok(())
}
