//! Three swing-ups that cost different things, as an SVG: the height of the tip and the torque.
//!
//! ```text
//! cargo run --release -p desktop --bin costs -- --out costs.svg
//! ```

use std::path::PathBuf;

use acrobot::control::{Cost, Planner};
use acrobot::numpy::Pcg64;
use acrobot::physics::{Pendulum, saturate};
use acrobot::{Fast, Params, State};
use clap::Parser;
use desktop::{data_url, write};

/// Draws three swing-ups of Gymnasium's acrobot with a motor of 5 N m, planned with different
/// costs.
#[derive(Parser)]
struct Options {
    /// File to write.
    #[arg(long, value_name = "FILE", default_value = "costs.svg")]
    out: PathBuf,
    /// Also writes the picture as a definition for Markdown.
    #[arg(long, value_name = "FILE")]
    definition: Option<PathBuf>,
}

const LIMIT: f32 = 5.0; // N m
const SECONDS: f32 = 8.0;
const DT: f32 = 0.02;

fn main() -> anyhow::Result<()> {
    let options = Options::parse();
    let params = Params { dt: DT, ..Params::DEFAULT };
    let plain = Cost::new(&params);
    let cases = [
        ("the default", "#888", plain),
        ("power: 1", "#d55e00", Cost { power: 1.0, ..plain }),
        ("torque_change: 1", "#0072b2", Cost { torque_change: 1.0, ..plain }),
    ];
    let mut drawn = String::new();
    for (i, (name, color, cost)) in cases.into_iter().enumerate() {
        let (heights, torques) = swing_up(params, cost)?;
        let y = 18 + 16 * i;
        drawn += &format!("<text x='448' y='{y}' fill='{color}'>{name}</text>\n");
        for line in [heights, torques] {
            drawn += &format!("<path fill='none' stroke='{color}' d='{line}'/>\n");
        }
    }
    let svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 560 250' font-family='sans-serif' \
         font-size='12'>\n<path stroke='#ccc' \
         d='M40 10V130M40 150V230M40 10H440M40 70H440M40 190H440M40 230H440'/>\n\
         <text x='4' y='14'>2 m</text><text x='4' y='134'>-2 m</text>\
         <text x='4' y='164'>5 N m</text><text x='4' y='230'>-5 N m</text>\
         <text x='40' y='246'>0 s</text><text x='425' y='246'>8 s</text>\n{drawn}</svg>\n"
    );
    if let Some(definition) = &options.definition {
        write(definition, data_url("costs.svg", &svg))?;
    }
    write(&options.out, svg)
}

/// The lines of the tip's height and of the torque.
fn swing_up(params: Params<f32>, cost: Cost<f32>) -> anyhow::Result<(String, String)> {
    let mut planner = Planner::<Fast>::with_cost(params, LIMIT, cost)?;
    let steps = (SECONDS / DT) as usize;
    let plan = planner.search(State::HANGING, 256, &mut Pcg64::new(1), steps)?;
    let mut machine = Pendulum::<Fast>::hanging();
    machine.set_params(params)?;
    let (mut heights, mut torques) = (Vec::new(), Vec::new());
    for i in 0..steps {
        let torque = saturate(planner.follow(&plan, i, machine.state()), LIMIT);
        if i % 3 == 0 {
            heights.push(70.0 - 30.0 * machine.tip_height());
            torques.push(190.0 - 8.0 * torque);
        }
        machine.step(torque)?;
    }
    Ok((line(&heights), line(&torques)))
}

/// A path from one height to the next, 3 to the right each, in relative coordinates.
fn line(heights: &[f32]) -> String {
    let heights: Vec<i32> = heights.iter().map(|y| y.round() as i32).collect();
    let steps: Vec<_> = heights.windows(2).map(|y| format!("3{:+}", y[1] - y[0])).collect();
    format!("M40,{}l{}", heights[0], steps.join(","))
}
