//! Two policies that learn nothing.

use core::f32::consts::PI;

use acrobot::{Action, State};

use crate::simulation;

/// Torque against θ̇1.
#[unsafe(no_mangle)]
pub extern "C" fn bang_bang() -> u8 {
    simulation::with(|simulation| {
        let against = simulation.env.inner().state().dtheta1 > 0.0;
        let action = if against {
            Action::Negative
        } else {
            Action::Positive
        };
        action.into()
    })
}

/// The law of `energy_control`, −(E↑ − E) θ̇1 with E↑ the energy of standing upright, rounded to an action: it adds what
/// energy is missing, and takes away what is too much.
#[unsafe(no_mangle)]
pub extern "C" fn energy_law() -> u8 {
    let standing = standing();
    simulation::with(|simulation| {
        let acrobot = simulation.env.inner();
        let missing = standing - acrobot.energy();
        let action = match -missing * acrobot.state().dtheta1 {
            torque if torque <= -0.5 => Action::Negative,
            torque if torque >= 0.5 => Action::Positive,
            _ => Action::Zero,
        };
        action.into()
    })
}

/// The energy of standing upright, J.
#[unsafe(no_mangle)]
pub extern "C" fn standing() -> f32 {
    simulation::with(|simulation| {
        let mut acrobot = simulation.env.inner().clone();
        let upright = State {
            theta1: PI,
            ..State::default()
        };
        // It is finite.
        let _ = acrobot.set_state(upright);
        acrobot.energy()
    })
}
