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
use robot::Robot;
use score::Version;
use task::C1;
use uptime::Budget;

/// The resets' seeds begin here. Settings were chosen with those from 1 to 11.
const FIRST: u32 = 100;

/// Plays RealAIGym's simulated boards of the acrobot by planning.
#[derive(Parser)]
struct Options {
    /// First guesses of a swing-up.
    #[arg(long, default_value_t = 192, value_parser = value_parser!(u32).range(1..))]
    guesses: u32,
    /// Episodes of ICRA 2025.
    #[arg(long, default_value_t = 11, value_parser = value_parser!(u32).range(1..))]
    episodes: u32,
    /// Tries of each plan of ICRA 2025, for the same result on all machines.
    #[arg(long, default_value_t = 160, value_parser = value_parser!(u32).range(1..))]
    tries: u32,
    /// Instead, as many tries as this time allows on a core.
    #[arg(long, value_name = "MS")]
    time: Option<u64>,
    /// A folder for the trajectories.
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
}

impl Options {
    fn save(&self, name: &str, robot: &Robot) -> anyhow::Result<()> {
        self.out.as_ref().map_or(Ok(()), |folder| robot.save(&folder.join(name)))
    }
}

fn main() -> anyhow::Result<()> {
    let options = Options::parse();
    println!(
        "| performance | score | swing-up, s | J | largest N m | N m s | N² m² s | smoothness, N m | rad²/s |"
    );
    println!("|{}", "---|".repeat(9));
    for (version, name, params) in [(Version::V2, "v2", C1), (Version::V1, "v1", task::c0())] {
        let (score, costs, robot) = swing_up::search(version, params, options.guesses)?;
        println!(
            "| {name} | {score:.4} | {} |",
            costs.map(|cost| format!("{cost:.4}")).join(" | ")
        );
        options.save(&format!("{name}.csv"), &robot)?;
    }
    let budget = match options.time {
        Some(ms) => Budget::Time(Duration::from_millis(ms)),
        None => Budget::Tries(options.tries),
    };
    let (mut scores, mut longest) = (Vec::new(), Duration::ZERO);
    for seed in FIRST..FIRST + options.episodes {
        let (robot, took) = uptime::play(seed.into(), budget)?;
        let (_, uptime) = score::costs(&C1, &robot.rows);
        scores.push(uptime / uptime::SECONDS);
        longest = longest.max(took);
        options.save(&format!("icra2025_{seed}.csv"), &robot)?;
    }
    println!(
        "ICRA 2025: mean of {} scores {:.4} ({:.4} to {:.4}); planning took at most {longest:.0?}",
        scores.len(),
        scores.iter().sum::<f64>() / scores.len() as f64,
        scores.iter().fold(1.0, |x, y| f64::min(x, *y)),
        scores.iter().fold(0.0, |x, y| f64::max(x, *y))
    );
    Ok(())
}
