//! The structs that pass data.

use core::ffi::c_int;

use acrobot::physics::Dynamics;
use acrobot::{Params, State, Step};

use crate::status::Rejected;

/// Action 0: −1 N m by default.
pub const ACROBOT_ACTION_NEGATIVE: c_int = 0;

/// Action 1: no torque by default.
pub const ACROBOT_ACTION_ZERO: c_int = 1;

/// Action 2: +1 N m by default.
pub const ACROBOT_ACTION_POSITIVE: c_int = 2;

/// The equations of Sutton & Barto's book: the physical double pendulum. Gymnasium's default.
pub const ACROBOT_DYNAMICS_BOOK: c_int = 0;

/// The equations of Sutton's paper of 1996 (NIPS 8), which do not conserve energy.
pub const ACROBOT_DYNAMICS_NIPS: c_int = 1;

/// An observation, six floats without padding: the cosine and sine of each angle of the
/// acrobot_state_t, and its angular velocities, rad/s.
#[repr(C)]
pub struct acrobot_observation_t {
    pub cos_theta1: f32,
    pub sin_theta1: f32,
    pub cos_theta2: f32,
    pub sin_theta2: f32,
    pub dtheta1: f32,
    pub dtheta2: f32,
}

impl From<[f32; 6]> for acrobot_observation_t {
    fn from([cos_theta1, sin_theta1, cos_theta2, sin_theta2, dtheta1, dtheta2]: [f32; 6]) -> Self {
        Self { cos_theta1, sin_theta1, cos_theta2, sin_theta2, dtheta1, dtheta2 }
    }
}

#[repr(C)]
pub struct acrobot_step_t {
    /// The observation of the new state.
    pub observation: acrobot_observation_t,
    /// −1, or 0 if `terminated`.
    pub reward: f32,
    /// Whether the new state is a goal state: −cos θ1 − cos(θ1 + θ2) > 1.
    pub terminated: bool,
    /// Whether the time limit is reached: 500 steps by default.
    pub truncated: bool,
}

impl From<Step> for acrobot_step_t {
    fn from(step: Step) -> Self {
        Self {
            observation: step.observation.into(),
            reward: step.reward,
            terminated: step.terminated,
            truncated: step.truncated,
        }
    }
}

/// A state of finite numbers. A step wraps the angles to ±π and bounds the velocities.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_state_t {
    /// Angle of link 1, rad; 0 = hanging straight down, counter-clockwise positive.
    pub theta1: f32,
    /// Angle of link 2 relative to link 1, rad; 0 = in line with it.
    pub theta2: f32,
    /// Angular velocity of link 1, rad/s.
    pub dtheta1: f32,
    /// Angular velocity of link 2 relative to link 1, rad/s.
    pub dtheta2: f32,
}

impl From<State<f32>> for acrobot_state_t {
    fn from(state: State<f32>) -> Self {
        let [theta1, theta2, dtheta1, dtheta2] = state.into();
        Self { theta1, theta2, dtheta1, dtheta2 }
    }
}

impl From<acrobot_state_t> for State<f32> {
    fn from(state: acrobot_state_t) -> Self {
        [state.theta1, state.theta2, state.dtheta1, state.dtheta2].into()
    }
}

/// Parameters, in SI units. To change one, read all with acrobot_params, and set them.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_params_t {
    /// Length of link 1, m; above 0. Default 1.
    pub length1: f32,
    /// Length of link 2, m; above 0. Default 1. Only the height of the tip depends on it.
    pub length2: f32,
    /// Mass of link 1, kg; above 0. Default 1.
    pub mass1: f32,
    /// As `mass1`, of link 2.
    pub mass2: f32,
    /// Distance of link 1's centre of mass from its joint, m; 0 or more. Default 0.5.
    pub center_of_mass1: f32,
    /// As `center_of_mass1`, of link 2.
    pub center_of_mass2: f32,
    /// Moment of inertia of link 1 about its centre of mass, kg m²; 0 or more, and above 0 if the
    /// centre of mass is on the joint. Default 1.
    pub inertia1: f32,
    /// As `inertia1`, of link 2.
    pub inertia2: f32,
    /// Acceleration of gravity, m/s², downwards; finite. Default 9.8.
    pub gravity: f32,
    /// Duration of one step, s; above 0. Default 0.2.
    pub dt: f32,
    /// Bound of |θ̇1| after a step, rad/s; from 1.2e-38 to 3.4e38. Default 4 π.
    pub max_velocity1: f32,
    /// As `max_velocity1`, of |θ̇2|. Default 9 π.
    pub max_velocity2: f32,
    /// Torques of the three actions, N m, in their order; finite. Default −1, 0 and 1.
    pub torques: [f32; 3],
    /// Torque noise, N m; 0 or more. Each step adds a uniform draw from [−noise, noise) to the
    /// torque; 0, the default, draws nothing.
    pub torque_noise: f32,
    /// The equations of motion: ACROBOT_DYNAMICS_BOOK, the default, or ACROBOT_DYNAMICS_NIPS.
    pub dynamics: c_int,
}

/// A struct of another type with the same parameters. Only `dynamics` has another type, too.
macro_rules! same_params {
    ($type:ident, $from:ident, $dynamics:expr $(, $friction:ident)?) => {
        $type {
            length1: $from.length1,
            length2: $from.length2,
            mass1: $from.mass1,
            mass2: $from.mass2,
            center_of_mass1: $from.center_of_mass1,
            center_of_mass2: $from.center_of_mass2,
            inertia1: $from.inertia1,
            inertia2: $from.inertia2,
            gravity: $from.gravity,
            dt: $from.dt,
            max_velocity1: $from.max_velocity1,
            max_velocity2: $from.max_velocity2,
            torques: $from.torques,
            torque_noise: $from.torque_noise,
            dynamics: $dynamics,
            $($friction: acrobot::physics::Viscous::default(),)?
        }
    };
}

impl From<Params<f32>> for acrobot_params_t {
    fn from(params: Params<f32>) -> Self {
        let dynamics = match params.dynamics {
            Dynamics::Nips => ACROBOT_DYNAMICS_NIPS,
            _ => ACROBOT_DYNAMICS_BOOK,
        };
        same_params!(acrobot_params_t, params, dynamics)
    }
}

impl TryFrom<acrobot_params_t> for Params<f32> {
    type Error = Rejected;

    /// Rejects unknown dynamics only.
    fn try_from(params: acrobot_params_t) -> Result<Self, Rejected> {
        let dynamics = match params.dynamics {
            ACROBOT_DYNAMICS_BOOK => Dynamics::Book,
            ACROBOT_DYNAMICS_NIPS => Dynamics::Nips,
            other => {
                let rule = "0 (book) or 1 (NIPS)";
                return Err(Rejected::number("dynamics", other.into(), "", rule));
            }
        };
        Ok(same_params!(Params, params, dynamics, friction))
    }
}
