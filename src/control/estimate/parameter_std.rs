//! Which parameters are estimated, and how wrong they may be.

use crate::math::Real;
use crate::physics::NUMBERS;

/// The parameters that can be estimated: all on which a motion and its measurement depend.
pub(super) const PARAMETERS: usize = 13;
/// Without the last two, which are known once a machine is identified: the length of link 1 and the
/// rotor.
pub(in crate::control) const USUAL: usize = 11;
/// The places of some among them.
pub(super) const ZEROS: [usize; 2] = [0, 1];
pub(super) const FRICTION: [usize; 4] = [6, 7, 8, 9];
pub(super) const ROTOR: usize = 12;

/// The standard deviations of parameters, each in its unit: 0 for one that is known.
///
/// ```
/// use acrobot::control::estimate::{Noise, ParameterEstimator, ParameterStd};
/// use acrobot::{Params, Portable, arithmetic::Damped};
///
/// let noise = Noise { angle_std: 1e-3, torque_std: 0.01 }; // rad, N m
/// let std = ParameterStd { damping1: 0.1, ..ParameterStd::default() }; // N m s/rad
/// assert!(ParameterEstimator::<Damped<Portable>>::new(Params::DEFAULT, std, noise).is_ok());
/// assert!(ParameterEstimator::<Portable>::new(Params::DEFAULT, std, noise).is_err());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)] // for bindings/abi, whose derive.py copies the fields to other languages
pub struct ParameterStd<S = f64> {
    /// Of the mass of link 1, kg.
    pub mass1: S,
    /// Of the mass of link 2, kg.
    pub mass2: S,
    /// Of the length of link 1, m.
    pub length1: S,
    /// Of the moment of inertia of link 1, kg m².
    pub inertia1: S,
    /// Of the moment of inertia of link 2, kg m².
    pub inertia2: S,
    /// Of the viscous friction of joint 1, N m s/rad.
    ///
    /// This and the following ones must be 0 in an arithmetic without friction.
    pub damping1: S,
    /// Of the viscous friction of joint 2, N m s/rad.
    pub damping2: S,
    /// Of the Coulomb friction of joint 1, N m.
    pub coulomb1: S,
    /// Of the Coulomb friction of joint 2, N m.
    pub coulomb2: S,
    /// Of the rotor, kg m².
    pub rotor: S,
    /// Of what the first encoder says where θ1 is 0, rad. It is given as 0.
    pub zero1: S,
    /// Of what the second encoder says where θ2 is 0, rad. It is given as 0.
    pub zero2: S,
    /// Of the torque that acts, divided by the one that is sent. It is given as 1.
    pub torque_factor: S,
}

impl<S: Copy> ParameterStd<S> {
    /// In the order of [`estimated`].
    pub(super) fn numbers(&self) -> [S; PARAMETERS] {
        let &Self { mass1, mass2, length1, inertia1, inertia2, rotor, .. } = self;
        let &Self { damping1, damping2, coulomb1, coulomb2, .. } = self;
        let &Self { zero1, zero2, torque_factor, .. } = self;
        let friction = [damping1, damping2, coulomb1, coulomb2];
        in_order(
            [mass1, mass2, inertia1, inertia2],
            friction,
            [zero1, zero2, torque_factor],
            [length1, rotor],
        )
    }
}

/// What can be estimated among the numbers of the parameters, with the zeros and the factor.
pub(super) fn estimated<T>(numbers: [T; NUMBERS], instruments: [T; 3]) -> [T; PARAMETERS] {
    let [length1, _, mass1, mass2, _, _, inertia1, inertia2, others @ ..] = numbers;
    let [.., damping1, damping2, coulomb1, coulomb2, rotor] = others;
    let friction = [damping1, damping2, coulomb1, coulomb2];
    in_order([mass1, mass2, inertia1, inertia2], friction, instruments, [length1, rotor])
}

pub(super) fn in_order<T>(
    [mass1, mass2, inertia1, inertia2]: [T; 4],
    [damping1, damping2, coulomb1, coulomb2]: [T; 4],
    [zero1, zero2, factor]: [T; 3],
    [length1, rotor]: [T; 2],
) -> [T; PARAMETERS] {
    [
        zero1, zero2, mass1, mass2, inertia1, inertia2, damping1, damping2, coulomb1, coulomb2,
        factor, length1, rotor,
    ]
}

/// What is known of a parameter. Covariances have its given deviation as their unit.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(
        serialize = "S: serde::Serialize, [S; K]: serde::Serialize",
        deserialize = "S: serde::Deserialize<'de>, [S; K]: serde::Deserialize<'de>"
    ))
)]
pub(super) struct Parameter<S, const K: usize> {
    pub(super) deviation: S,
    /// The smallest and the largest number.
    pub(super) limits: [S; 2],
    /// The covariances with the state, and with each parameter.
    pub(super) with_state: [S; 4],
    pub(super) with_params: [S; K],
}

impl<S: Real, const K: usize> Parameter<S, K> {
    pub(super) const NONE: Self = Self {
        deviation: S::ZERO,
        limits: [S::ZERO; 2],
        with_state: [S::ZERO; 4],
        with_params: [S::ZERO; K],
    };
}
