//! Writes the plan of a swing-up as a constant of Rust or C, for firmware without a planner.
//!
//! ```text
//! cargo run --release -p desktop --bin plan -- --out plan.rs   # Gymnasium's machine, 8 N m
//! cargo run --release -p desktop --bin plan -- --out plan.h    # for C
//! ```

use std::fmt::Display;
use std::path::PathBuf;

use acrobot::arithmetic::Damped;
use acrobot::control::plan::{Planner, Problem};
use acrobot::control::regulator::Region;
use acrobot::numpy::Pcg64;
use acrobot::{Fast, Params, State};
use clap::Parser;
use desktop::write;

/// Writes a plan from hanging at rest as code. For a machine of your own, change `machine` below.
#[derive(Parser)]
struct Options {
    /// File to write: Rust if its name ends in .rs, and C otherwise.
    #[arg(long, value_name = "FILE", default_value = "plan.rs")]
    out: PathBuf,
    /// The largest torque of the plan, N m: leave some of the motor's for corrections.
    #[arg(long, default_value_t = 8.0)]
    limit: f32,
    /// Decisions a second.
    #[arg(long, default_value_t = 20)]
    rate: u16,
    /// The most steps of the plan.
    #[arg(long, default_value_t = 60)]
    steps: usize,
}

fn machine(rate: u16) -> Params<f32> {
    Params { dt: 1.0 / f32::from(rate), ..Params::DEFAULT }
}

/// Numbers as both languages write them.
fn list(numbers: impl IntoIterator<Item = f32>) -> String {
    numbers
        .into_iter()
        .map(|x| format!("{x:?}, "))
        .collect::<String>()
        .trim_end_matches(", ")
        .into()
}

fn rust_region(Region { gain, factor }: Region<f32>) -> String {
    let rows = factor.map(|row| format!("        [{}],\n", list(row))).concat();
    format!("Region {{ gain: [{}], factor: [\n{rows}    ] }}", list(gain))
}

fn c_region(Region { gain, factor }: Region<f32>) -> String {
    let rows = factor.map(|row| format!("        {{{}}},\n", list(row))).concat();
    format!("{{{{{}}}, {{\n{rows}    }}}}", list(gain))
}

fn lines<T>(items: &[T], line: impl Fn(&T) -> String) -> impl Display {
    items.iter().map(|item| format!("    {},\n", line(item))).collect::<String>()
}

fn main() -> anyhow::Result<()> {
    let Options { out, limit, rate, steps } = Options::parse();
    let problem = Problem::swing_up(machine(rate), limit)?;
    let mut planner = Planner::<Damped<Fast>>::new(&problem)?;
    let plan = planner.plan(State::HANGING, 1000, &mut Pcg64::new(0), steps)?;
    let (knots, after, count) = (&plan.knots, plan.after, plan.knots.len());
    let state = |state: State<f32>| list(<[f32; 4]>::from(state));
    let target = state(after.target);
    let code = if out.extension().is_some_and(|name| name == "rs") {
        let knots = lines(knots, |knot| {
            let (state, torque, gain) = (state(knot.state), knot.torque, list(knot.gain));
            format!("Knot::new([{state}], {torque:?},\n        [{gain}])")
        });
        format!(
            "// {rate} decisions a second, at most {limit} N m. Written by `plan`.\n\
            use acrobot::State;\nuse acrobot::control::plan::{{Knot, Plan}};\n\
            use acrobot::control::regulator::{{Feedback, Region}};\n\n#[rustfmt::skip]\n\
            #[allow(clippy::approx_constant, reason = \"numbers of the plan\")]\n\
            pub const PLAN: Plan<f32, [Knot<f32>; {count}]> = Plan {{\nknots: [\n{knots}],\n\
            after: Feedback {{\n    target: State {{ theta1: {:?}, theta2: {:?}, dtheta1: {:?}, \
            dtheta2: {:?} }},\n    torque: {:?},\n    moving: {},\n    resting: {},\n    \
            reach: {:?},\n}},\n}};\n",
            after.target.theta1,
            after.target.theta2,
            after.target.dtheta1,
            after.target.dtheta2,
            after.torque,
            rust_region(after.moving),
            rust_region(after.resting),
            after.reach
        )
    } else {
        let knots = lines(knots, |knot| {
            let (state, torque, gain) = (state(knot.state), knot.torque, list(knot.gain));
            format!("{{{{{state}}}, {torque:?},\n     {{{gain}}}, {{0, 0}}}}")
        });
        format!(
            "// {rate} decisions a second, at most {limit} N m. Written by `plan`.\n\
            static const acrobot_knot_t KNOTS[{count}] = {{\n{knots}}};\n\
            static const acrobot_feedback_t AFTER = {{\n    {{{target}}}, {:?},\n    {},\n    \
            {},\n    {:?},\n}};\n",
            after.torque,
            c_region(after.moving),
            c_region(after.resting),
            after.reach
        )
    };
    write(&out, code)?;
    println!("{}: {count} steps", out.display());
    Ok(())
}
