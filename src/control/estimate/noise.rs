//! The noise of a machine, and what follows from it.

use crate::control::units::Units;
use crate::error::{Error, Range};
use crate::math::Real;
use crate::physics::Params;

/// The standard deviation of the velocities at first, 1/T.
const AT_FIRST: f64 = 2.0;
/// The variance of the torque is between these parts of the given one. At first it is the most, so
/// that wrong parameters do not count as motion.
const OF_TORQUE: [f64; 2] = [1e-2, 1e4];
/// With the most torque a predicted angle has at most this variance, rad².
const ON_THE_CIRCLE: f64 = 0.1;
/// What the model does not say in a time of T: the standard deviation of a velocity, 1/T.
const IN_A_TIME: f64 = 2e-3;
/// The deviation of a parameter grows in a time of T by this part of the first one.
const DRIFT: f64 = 3e-4;
/// With dry friction, parameters are estimated while a velocity is above this one, 1/T.
const SLOW: f64 = 0.1;

/// The standard deviations of what an [`Estimator`](super::Estimator) measures and of what acts on
/// the machine.
///
/// ```
/// use acrobot::control::estimate::{Estimator, Noise};
/// use acrobot::{Params, Portable};
///
/// let noise = Noise { angle_std: 1.8 / 4096.0, torque_std: 0.05 }; // rad, N m
/// let mut estimator = Estimator::<Portable>::new(Params::DEFAULT, noise)?;
/// estimator.correct([0.1, -0.2])?; // the first measurement
/// assert!((estimator.state_std().unwrap()[0] - noise.angle_std).abs() < 1e-12); // rad
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Noise<S = f64> {
    /// Of a measured angle, rad; above 0 and at most 2. An encoder with n counts for a turn has
    /// 1.8 / n.
    pub angle_std: S,
    /// Of the torque that acts, N m; above 0, and so small that a step changes θ̇2 by at most
    /// 1/`dt`. The estimator changes it between a tenth and a hundred times; less if an angle would
    /// then be anywhere on the circle after a step, or, in `f32`, if no velocity would follow from
    /// the angles.
    pub torque_std: S,
}

/// What follows from the given parameters and noise.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Given<S> {
    /// The variance of a measured angle, rad².
    pub(super) of_angle: S,
    /// The variance of a velocity at first, (rad/s)².
    pub(super) of_velocity: S,
    /// The variance that each step adds to a velocity, (rad/s)², and to a parameter.
    pub(super) in_velocity: S,
    pub(super) in_parameter: S,
    /// The standard deviation of the torque, N m, and the limits of its variance, in parts of it.
    pub(super) torque: S,
    pub(super) limits: [S; 2],
    /// Parameters are estimated while a velocity is above this one, rad/s.
    pub(super) slow: S,
}

impl<S: Real> Given<S> {
    /// Rejects a noise with which nothing can be estimated.
    pub(super) fn new(params: &Params<S>, noise: Noise<S>) -> Result<Self, Error> {
        let [angle, torque] = [noise.angle_std, noise.torque_std].map(S::to_f64);
        Range::AboveZero.check("torque_std", torque, "N m")?;
        let out_of_range =
            |name, value, unit, rule| Err(Error::OutOfRange { name, value, unit, rule });
        if !(angle > 0.0 && angle <= 2.0) {
            return out_of_range("angle_std", angle, "rad", "above 0 and at most 2");
        }
        let Units { time, .. } = Units::new(params, noise.torque_std);
        let params: Params<f64> = params.cast();
        // How much a step changes θ̇2, times dt: most where the elbow is straight or folded.
        let [link1, tip, link2, coupling] = params.inertias();
        let upper = link1 + tip;
        let change = [coupling, -coupling].map(|coupling| {
            let between = coupling - params.rotor;
            let inertia = (upper * link2 - between * between) / (upper + link2 + 2.0 * between);
            params.dt * params.dt * torque / inertia
        });
        let change = change[0].max(change[1]);
        if !(0.0..=1.0).contains(&change) {
            let rule = "so small that a step changes dtheta2 by at most 1 / dt, in";
            return out_of_range("torque_std", torque, "N m", rule);
        }
        let rounding = S::EPSILON.to_f64();
        // A rounded angle of up to π is not exact, either.
        let of_angle = angle * angle + 16.0 * rounding * rounding;
        // With a larger variance of the torque, rounding would hide a measured angle, or
        // a predicted angle could be any of the circle.
        let most = (of_angle / rounding).min(ON_THE_CIRCLE) / (change * change);
        let times = params.dt / time;
        let variance = |std: f64, times| S::from_f64(std * std * times);
        Ok(Self {
            of_angle: S::from_f64(of_angle),
            of_velocity: variance(AT_FIRST / time, 1.0),
            in_velocity: variance(IN_A_TIME / time, times),
            in_parameter: variance(DRIFT, times),
            torque: noise.torque_std,
            slow: S::from_f64(SLOW / time),
            limits: OF_TORQUE.map(|x| S::from_f64(x.min(most))),
        })
    }
}
