//! Two policies that need no training.

use acrobot::physics::{Pendulum, State};
use acrobot::{Action, Fast};

use crate::simulation;

/// Applies torque against θ̇1.
#[unsafe(no_mangle)]
pub extern "C" fn bang_bang() -> u8 {
    simulation::with(|simulation| {
        let against = simulation.env.state().dtheta1 > 0.0;
        let action = if against {
            Action::Negative
        } else {
            Action::Positive
        };
        action.into()
    })
}

/// Applies the torque −(E↑ − E) θ̇1, rounded to an action. E↑ is the energy of standing upright. The torque adds energy below E↑ and removes energy above it.
#[unsafe(no_mangle)]
pub extern "C" fn energy_law() -> u8 {
    let standing = standing();
    simulation::with(|simulation| {
        let acrobot = simulation.env.inner();
        let missing = standing - acrobot.pendulum().energy();
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
        Pendulum::<Fast>::new(*simulation.env.params(), State::UPRIGHT)
            .map_or(f32::NAN, |upright| upright.energy())
    })
}
