//! Follows a plan that a desktop has written, without a planner: swings up and holds upright.

#![no_std]
#![no_main]

use acrobot::physics::saturate;
use acrobot::{Acrobot, Error, Fast, Params, State};
use acrobot_cortex_m::plan::PLAN;
use cortex_m_rt::entry;
use semihosting::{println, process};

fn follow() -> Result<f32, Error> {
    let params = Params { dt: 0.05, ..Params::DEFAULT };
    let mut machine = Acrobot::<Fast>::with_params(42_u64, params)?; // stands for the machine
    for tick in 0..200 {
        let torque = PLAN.torque(tick, machine.state());
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
