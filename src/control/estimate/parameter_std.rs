//! Which parameters are estimated, and how wrong they may be.

use crate::physics::NUMBERS;

/// The parameters that can be estimated: all on which a motion depends.
pub(super) const PARAMETERS: usize = 10;

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
}

impl<S: Copy> ParameterStd<S> {
    /// In the order of [`estimated`].
    pub(super) fn numbers(&self) -> [S; PARAMETERS] {
        let &Self { mass1, mass2, length1, inertia1, inertia2, .. } = self;
        let &Self { damping1, damping2, coulomb1, coulomb2, rotor, .. } = self;
        [mass1, mass2, length1, inertia1, inertia2, damping1, damping2, coulomb1, coulomb2, rotor]
    }
}

/// These among the numbers of the parameters.
pub(super) fn estimated<T>(numbers: [T; NUMBERS]) -> [T; PARAMETERS] {
    let [length1, _, mass1, mass2, _, _, inertia1, inertia2, others @ ..] = numbers;
    let [.., viscous1, viscous2, coulomb1, coulomb2, rotor] = others;
    [mass1, mass2, length1, inertia1, inertia2, viscous1, viscous2, coulomb1, coulomb2, rotor]
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
