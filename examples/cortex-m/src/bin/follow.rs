//! Follows a plan that Python has written, without a planner: swings up, and then holds upright by
//! the gain of a regulator, which also comes from there.

#![no_std]
#![no_main]

use acrobot::control::regulator::{Feedback, Region};
use acrobot::physics::saturate;
use acrobot::{Acrobot, Error, Fast, State};
use acrobot_cortex_m::plan::{GAIN, PARAMS, PLAN};
use cortex_m_rt::entry;
use semihosting::{println, process};

const UPRIGHT: Region<f32> = Region { gain: GAIN, ..Region::NONE };
const HOLD: Feedback<f32> = Feedback {
    target: State::UPRIGHT,
    torque: 0.0,
    moving: UPRIGHT,
    resting: Region::NONE,
    reach: 0.0,
};

fn follow() -> Result<f32, Error> {
    let mut machine = Acrobot::<Fast>::with_params(42_u64, PARAMS)?; // stands for the machine
    for tick in 0..200 {
        let state = machine.state();
        let is_planned = tick < PLAN.knots.len();
        let torque = if is_planned { PLAN.torque(tick, state) } else { HOLD.torque(state) };
        machine.step_torque(saturate(torque, 10.0))?; // a fifth is for corrections
    }
    let [theta1, ..] = machine.state().deviation_from(State::UPRIGHT);
    Ok(theta1.abs())
}

#[entry]
fn main() -> ! {
    match follow() {
        Ok(lean) if lean < 0.001 => println!("upright after 10 s"),
        _ => process::exit(1),
    }
    process::exit(0)
}
