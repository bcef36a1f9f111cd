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
use score::{HISTORY_SAC, MC_PILCO, Version, costs};

/// The first seed of the resets. The settings were chosen with 1 to 11.
const FIRST: u64 = 100;

/// Plays RealAIGym's simulated boards of the acrobot by planning.
#[derive(Parser)]
struct Options {
    /// Tries of each plan.
    #[arg(long, default_value_t = 160, value_parser = value_parser!(u32).range(1..))]
    tries: u32,
    /// After resets as many tries as fit into this time instead.
    #[arg(long, value_name = "MS")]
    time: Option<u64>,
    /// Episodes of ICRA 2025.
    #[arg(long, default_value_t = 11, value_parser = value_parser!(u64).range(1..))]
    episodes: u64,
    /// A folder for the trajectories.
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
}

fn main() -> anyhow::Result<()> {
    let Options { tries, time, episodes, out } = Options::parse();
    let save = |name: String, robot: &robot::Robot| match &out {
        Some(folder) => robot.save(&folder.join(name)),
        None => Ok(()),
    };
    println!("| | score | s | J | largest N m | N m s | N² m² s | smoothness, N m | rad²/s |");
    println!("|---|---|---|---|---|---|---|---|---|");
    for (version, params, published) in [
        (Version::V2, task::C1, ("History SAC", HISTORY_SAC)),
        (Version::V1, task::c0(), ("MC-PILCO", MC_PILCO)),
    ] {
        let (_, ours, robot) = swing_up::search(version, params, tries)?;
        for (name, costs) in [("Planner", ours), published] {
            let numbers = costs.map(|cost| format!(" | {cost:.4}")).concat();
            println!("| {version:?}: {name} | {:.4}{numbers} |", version.score(costs));
        }
        save(format!("{version:?}.csv"), &robot)?;
    }
    let (mut scores, mut longest) = (Vec::new(), Duration::ZERO);
    for seed in FIRST..FIRST + episodes {
        let (robot, took) = uptime::play(seed, tries, time.map(Duration::from_millis))?;
        scores.push(costs(task::C1, &robot.rows)?.1 / uptime::SECONDS);
        longest = longest.max(took);
        save(format!("icra2025_{seed}.csv"), &robot)?;
    }
    let mean = scores.iter().sum::<f64>() / episodes as f64;
    println!("\nICRA 2025: {mean:.4}, the mean of {scores:.4?}; published: AR-EAPO, 0.6581");
    println!("Planning after a reset took at most {:.3} s.", longest.as_secs_f64());
    println!("Published: real_ai_gym_leaderboard, data/acrobot, 26 September 2025");
    Ok(())
}
