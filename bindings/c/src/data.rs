//! The structs that pass data.

use core::ffi::c_int;
use core::mem::transmute;

use acrobot::physics::Dynamics;
use acrobot::task::{Draw, Draws};
use acrobot::{Params, State, Step};

use crate::status::Rejected;

pub const ACROBOT_ACTION_NEGATIVE: c_int = 0;

pub const ACROBOT_ACTION_ZERO: c_int = 1;

pub const ACROBOT_ACTION_POSITIVE: c_int = 2;

pub const ACROBOT_DYNAMICS_BOOK: c_int = 0;

pub const ACROBOT_DYNAMICS_NIPS: c_int = 1;

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
    pub observation: acrobot_observation_t,
    pub reward: f32,
    pub terminated: bool,
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

#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_state_t {
    pub theta1: f32,
    pub theta2: f32,
    pub dtheta1: f32,
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

#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_params_t {
    pub length1: f32,
    pub length2: f32,
    pub mass1: f32,
    pub mass2: f32,
    pub center_of_mass1: f32,
    pub center_of_mass2: f32,
    pub inertia1: f32,
    pub inertia2: f32,
    pub gravity: f32,
    pub dt: f32,
    pub max_velocity1: f32,
    pub max_velocity2: f32,
    pub torques: [f32; 3],
    pub torque_noise: f32,
    pub damping1: f32,
    pub damping2: f32,
    pub coulomb1: f32,
    pub coulomb2: f32,
    pub rotor: f32,
    pub dynamics: c_int,
}

pub const ACROBOT_DRAW_FIXED: c_int = 0;

pub const ACROBOT_DRAW_UNIFORM: c_int = 1;

pub const ACROBOT_DRAW_LOG_UNIFORM: c_int = 2;

pub const ACROBOT_DRAW_NORMAL: c_int = 3;

#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_draw_t {
    pub kind: c_int,
    pub low: f32,
    pub high: f32,
    pub mean: f32,
    pub std: f32,
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_draws_t {
    pub length1: acrobot_draw_t,
    pub length2: acrobot_draw_t,
    pub mass1: acrobot_draw_t,
    pub mass2: acrobot_draw_t,
    pub center_of_mass1: acrobot_draw_t,
    pub center_of_mass2: acrobot_draw_t,
    pub inertia1: acrobot_draw_t,
    pub inertia2: acrobot_draw_t,
    pub gravity: acrobot_draw_t,
    pub dt: acrobot_draw_t,
    pub max_velocity1: acrobot_draw_t,
    pub max_velocity2: acrobot_draw_t,
    pub torques: [acrobot_draw_t; 3],
    pub torque_noise: acrobot_draw_t,
    pub damping1: acrobot_draw_t,
    pub damping2: acrobot_draw_t,
    pub coulomb1: acrobot_draw_t,
    pub coulomb2: acrobot_draw_t,
    pub rotor: acrobot_draw_t,
}

/// The numbers of [`acrobot_params_t`] and [`acrobot_draws_t`], in the order of
/// [`Params::numbers`].
const NUMBERS: usize = 21;

/// [`acrobot_params_t`] without names.
#[repr(C)]
struct Fields {
    numbers: [f32; NUMBERS],
    dynamics: c_int,
}

impl TryFrom<acrobot_draws_t> for Draws<f32> {
    type Error = Rejected;

    fn try_from(draws: acrobot_draws_t) -> Result<Self, Rejected> {
        // SAFETY: both are `repr(C)` and have so many draws.
        let draws: [acrobot_draw_t; NUMBERS] = unsafe { transmute(draws) };
        let mut params = Draws::FIXED;
        for (to, draw) in params.numbers_mut().into_iter().zip(draws) {
            let acrobot_draw_t { kind, low, high, mean, std } = draw;
            *to = match kind {
                ACROBOT_DRAW_FIXED => Draw::Fixed,
                ACROBOT_DRAW_UNIFORM => Draw::Uniform { low, high },
                ACROBOT_DRAW_LOG_UNIFORM => Draw::LogUniform { low, high },
                ACROBOT_DRAW_NORMAL => Draw::Normal { mean, std, low, high },
                _ => return Err(Rejected::number("kind", kind.into(), "", "from 0 to 3")),
            };
        }
        Ok(Self::new(params)?)
    }
}

impl From<Params<f32>> for acrobot_params_t {
    fn from(params: Params<f32>) -> Self {
        let numbers = params.numbers().map(|(_, number)| number);
        let dynamics = match params.dynamics {
            Dynamics::Nips => ACROBOT_DYNAMICS_NIPS,
            _ => ACROBOT_DYNAMICS_BOOK,
        };
        // SAFETY: both are `repr(C)` and have so many numbers before the dynamics.
        unsafe { transmute(Fields { numbers, dynamics }) }
    }
}

impl TryFrom<acrobot_params_t> for Params<f32> {
    type Error = Rejected;

    /// Rejects unknown dynamics only.
    fn try_from(params: acrobot_params_t) -> Result<Self, Rejected> {
        // SAFETY: as above.
        let Fields { numbers, dynamics } = unsafe { transmute::<acrobot_params_t, Fields>(params) };
        let dynamics = match dynamics {
            ACROBOT_DYNAMICS_BOOK => Dynamics::Book,
            ACROBOT_DYNAMICS_NIPS => Dynamics::Nips,
            other => {
                let rule = "0 (book) or 1 (NIPS)";
                return Err(Rejected::number("dynamics", other.into(), "", rule));
            }
        };
        let mut params = Self { dynamics, ..Self::default() };
        params.numbers_mut().into_iter().zip(numbers).for_each(|(to, number)| *to = number);
        Ok(params)
    }
}
