//! The structs that pass data.

use core::ffi::c_int;
use core::mem::transmute;

use acrobot::physics::Dynamics;
use acrobot::task::{Draw, Draws};
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

/// Cosine and sine of each angle of the acrobot_state_t, and its angular velocities, rad/s; six
/// floats without padding.
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
    /// Whether −cos θ1 − cos(θ1 + θ2) > 1: the goal.
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

/// To change one parameter, read all with acrobot_params, and set them.
// derive.py writes the fields of these structs.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_params_t {
    /// Length of link 1, m; above 0. Default 1.
    pub length1: f32,
    /// Length of link 2, m; above 0. Only the tip's height and drawings depend on it. Default 1.
    pub length2: f32,
    /// Mass of link 1, kg; above 0. Default 1.
    pub mass1: f32,
    /// Mass of link 2, kg; above 0. Default 1.
    pub mass2: f32,
    /// Distance of link 1's centre of mass from its joint, m; 0 or more. Default 0.5.
    pub center_of_mass1: f32,
    /// Distance of link 2's centre of mass from its joint, m; 0 or more. Default 0.5.
    pub center_of_mass2: f32,
    /// Moment of inertia of link 1 about its centre of mass, kg m²; 0 or more, and above 0 if the
    /// centre of mass is on the joint. Default 1.
    pub inertia1: f32,
    /// Moment of inertia of link 2 about its centre of mass, kg m²; as `inertia1`. Default 1.
    pub inertia2: f32,
    /// Acceleration of gravity, m/s², downwards; finite, 0 for none. Default 9.8.
    pub gravity: f32,
    /// Duration of one step, s; above 0. Default 0.2.
    pub dt: f32,
    /// Bound of |θ̇1| after a step, rad/s; at least 1.2e-38. Infinity, for none, is stored as
    /// 3.4e38, the largest number in single precision, which observations have. Default 4 π.
    pub max_velocity1: f32,
    /// Bound of |θ̇2| after a step, rad/s; as `max_velocity1`. Default 9 π.
    pub max_velocity2: f32,
    /// Torques of the three actions, N m, in the order of their numbers; finite. Default
    /// [−1, 0, 1].
    pub torques: [f32; 3],
    /// Torque noise, N m; 0 or more. Each step adds a uniform draw from [−noise, noise) to the
    /// torque; 0 draws nothing. Default 0.
    pub torque_noise: f32,
    /// Viscous friction of the fixed joint, which resists θ̇1 with a torque in proportion to it,
    /// N m s/rad; 0 or more. Default 0.
    pub damping1: f32,
    /// Viscous friction of the elbow, which resists θ̇2; as `damping1`. Default 0.
    pub damping2: f32,
    /// Coulomb friction of the fixed joint: its torque as soon as the joint turns, N m; 0 or more.
    /// Default 0.
    pub coulomb1: f32,
    /// Coulomb friction of the elbow; as `coulomb1`. Default 0.
    pub coulomb2: f32,
    /// What a geared rotor in the elbow takes from the coupling of the links, kg m²; finite, and so
    /// small that the mass matrix is positive definite. A rotor of moment of inertia J behind a
    /// gear g adds (g + 1)² J to `inertia1`, g² J to `inertia2`, and (g + 1) g J here. Default 0.
    pub rotor: f32,
    /// The equations of motion: of Sutton and Barto's book, or of the paper of 1996 (NIPS 8).
    /// Default ACROBOT_DYNAMICS_BOOK.
    pub dynamics: c_int,
}

/// The parameter stays as it is.
pub const ACROBOT_DRAW_FIXED: c_int = 0;

/// Uniformly from `low` to `high`.
pub const ACROBOT_DRAW_UNIFORM: c_int = 1;

/// Its logarithm uniformly; `low` is above 0.
pub const ACROBOT_DRAW_LOG_UNIFORM: c_int = 2;

/// From a normal distribution truncated at `low` and `high`. `mean` is between these, and the
/// standard deviation above 0.
pub const ACROBOT_DRAW_NORMAL: c_int = 3;

/// How a parameter is drawn.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_draw_t {
    /// One of the ACROBOT_DRAW numbers.
    pub kind: c_int,
    pub low: f32,
    pub high: f32,
    pub mean: f32,
    /// The standard deviation.
    pub std: f32,
}

/// How each parameter is drawn, in the order of acrobot_params_t. Zeros draw nothing.
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
const NUMBERS: usize = size_of::<acrobot_draws_t>() / size_of::<acrobot_draw_t>();

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
            *to = draw.try_into()?;
        }
        Ok(Self::new(params)?)
    }
}

impl TryFrom<acrobot_draw_t> for Draw<f32> {
    type Error = Rejected;

    fn try_from(draw: acrobot_draw_t) -> Result<Self, Rejected> {
        let acrobot_draw_t { kind, low, high, mean, std } = draw;
        match kind {
            ACROBOT_DRAW_FIXED => Ok(Self::Fixed),
            ACROBOT_DRAW_UNIFORM => Ok(Self::Uniform { low, high }),
            ACROBOT_DRAW_LOG_UNIFORM => Ok(Self::LogUniform { low, high }),
            ACROBOT_DRAW_NORMAL => Ok(Self::Normal { mean, std, low, high }),
            _ => Err(Rejected::number("kind", kind.into(), "", "from 0 to 3")),
        }
    }
}

impl From<Params<f32>> for acrobot_params_t {
    #[inline(never)] // saves code: many functions call it
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
    #[inline(never)]
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
