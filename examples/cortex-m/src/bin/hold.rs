//! Holds an acrobot upright from the counts of its encoders, with a policy that was trained through
//! instruments. On a board the counts come from two timers, and the torque goes to a motor. Here
//! the acrobot is simulated, through the instruments of the training, and what the policy sees must
//! have the bits of the simulation.

#![no_std]
#![no_main]

use acrobot::arithmetic::Damped;
use acrobot::task::{Balance, Draw, Encoders, Instruments, Measured, Pose, Task};
use acrobot::{Acrobot, Error, Fast, Params, State};
use acrobot_cortex_m as _; // links the board
use cortex_m_rt::entry;
use policy::Policy;
use semihosting::{println, process};

/// `cargo run --release -p desktop --bin train -- --save crates/policy/hold.bin` writes it.
static POLICY: Policy<6> = match Policy::new(include_bytes!("../../../../crates/policy/hold.bin")) {
    Ok(policy) => policy,
    Err(error) => panic!("{}", error.message()),
};

/// Counts of an encoder for a turn, and the time constant of the velocities, s.
const COUNTS: i32 = 4096;
const FILTER: f32 = 0.02;

#[entry]
fn main() -> ! {
    match hold() {
        Ok((equal, lean)) => {
            let end = if lean < 0.5 { "upright" } else { "fallen" };
            println!("{equal} of 500 observations are equal, {end} after 10 s");
            process::exit(if equal == 500 && lean < 0.5 { 0 } else { 1 })
        }
        Err(error) => {
            println!("{}", error.message());
            process::exit(1)
        }
    }
}

/// On how many of 500 steps of 20 ms the policy sees what the simulation shows, and how far the
/// angles are from upright in the last second, rad.
fn hold() -> Result<(u32, f32), Error> {
    let instruments = Instruments {
        action_delay: Some(Draw::exactly(1.0)), // steps
        motor_lag: Some(Draw::exactly(0.1)),    // s
        encoder_counts: Some(Draw::exactly(COUNTS as f32)),
        velocity_filter: Some(Draw::exactly(FILTER)),
        ..Instruments::IDEAL
    };
    let task = Measured::<Balance>::new(Balance, instruments)?;
    let mut machine = Acrobot::<Damped<Fast>, _>::with_task(1, task)?;
    let friction = Params { damping1: 0.1, damping2: 0.1, ..*machine.params() }; // N m s/rad
    machine.set_params(friction)?;
    let near = State { theta1: 0.01, theta2: -0.01, ..State::HANGING };
    machine.set_state(State { theta1: near.theta1 + core::f32::consts::PI, ..near })?;
    let dt = machine.params().dt;
    let mut encoders = Encoders::new(COUNTS, FILTER, dt, counts(machine.state()))?;
    let (mut observation, mut equal, mut lean) = (machine.observation(), 0, 0.0_f32);
    for step in 0..500 {
        let torque = POLICY.torque(&observation).unwrap_or_default();
        let shown = machine.step_torque(torque)?.observation;
        let state = encoders.read(counts(machine.state()));
        observation = Balance.observe::<Fast, f32>(&Pose::of::<Fast>(state));
        equal += u32::from(observation == shown);
        if step >= 450 {
            let [theta1, theta2, ..] = machine.state().deviation_from(State::UPRIGHT);
            lean = lean.max(theta1.abs()).max(theta2.abs());
        }
    }
    Ok((equal, lean))
}

/// What both encoders count.
fn counts(state: State<f32>) -> [i32; 2] {
    let of_a_radian = COUNTS as f32 * core::f64::consts::TAU.recip() as f32;
    [state.theta1, state.theta2].map(|angle| {
        let counts = angle * of_a_radian;
        // The nearest integer, ties to even: a Cortex-M4F has no instruction for it.
        ((counts + 12_582_912.0) - 12_582_912.0) as i32
    })
}
