//! Friction of the joints.

/// Viscous friction: each joint resists its velocity with a torque in proportion to it. Only
/// arithmetics [with friction](crate::arithmetic::Damped) accept one that is not 0.
///
/// ```
/// use acrobot::arithmetic::Damped;
/// use acrobot::physics::{Pendulum, Viscous};
/// use acrobot::{Fast, Params, State};
///
/// let friction = Viscous { joint1: 0.05, joint2: 0.05 };
/// let params = Params { friction, ..Params::DEFAULT };
/// Pendulum::<Damped<Fast>>::new(params, State::HANGING)?.step(1.0)?;
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Viscous<V> {
    /// Of the fixed joint, which resists θ̇1: N m s/rad; 0 or more.
    pub joint1: V,
    /// Of the elbow, which resists θ̇2: N m s/rad; 0 or more.
    pub joint2: V,
}
