//! The parameters, in SI units, and their ranges.

use crate::action::Action;
use crate::error::{Error, Range};
use crate::math::Real;

/// Which equations of motion to use: Gymnasium's `book_or_nips`.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Dynamics {
    /// Those of Sutton & Barto, *Reinforcement Learning: An Introduction*: the physical double
    /// pendulum.
    #[default]
    Book,
    /// Those printed in Sutton, *Generalization in Reinforcement Learning* (NIPS 8, 1996), without
    /// the centrifugal term in θ̇1² of the second joint. Energy is not conserved.
    Nips,
}

/// The parameters of an acrobot. [`Params::DEFAULT`] has Gymnasium's values.
///
/// Link 1 hangs from the fixed joint and link 2 from the tip of link 1. The motor is between the
/// two links. All fields are in SI units; [`validate`](Self::validate) checks their ranges.
// bindings/abi/derive.py copies the first paragraph of each field to other languages.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Params<S = f64> {
    /// Length of link 1, m; above 0.
    pub length1: S,
    /// Length of link 2, m; above 0. Only the tip's height and drawings depend on it.
    pub length2: S,
    /// Mass of link 1, kg; above 0.
    pub mass1: S,
    /// Mass of link 2, kg; above 0.
    pub mass2: S,
    /// Distance of link 1's centre of mass from its joint, m; 0 or more.
    pub center_of_mass1: S,
    /// Distance of link 2's centre of mass from its joint, m; 0 or more.
    pub center_of_mass2: S,
    /// Moment of inertia of link 1 about its centre of mass, kg m²; 0 or more, and above 0 if the
    /// centre of mass is on the joint.
    pub inertia1: S,
    /// Moment of inertia of link 2 about its centre of mass, kg m²; as `inertia1`.
    pub inertia2: S,
    /// Acceleration of gravity, m/s², downwards; finite, 0 for none.
    pub gravity: S,
    /// Duration of one step, s; above 0.
    pub dt: S,
    #[cfg_attr(feature = "serde", serde(deserialize_with = "or_infinite"))]
    /// Bound of |θ̇1| after a step, rad/s; at least 1.2e-38. Infinity, for none, is stored as
    /// 3.4e38, the largest number in single precision, which observations have.
    ///
    /// JSON's writers make `null` of infinity, which loads as infinity.
    pub max_velocity1: S,
    #[cfg_attr(feature = "serde", serde(deserialize_with = "or_infinite"))]
    /// Bound of |θ̇2| after a step, rad/s; as `max_velocity1`.
    pub max_velocity2: S,
    /// Torques of the three actions, N m, in the order of their numbers; finite.
    ///
    /// They do not limit `step_torque`.
    pub torques: [S; 3],
    /// Torque noise, N m; 0 or more. Each step adds a uniform draw from [−noise, noise) to the
    /// torque; 0 draws nothing.
    ///
    /// The draw is rounded to the scalar.
    pub torque_noise: S,
    /// The equations of motion: of Sutton and Barto's book, or of the paper of 1996 (NIPS 8).
    pub dynamics: Dynamics,
    /// Viscous friction of the fixed joint, which resists θ̇1 with a torque in proportion to it,
    /// N m s/rad; 0 or more.
    ///
    /// This and the fields below must be 0 in an arithmetic without friction: see
    /// [`Damped`](crate::arithmetic::Damped).
    pub damping1: S,
    /// Viscous friction of the elbow, which resists θ̇2; as `damping1`.
    pub damping2: S,
    /// Coulomb friction of the fixed joint: its torque as soon as the joint turns, N m; 0 or more.
    ///
    /// Below 0.02 rad/s, or [a larger velocity where `dt` and viscous friction need
    /// it](crate::guide::equations#friction-and-rotors), it is smooth.
    pub coulomb1: S,
    /// Coulomb friction of the elbow; as `coulomb1`.
    pub coulomb2: S,
    /// What a geared rotor in the elbow takes from the coupling of the links, kg m²; finite, and so
    /// small that the mass matrix is positive definite. A rotor of moment of inertia J behind a
    /// gear g adds (g + 1)² J to `inertia1`, g² J to `inertia2`, and (g + 1) g J here.
    ///
    /// [`with_rotor`](Self::with_rotor) does that.
    pub rotor: S,
}

/// A number, or infinity for `null` in a format for humans. Others store infinity as it is.
#[cfg(feature = "serde")]
fn or_infinite<'de, V, D>(deserializer: D) -> Result<V, D::Error>
where
    V: serde::Deserialize<'de>,
    D: serde::Deserializer<'de>,
{
    use serde::de::IntoDeserializer as _;
    if !deserializer.is_human_readable() {
        return V::deserialize(deserializer);
    }
    let number = <Option<V> as serde::Deserialize>::deserialize(deserializer)?;
    number.map_or_else(|| V::deserialize(f64::INFINITY.into_deserializer()), Ok)
}

impl<S: Real> Default for Params<S> {
    /// [`Params::DEFAULT`].
    // Built field by field: copying the constant would call `memcpy`, 1 KB of flash.
    #[inline]
    fn default() -> Self {
        Params::<f64>::ACROBOT.cast()
    }
}

impl<S: Real> Params<S> {
    /// The torque of an action, N m.
    #[must_use]
    #[inline]
    #[expect(clippy::indexing_slicing, reason = "each action has a torque")]
    pub fn torque(&self, action: Action) -> S {
        self.torques[action as usize]
    }

    /// The same parameters in another scalar. Each number is rounded to the nearest.
    #[must_use]
    #[inline]
    pub fn cast<T: Real>(&self) -> Params<T> {
        self.map(|x| T::from_f64(x.to_f64()))
    }

    /// Sets the inertias of both links about their joints, kg m². One that is too small for the
    /// centre of mass of link 2 moves this centre and masses, without a change of the motion: only
    /// the forces in the joints differ.
    #[must_use]
    pub fn with_inertias_about_joints(mut self, [mut inertia1, inertia2]: [S; 2]) -> Self {
        let moment2 = self.mass2 * self.center_of_mass2; // kg m
        self.inertia2 = inertia2 - moment2 * self.center_of_mass2;
        if self.inertia2 < S::ZERO {
            self.inertia2 = S::ZERO;
            self.center_of_mass2 = inertia2 / moment2;
            let more = moment2 / self.center_of_mass2 - self.mass2;
            self.mass2 = self.mass2 + more;
            // Link 1 carries the difference at its tip.
            let moment1 = self.mass1 * self.center_of_mass1 - more * self.length1;
            self.center_of_mass1 = moment1 / self.mass1;
            inertia1 = inertia1 - more * (self.length1 * self.length1);
        }
        let lc1 = self.center_of_mass1;
        self.inertia1 = inertia1 - self.mass1 * (lc1 * lc1);
        self
    }

    /// Adds the rotor of a motor in the elbow, which stands on link 1 and turns by `gear` for each
    /// turn of link 2 against it, in the opposite direction: its moment of inertia about its axis,
    /// kg m². A negative `gear` turns in the same direction. It adds to the inertias of both links,
    /// and takes from their coupling. A rotor in the fixed joint is gear² `inertia` more of
    /// `inertia1`.
    #[must_use]
    pub fn with_rotor(mut self, inertia: S, gear: S) -> Self {
        let more = gear + S::from_f64(1.0);
        self.inertia1 = self.inertia1 + more * more * inertia;
        self.inertia2 = self.inertia2 + gear * gear * inertia;
        self.rotor = self.rotor + more * gear * inertia;
        self
    }
}

/// How many numbers the parameters are.
pub(crate) const NUMBERS: usize = 21;

/// The name, unit and range of each number.
pub(crate) const FIELDS: [(&str, &str, Range); NUMBERS] = {
    use Range::{AboveZero, AtLeastNormalF32, AtLeastZero, Finite};
    [
        ("length1", "m", AboveZero),
        ("length2", "m", AboveZero),
        ("mass1", "kg", AboveZero),
        ("mass2", "kg", AboveZero),
        ("center_of_mass1", "m", AtLeastZero),
        ("center_of_mass2", "m", AtLeastZero),
        ("inertia1", "kg m²", AtLeastZero),
        ("inertia2", "kg m²", AtLeastZero),
        ("gravity", "m/s²", Finite),
        ("dt", "s", AboveZero),
        ("max_velocity1", "rad/s", AtLeastNormalF32),
        ("max_velocity2", "rad/s", AtLeastNormalF32),
        ("torques[0]", "N m", Finite),
        ("torques[1]", "N m", Finite),
        ("torques[2]", "N m", Finite),
        ("torque_noise", "N m", AtLeastZero),
        ("damping1", "N m s/rad", AtLeastZero),
        ("damping2", "N m s/rad", AtLeastZero),
        ("coulomb1", "N m", AtLeastZero),
        ("coulomb2", "N m", AtLeastZero),
        ("rotor", "kg m²", Finite),
    ]
};
/// The last fields, from here on, must be 0 in an arithmetic without friction.
const OF_FRICTION: usize = NUMBERS - 5;

impl<S: Copy> Params<S> {
    /// The name and the value of each number, in the order of the fields.
    #[must_use]
    pub fn numbers(&self) -> [(&'static str, S); NUMBERS] {
        let mut numbers = *self;
        let mut names = FIELDS.into_iter();
        numbers.numbers_mut().map(|number| (names.next().map_or("", |(name, ..)| name), *number))
    }

    /// Each number, to change it, in the order of the fields.
    pub const fn numbers_mut(&mut self) -> [&mut S; NUMBERS] {
        let [negative, zero, positive] = &mut self.torques;
        [
            &mut self.length1,
            &mut self.length2,
            &mut self.mass1,
            &mut self.mass2,
            &mut self.center_of_mass1,
            &mut self.center_of_mass2,
            &mut self.inertia1,
            &mut self.inertia2,
            &mut self.gravity,
            &mut self.dt,
            &mut self.max_velocity1,
            &mut self.max_velocity2,
            negative,
            zero,
            positive,
            &mut self.torque_noise,
            &mut self.damping1,
            &mut self.damping2,
            &mut self.coulomb1,
            &mut self.coulomb2,
            &mut self.rotor,
        ]
    }

    /// Applies `f` to each number, in the order of the fields.
    ///
    /// ```
    /// use acrobot::Params;
    ///
    /// let doubled = Params::<f64>::DEFAULT.map(|x| 2.0 * x);
    /// assert_eq!(doubled.length1, 2.0); // m
    /// ```
    #[must_use]
    pub fn map<T>(&self, mut f: impl FnMut(S) -> T) -> Params<T> {
        self.zip(self, |x, _| f(*x))
    }

    /// Applies `f` to each pair of numbers, in the order of the fields. The dynamics are those of
    /// `self`.
    #[inline(always)]
    pub(crate) fn zip<T: Copy, U>(
        &self,
        other: &Params<T>,
        mut f: impl FnMut(&S, &T) -> U,
    ) -> Params<U> {
        let ([negative, zero, positive], torques) = (&self.torques, &other.torques);
        Params {
            length1: f(&self.length1, &other.length1),
            length2: f(&self.length2, &other.length2),
            mass1: f(&self.mass1, &other.mass1),
            mass2: f(&self.mass2, &other.mass2),
            center_of_mass1: f(&self.center_of_mass1, &other.center_of_mass1),
            center_of_mass2: f(&self.center_of_mass2, &other.center_of_mass2),
            inertia1: f(&self.inertia1, &other.inertia1),
            inertia2: f(&self.inertia2, &other.inertia2),
            gravity: f(&self.gravity, &other.gravity),
            dt: f(&self.dt, &other.dt),
            max_velocity1: f(&self.max_velocity1, &other.max_velocity1),
            max_velocity2: f(&self.max_velocity2, &other.max_velocity2),
            torques: [f(negative, &torques[0]), f(zero, &torques[1]), f(positive, &torques[2])],
            torque_noise: f(&self.torque_noise, &other.torque_noise),
            dynamics: self.dynamics,
            damping1: f(&self.damping1, &other.damping1),
            damping2: f(&self.damping2, &other.damping2),
            coulomb1: f(&self.coulomb1, &other.coulomb1),
            coulomb2: f(&self.coulomb2, &other.coulomb2),
            rotor: f(&self.rotor, &other.rotor),
        }
    }
}

for_f32_and_f64! {
    impl Params<S> {
        /// [`Params::validate`], also in a `const`, where neither `?` nor `for` is allowed.
        pub(crate) const fn check(&self, has_friction: bool) -> Result<(), Error> {
            let mut params = *self;
            let (mut fields, mut numbers): (&[_], &[_]) = (&FIELDS, &params.numbers_mut());
            while let ([(name, unit, range), fields_left @ ..], [number, left @ ..]) =
                (fields, numbers)
            {
                let value = **number as f64;
                if let Err(error) = range.check(name, value, unit) {
                    return Err(error);
                }
                let is_friction = fields.len() <= FIELDS.len() - OF_FRICTION;
                if is_friction && !has_friction && value != 0.0 {
                    let rule = "0 unless the arithmetic is Damped, in";
                    return Err(Error::OutOfRange { name, value, unit, rule });
                }
                (fields, numbers) = (fields_left, left);
            }
            let on_the_joint = "above 0 if the centre of mass is on the joint, in";
            let [link1, tip, link2, coupling] = self.inertias();
            let most = self.rotor.abs() + coupling;
            let is_definite = (link1 + tip) * link2 > most * most; // false for NaN
            let (name, value, rule) = if link1 <= 0.0 {
                ("inertia1", self.inertia1, on_the_joint)
            } else if link2 <= 0.0 {
                ("inertia2", self.inertia2, on_the_joint)
            } else if self.rotor != 0.0 && !is_definite {
                ("rotor", self.rotor, "so small that the mass matrix is positive definite, in")
            } else {
                return Ok(());
            };
            Err(Error::OutOfRange { name, value: value as f64, unit: "kg m²", rule })
        }

        /// The moments of gravity, m1 lc1 + m2 l1 and m2 lc2, kg m.
        pub(crate) const fn moments(&self) -> [S; 2] {
            let Self { mass1, mass2, length1, center_of_mass1, center_of_mass2, .. } = *self;
            [mass1 * center_of_mass1 + mass2 * length1, mass2 * center_of_mass2]
        }

        /// The inertias of link 1 about the fixed joint, of link 2's mass at its end, and of link 2
        /// about its joint, and the coupling of both links, kg m²: see [`Params::inertias_by`].
        pub(crate) const fn inertias(&self) -> [S; 4] {
            let (l1, lc1, lc2) = (self.length1, self.center_of_mass1, self.center_of_mass2);
            self.inertias_by([l1 * l1, lc1 * lc1, lc2 * lc2])
        }

        /// As [`Params::inertias`], given l1², lc1² and lc2². With the first two as one sum they
        /// are M of the absolute angles where the elbow is straight, except the rotor.
        pub(crate) const fn inertias_by(
            &self,
            [l1_squared, lc1_squared, lc2_squared]: [S; 3],
        ) -> [S; 4] {
            let Self { mass1, mass2, inertia1, inertia2, .. } = *self;
            let link1 = mass1 * lc1_squared + inertia1;
            let link2 = mass2 * lc2_squared + inertia2;
            let coupling = mass2 * self.length1 * self.center_of_mass2;
            [link1, mass2 * l1_squared, link2, coupling]
        }
    }
}

/// The moment of inertia of a capsule of 1 kg about an axis across its centre, kg m². The centres
/// of its hemispheres are 1 m apart. As in MuJoCo, its density is uniform.
const fn inertia_of_capsule(radius: f64) -> f64 {
    let (cylinder, sphere) = (1.0, 4.0 / 3.0 * radius);
    let whole = cylinder + sphere;
    let of_cylinder = (3.0 * radius * radius + 1.0) / 12.0;
    let of_sphere = 0.4 * radius * radius + 0.25 + 0.375 * radius;
    (cylinder * of_cylinder + sphere * of_sphere) / whole
}

for_f32_and_f64! {
    impl Params<S> {
        /// [`Params::cast`] in a `const`.
        pub(super) const fn round(mut params: Params) -> Self {
            let mut rounded = Self { dynamics: params.dynamics, ..Self::ACROBOT };
            let mut numbers: &mut [_] = &mut rounded.numbers_mut();
            let mut given: &[_] = &params.numbers_mut();
            while let ([number, others @ ..], [x, rest @ ..]) = (numbers, given) {
                **number = **x as S;
                (numbers, given) = (others, rest);
            }
            rounded
        }

        /// See [`Params::DEFAULT`].
        pub(super) const ACROBOT: Self = Self {
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
            max_velocity1: (4.0 * core::f64::consts::PI) as S,
            max_velocity2: (9.0 * core::f64::consts::PI) as S,
            torques: [-1.0, 0.0, 1.0],
            torque_noise: 0.0,
            dynamics: Dynamics::Book,
            damping1: 0.0, damping2: 0.0,
            coulomb1: 0.0, coulomb2: 0.0,
            rotor: 0.0,
        };

        /// See [`Params::SWINGUP`].
        pub(super) const CAPSULES: Self = Self {
            inertia1: inertia_of_capsule(0.05) as S,
            inertia2: inertia_of_capsule(0.049) as S,
            gravity: 9.81,
            dt: 0.01,
            max_velocity1: 1e30,
            max_velocity2: 1e30,
            torques: [-2.0, 0.0, 2.0],
            damping1: 0.05, damping2: 0.05,
            ..Self::ACROBOT
        };
    }
}
