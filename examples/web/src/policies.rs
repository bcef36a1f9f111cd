//! Policies that learn nothing. That of the goal and of random actions are elsewhere: the keys and `sample`.

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
    simulation::with(|simulation| {
        let acrobot = simulation.env.inner();
        let mut upright = acrobot.clone();
        let standing = State {
            theta1: PI,
            ..State::default()
        };
        // It is finite.
        let _ = upright.set_state(standing);
        let missing = upright.energy() - acrobot.energy();
        let action = match -missing * acrobot.state().dtheta1 {
            torque if torque <= -0.5 => Action::Negative,
            torque if torque >= 0.5 => Action::Positive,
            _ => Action::Zero,
        };
        action.into()
    })
}
