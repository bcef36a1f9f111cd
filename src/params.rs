//! The parameters of an acrobot, in SI units, and which of them are valid.

use crate::action::Action;
use crate::arithmetic::Real;
use crate::error::{Allowed, Error};

/// Which equations of motion: those of the book, or those printed in the 1996 paper.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Dynamics {
    /// Sutton & Barto, *Reinforcement Learning: An Introduction*: the physical double pendulum.
    #[default]
    Book,
    /// Sutton, *Generalization in Reinforcement Learning* (NIPS 8, 1996): the same without the
    /// centrifugal term in θ̇1² of the second joint. It does not conserve energy.
    Nips,
}

/// Everything about an acrobot that a user may change; [`Params::DEFAULT`] is Gymnasium's.
///
/// All fields are in SI units. Link 1 hangs from the fixed joint and link 2 from the tip of link 1;
/// the motor sits between the two.
///
/// ```
/// use acrobot::{Dynamics, Params};
///
/// let params: Params<f32> = Params { dt: 0.05, dynamics: Dynamics::Nips, ..Params::default() };
/// assert!(params.validate().is_ok());
/// assert!(Params { mass1: 0.0, ..params }.validate().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Params<S = f64> {
    /// Length of link 1, m; above 0.
    pub length1: S,
    /// Length of link 2, m; above 0. The equations of motion do not contain it, and Gymnasium's
    /// goal does not either: only [`tip_height`](crate::tip_height) and drawings do.
    pub length2: S,
    /// Mass of link 1, kg; above 0.
    pub mass1: S,
    /// Mass of link 2, kg; above 0.
    pub mass2: S,
    /// Distance of link 1's centre of mass from its joint, m; 0 or more.
    pub center_of_mass1: S,
    /// Distance of link 2's centre of mass from its joint, m; 0 or more.
    pub center_of_mass2: S,
    /// Moment of inertia of link 1 about its centre of mass, kg m²; 0 or more, and above 0 where
    /// the centre of mass lies on the joint.
    pub inertia1: S,
    /// Moment of inertia of link 2 about its centre of mass, kg m²; as `inertia1`.
    pub inertia2: S,
    /// Acceleration of gravity, m/s², downwards; finite, 0 switches it off.
    pub gravity: S,
    /// Time that one step lasts, s; above 0.
    pub dt: S,
    /// Bound of |θ̇1| after a step, rad/s; above 0, and within `f32` as observations are.
    pub max_velocity1: S,
    /// Bound of |θ̇2| after a step, rad/s; as `max_velocity1`.
    pub max_velocity2: S,
    /// Torques of the three actions, N m, in the order of their numbers; finite.
    pub torques: [S; 3],
    /// Torque noise, N m: each step adds a uniform draw from [−noise, noise) to the torque; 0 or
    /// more, 0 draws nothing.
    pub torque_noise: S,
    /// Which equations of motion.
    pub dynamics: Dynamics,
}

impl Params<f64> {
    /// The parameters of Gymnasium's `Acrobot-v1`.
    pub const DEFAULT: Self = Self {
        length1: 1.0,
        length2: 1.0,
        mass1: 1.0,
        mass2: 1.0,
        center_of_mass1: 0.5,
        center_of_mass2: 0.5,
        inertia1: 1.0,
        inertia2: 1.0,
        gravity: 9.8,
        dt: 0.2,
        max_velocity1: 4.0 * core::f64::consts::PI,
        max_velocity2: 9.0 * core::f64::consts::PI,
        torques: [-1.0, 0.0, 1.0],
        torque_noise: 0.0,
        dynamics: Dynamics::Book,
    };
}

impl<S: Real> Default for Params<S> {
    /// [`Params::DEFAULT`], rounded to the scalar.
    #[inline]
    fn default() -> Self {
        Params::DEFAULT.cast()
    }
}

impl<S: Real> Params<S> {
    /// The same parameters in another scalar, each rounded to the nearest.
    #[must_use]
    #[inline]
    pub fn cast<T: Real>(&self) -> Params<T> {
        let to = |x: S| T::from_f64(x.to_f64());
        Params {
            length1: to(self.length1),
            length2: to(self.length2),
            mass1: to(self.mass1),
            mass2: to(self.mass2),
            center_of_mass1: to(self.center_of_mass1),
            center_of_mass2: to(self.center_of_mass2),
            inertia1: to(self.inertia1),
            inertia2: to(self.inertia2),
            gravity: to(self.gravity),
            dt: to(self.dt),
            max_velocity1: to(self.max_velocity1),
            max_velocity2: to(self.max_velocity2),
            torques: self.torques.map(to),
            torque_noise: to(self.torque_noise),
            dynamics: self.dynamics,
        }
    }

    /// The torque of an action, N m.
    #[must_use]
    #[inline]
    #[expect(
        clippy::indexing_slicing,
        reason = "there is a torque for every action"
    )]
    pub fn torque(&self, action: Action) -> S {
        self.torques[action as usize]
    }

    /// Checks every field against the range that its documentation gives.
    ///
    /// Valid parameters may still be extreme enough for a step to leave the range of the scalar;
    /// what happens then stands at [`Acrobot`](crate::Acrobot#what-cannot-be-represented).
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] with the first field that is out of its range.
    pub fn validate(&self) -> Result<(), Error> {
        use Allowed::{AboveZero, AboveZeroInF32, Finite, ZeroOrMore};

        let [negative, zero, positive] = self.torques;
        for (name, value, unit, allowed) in [
            ("length1", self.length1, "m", AboveZero),
            ("length2", self.length2, "m", AboveZero),
            ("mass1", self.mass1, "kg", AboveZero),
            ("mass2", self.mass2, "kg", AboveZero),
            ("center_of_mass1", self.center_of_mass1, "m", ZeroOrMore),
            ("center_of_mass2", self.center_of_mass2, "m", ZeroOrMore),
            ("inertia1", self.inertia1, "kg m²", ZeroOrMore),
            ("inertia2", self.inertia2, "kg m²", ZeroOrMore),
            ("gravity", self.gravity, "m/s²", Finite),
            ("dt", self.dt, "s", AboveZero),
            ("max_velocity1", self.max_velocity1, "rad/s", AboveZeroInF32),
            ("max_velocity2", self.max_velocity2, "rad/s", AboveZeroInF32),
            ("torques[0]", negative, "N m", Finite),
            ("torques[1]", zero, "N m", Finite),
            ("torques[2]", positive, "N m", Finite),
            ("torque_noise", self.torque_noise, "N m", ZeroOrMore),
        ] {
            allowed.check(name, value, unit)?;
        }

        // Without a moment of inertia about its joint a link has no determined acceleration.
        for (name, inertia, mass, center) in [
            ("inertia1", self.inertia1, self.mass1, self.center_of_mass1),
            ("inertia2", self.inertia2, self.mass2, self.center_of_mass2),
        ] {
            if inertia + mass * center * center <= S::ZERO {
                return Err(Error::OutOfRange {
                    name,
                    value: inertia.to_f64(),
                    unit: "kg m²",
                    allowed: "a finite number above 0 where the centre of mass lies on the joint",
                });
            }
        }
        Ok(())
    }
}
