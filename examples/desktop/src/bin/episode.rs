//! Planned motions as an animated SVG in real time: a swing-up, a push, and the recovery.
//!
//! ```text
//! cargo run --release -p desktop --bin episode -- --out episode.svg
//! cargo run --release -p desktop --bin episode -- --elbow 1.5  # bends and straightens, no push
//! ```

use std::path::PathBuf;

use acrobot::control::plan::{Knot, Planner, Problem};
use acrobot::numpy::Pcg64;
use acrobot::physics::{Pendulum, saturate};
use acrobot::{Params, Portable, State};
use clap::Parser;
use desktop::{animation, write};

/// Draws how a planner swings an acrobot up with 5 N m, and again after a push.
#[derive(Parser)]
struct Options {
    /// File to write.
    #[arg(long, value_name = "FILE", default_value = "episode.svg")]
    out: PathBuf,
    /// Balances with this angle of the elbow, rad, and then upright again, instead of the push.
    #[arg(long, value_name = "RAD", allow_hyphen_values = true)]
    elbow: Option<f64>,
}

/// The motor's largest torque, N m, and the part of it that plans use.
const LIMIT: f64 = 5.0;
const PLANNED: f64 = 0.9;
/// Decisions for each plan, and of each part of the episode, each 0.02 s.
const PLAN: usize = 250;
const STEPS: usize = 400;
/// What the push adds to both velocities, rad/s.
const PUSH: [f64; 2] = [2.5, -1.0];
/// A frame shows so many decisions, and a ring for so many frames after the push.
const STEPS_PER_FRAME: usize = 2;
const RING: usize = 8;

fn main() -> anyhow::Result<()> {
    let options = Options::parse();
    let params = Params { dt: 0.02, ..Params::DEFAULT };
    let mut acrobot = Pendulum::<Portable>::new(params, State::HANGING)?;
    let mut memory = [Knot::EMPTY; PLAN];
    let mut states = Vec::new();
    let motions = match options.elbow {
        None => vec![(0.0, [0.0; 2]), (0.0, PUSH)],
        Some(elbow) => vec![(0.0, [0.0; 2]), (elbow, [0.0; 2]), (0.0, [0.0; 2])],
    };
    for (elbow, push) in motions {
        let mut planner = Planner::<Portable>::new(&Problem::balance::<Portable>(
            params,
            PLANNED * LIMIT,
            elbow,
        )?)?;
        let mut state = acrobot.state();
        state.dtheta1 += push[0];
        state.dtheta2 += push[1];
        acrobot.set_state(state)?;
        let plan = planner.plan_into(state, 64, &mut Pcg64::new(1), &mut memory)?;
        for step in 0..STEPS {
            if step % STEPS_PER_FRAME == 0 {
                states.push(acrobot.state());
            }
            acrobot.step(saturate(plan.torque(step, acrobot.state()), LIMIT))?;
        }
    }
    let ring = if options.elbow.is_none() { RING } else { 0 };
    let pushed = STEPS / STEPS_PER_FRAME..STEPS / STEPS_PER_FRAME + ring;
    write(&options.out, animation::svg(&states, 2 * STEPS_PER_FRAME as u16, pushed))?;
    println!("{}: {} frames", options.out.display(), states.len());
    Ok(())
}
