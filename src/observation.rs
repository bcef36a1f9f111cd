//! What an agent sees. The reading of `Acrobot-v0` is [`State<f32>`](crate::State) itself.

use core::f32::consts::PI;

/// The observation of `Acrobot-v1`: the state with its angles as points on the unit circle.
///
/// As an array it is \[cos θ1, sin θ1, cos θ2, sin θ2, θ̇1, θ̇2\].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Observation {
    /// cos θ1, from −1 to 1; 1 = link 1 hangs straight down.
    pub cos_theta1: f32,
    /// sin θ1, from −1 to 1.
    pub sin_theta1: f32,
    /// cos θ2, from −1 to 1; 1 = the links are in line.
    pub cos_theta2: f32,
    /// sin θ2, from −1 to 1.
    pub sin_theta2: f32,
    /// θ̇1, rad/s, within ±4π by default.
    pub dtheta1: f32,
    /// θ̇2, rad/s, within ±9π by default.
    pub dtheta2: f32,
}

impl Observation {
    /// The upper bounds of `Acrobot-v1`'s observation space.
    pub const HIGH: [f32; 6] = [1.0, 1.0, 1.0, 1.0, 4.0 * PI, 9.0 * PI];
    /// The lower bounds: `-HIGH`.
    pub const LOW: [f32; 6] = [-1.0, -1.0, -1.0, -1.0, -4.0 * PI, -9.0 * PI];
}

impl From<Observation> for [f32; 6] {
    #[inline]
    fn from(observation: Observation) -> Self {
        [
            observation.cos_theta1,
            observation.sin_theta1,
            observation.cos_theta2,
            observation.sin_theta2,
            observation.dtheta1,
            observation.dtheta2,
        ]
    }
}
