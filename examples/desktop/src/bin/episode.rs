//! An episode as an animated SVG: the bang-bang policy, torque against θ̇1, or a plan.
//!
//! ```text
//! cargo run --release -p desktop --bin episode -- --seed 42 --out episode.svg
//! cargo run --release -p desktop --bin episode -- --balance --out balance.svg
//! ```

use std::path::PathBuf;

use acrobot::control::{Knot, Planner};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::saturate;
use acrobot::{Acrobot, Fast, Params, Portable, State, TimeLimit};
use clap::Parser;
use desktop::{animation, bang_bang, write};

/// Draws an episode as an animated SVG, about three times as fast as real time.
#[derive(Parser)]
struct Options {
    /// Seed of the initial state, and of the disturbance: a decimal integer of any size.
    #[arg(long, default_value = "42")]
    seed: SeedSequence,
    /// Draws in real time how the firmware `balance` swings up and holds the acrobot upright, with
    /// a motor of 2 N m.
    #[arg(long)]
    balance: bool,
    /// File to write.
    #[arg(long, value_name = "FILE", default_value = "episode.svg")]
    out: PathBuf,
    /// Also writes the picture as a definition for Markdown, because rustdoc's pages have no files
    /// beside them.
    #[arg(long, value_name = "FILE", requires = "balance")]
    definition: Option<PathBuf>,
}

fn main() -> anyhow::Result<()> {
    let options = Options::parse();
    let rng = options.seed.into();
    let (states, delay) = if options.balance {
        (balance(rng)?, STEPS_PER_FRAME as u16) // steps of 1/100 s
    } else {
        (bang_bang_episode(rng), animation::DELAY)
    };
    let svg = animation::svg(&states, delay);
    if let Some(definition) = &options.definition {
        let url = svg.replace('\n', "").replace(' ', "%20").replace('"', "'").replace('#', "%23");
        write(definition, format!("[balance.svg]: data:image/svg+xml,{url}\n"))?;
    }
    write(&options.out, svg)?;
    println!("{}: {} frames", options.out.display(), states.len());
    Ok(())
}

fn bang_bang_episode(rng: Pcg64) -> Vec<State> {
    let mut acrobot = TimeLimit::of(Acrobot::<Portable>::with_rng(rng));
    let mut states = vec![acrobot.state()];
    loop {
        let step = acrobot.step(bang_bang(acrobot.state().dtheta1));
        states.push(acrobot.state());
        if step.done() {
            return states;
        }
    }
}

/// Steps of the balanced acrobot, each 0.01 s.
const STEPS: usize = 1500;
/// Each of its frames shows this many steps: 25 frames a second.
const STEPS_PER_FRAME: usize = 4;

/// The state of each frame.
fn balance(rng: Pcg64) -> anyhow::Result<Vec<State>> {
    // As in the firmware with a largest torque of 2 N m.
    let params = Params { dt: 0.01, torque_noise: 0.5, ..Params::DEFAULT };
    let mut planner = Planner::<Fast>::new(params, 1.5)?;
    let mut memory = [Knot::EMPTY; 1250];
    let plan = planner.plan(State::HANGING, 64, &mut Pcg64::new(1), &mut memory)?;
    let mut machine = Acrobot::<Fast>::with_rng(rng);
    machine.set_params(params)?;
    let mut states = Vec::new();
    for step in 0..STEPS {
        let state = machine.state();
        if step % STEPS_PER_FRAME == 0 {
            states.push(state.cast());
        }
        machine.step_torque(saturate(planner.follow(plan, step, state), 2.0))?;
    }
    Ok(states)
}
