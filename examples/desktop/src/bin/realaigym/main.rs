//! Plays RealAIGym's simulated boards of the acrobot.
//!
//! ```text
//! cargo run --release -p desktop --bin realaigym
//! ```

mod robot;
mod score;
mod swing_up;
mod task;
mod uptime;

use std::path::PathBuf;
use std::time::Duration;

use clap::{Parser, value_parser};
use score::Version;

/// The first seed of the resets. The settings were chosen with 1 to 11.
const FIRST: u64 = 100;

/// Plays RealAIGym's simulated boards of the acrobot by planning.
#[derive(Parser)]
struct Options {
    /// Tries of each plan.
    #[arg(long, default_value_t = 160, value_parser = value_parser!(u32).range(1..))]
    tries: u32,
    /// Tries for this time instead, on one core, after each reset.
    #[arg(long, value_name = "MS")]
    time: Option<u64>,
    /// Episodes of ICRA 2025.
    #[arg(long, default_value_t = 11, value_parser = value_parser!(u64).range(1..))]
    episodes: u64,
    /// A folder for the trajectories, as RealAIGym's scorer reads them.
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
}

fn main() -> anyhow::Result<()> {
    let options = Options::parse();
    let save = |name: String, robot: &robot::Robot| match &options.out {
        Some(folder) => robot.save(&folder.join(name)),
        None => Ok(()),
    };
    println!("| board | score | best published | time | energy | max. | ∫u | ∫u² | smooth | ∫v² |");
    println!("|{}", "---|".repeat(10));
    for (version, params, published) in
        [(Version::V2, task::C1, "0.655 History SAC"), (Version::V1, task::c0(), "0.869 MC-PILCO")]
    {
        let (score, costs, robot) = swing_up::search(version, params, options.tries)?;
        let costs = costs.map(|cost| format!("{cost:.4}")).join(" | ");
        println!("| performance {version:?} | {score:.4} | {published} | {costs} |");
        save(format!("{version:?}.csv"), &robot)?;
    }
    let (mut sum, mut longest) = (0.0, Duration::ZERO);
    for seed in FIRST..FIRST + options.episodes {
        let time = options.time.map(Duration::from_millis);
        let (robot, took) = uptime::play(seed, options.tries, time)?;
        let (_, uptime) = score::costs(task::C1, &robot.rows)?;
        let score = uptime / uptime::SECONDS;
        println!("| ICRA 2025, seed {seed} | {score:.4} | 0.658 AR-EAPO {}", "| ".repeat(8));
        (sum, longest) = (sum + score, longest.max(took));
        save(format!("icra2025_{seed}.csv"), &robot)?;
    }
    println!(
        "\nICRA 2025: mean {:.4}, a plan took {longest:.0?} at most.",
        sum / options.episodes as f64
    );
    println!("Published: data/acrobot of real_ai_gym_leaderboard on 26 September 2025.");
    Ok(())
}
