//! The pendulum: parameters, a state, and quantities that follow from them.

use super::arithmetic::{Arithmetic, check_params, default_model, model};
use super::equations;
use super::geometry;
use super::model::{Defaults, Model, Modeled as _};
use super::params::Params;
use super::state::State;
use super::step::step;
use crate::error::{Error, Range};
use crate::math::{Real, SinCos};

/// A double pendulum with a motor between its links.
///
/// `A` is the [arithmetic](crate::arithmetic), which determines every bit.
/// [`Params::pendulum`](Params#method.pendulum) makes one in a `const`.
///
/// ```
/// use acrobot::Portable;
/// use acrobot::physics::Pendulum;
///
/// const HANGING: Pendulum<Portable> = Pendulum::hanging();
///
/// assert!((HANGING.energy() + 9.8 * (0.5 + 1.5)).abs() < 1e-12); // J
/// assert_eq!(HANGING.mass_matrix(), [[4.5, 1.75], [1.75, 1.25]]); // kg m²
/// assert_eq!(HANGING.positions(), [[0.0, -1.0], [0.0, -2.0]]); // m
///
/// let mut pendulum = HANGING;
/// pendulum.step(1.0)?; // N m
/// assert!(pendulum.tip_height() > -2.0); // m
/// # Ok::<(), acrobot::Error>(())
/// ```
///
/// # Results that are not finite
///
/// With extreme but valid parameters, states or torques a step can overflow. A step whose result is
/// not finite keeps the angles and sets both velocities to 0, in every arithmetic and in batches.
/// So no step hangs, panics or returns NaN.
#[derive(Clone, Debug)]
pub struct Pendulum<A: Arithmetic> {
    /// θ1, θ2, θ̇1 and θ̇2.
    y: [A::Scalar; 4],
    model: Model<A::Scalar>,
    /// Sines and cosines of θ1 and θ2, for the observation and the next step.
    sin_cos: [SinCos<A::Scalar>; 2],
    /// Whether `sin_cos` is up to date. After a `const` it is not: sines cannot be computed there.
    is_current: bool,
}

impl<A: Arithmetic> Pendulum<A> {
    /// A pendulum with the default parameters that hangs at rest.
    #[must_use]
    pub const fn hanging() -> Self {
        Self::from_model(const { default_model::<A, Defaults>() }, [A::Scalar::ZERO; 4])
    }

    /// A pendulum with these parameters in this state.
    ///
    /// # Errors
    ///
    /// Those of [`Params::validate`] and [`State::validate`], and [`Error::OutOfRange`] for
    /// friction in an arithmetic [without it](Arithmetic::HAS_FRICTION).
    pub fn new(params: Params<A::Scalar>, state: State<A::Scalar>) -> Result<Self, Error> {
        check_params::<A>(&params)?;
        state.validate()?;
        Ok(Self::new_unchecked(params, state))
    }

    /// A pendulum with this model in a state that is known to be finite.
    pub(crate) const fn from_model(model: Model<A::Scalar>, y: [A::Scalar; 4]) -> Self {
        Self { model, y, sin_cos: [(A::Scalar::ZERO, A::Scalar::ZERO); 2], is_current: false }
    }

    /// As [`new`](Self::new), with parameters and a state that are known to be valid.
    #[inline]
    pub(crate) fn new_unchecked(params: Params<A::Scalar>, state: State<A::Scalar>) -> Self {
        Self {
            model: model::<A>(params),
            sin_cos: sin_cos::<A>([state.theta1, state.theta2]),
            is_current: true,
            y: state.into(),
        }
    }

    /// Applies a torque, N m, for one dt. [`saturate`](super::saturate) limits it to that of a
    /// motor.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a torque that is not finite.
    #[inline]
    pub fn step(&mut self, torque: A::Scalar) -> Result<(), Error> {
        check_torque(torque)?;
        let (model, y, sin_cos) = self.parts();
        step::<A, A::Scalar>(model, y, sin_cos, torque);
        Ok(())
    }

    /// What a step reads and changes: the model, the state, its sines and cosines.
    #[inline]
    #[expect(clippy::type_complexity)]
    pub(crate) fn parts(
        &mut self,
    ) -> (&Model<A::Scalar>, &mut [A::Scalar; 4], &mut [SinCos<A::Scalar>; 2]) {
        if !self.is_current {
            self.compute_sines();
        }
        (&self.model, &mut self.y, &mut self.sin_cos)
    }

    /// The state.
    #[must_use]
    #[inline]
    pub fn state(&self) -> State<A::Scalar> {
        self.y.into()
    }

    /// Sets the state. Angles and velocities may be outside their bounds until the next step.
    ///
    /// # Errors
    ///
    /// Those of [`State::validate`].
    pub fn set_state(&mut self, state: State<A::Scalar>) -> Result<(), Error> {
        state.validate()?;
        self.set_state_unchecked(state);
        Ok(())
    }

    /// Removes the dry friction of joint 2. What else follows from the parameters stays.
    pub(crate) fn remove_coulomb2(&mut self) {
        self.model.params.coulomb2 = A::Scalar::ZERO;
    }

    /// As [`set_state`](Self::set_state), with a finite state. Returns its sines and cosines.
    pub(crate) fn set_state_unchecked(
        &mut self,
        state: State<A::Scalar>,
    ) -> [SinCos<A::Scalar>; 2] {
        self.y = state.into();
        self.compute_sines();
        self.sin_cos
    }

    #[inline(never)] // saves registers: a step seldom calls it
    fn compute_sines(&mut self) {
        self.sin_cos = sin_cos::<A>(self.angles());
        self.is_current = true;
    }

    /// The parameters.
    #[must_use]
    #[inline]
    pub fn params(&self) -> &Params<A::Scalar> {
        &self.model.params
    }

    /// Sets the parameters for the next steps. A pendulum ignores `torques` and `torque_noise`.
    ///
    /// # Errors
    ///
    /// Those of [`new`](Self::new).
    pub fn set_params(&mut self, params: Params<A::Scalar>) -> Result<(), Error> {
        check_params::<A>(&params)?;
        self.model = model::<A>(params);
        Ok(())
    }

    /// The positions of the elbow and of the tip, each \[x, y\] in m from the fixed joint, x to the
    /// right and y up.
    #[must_use]
    pub fn positions(&self) -> [[A::Scalar; 2]; 2] {
        geometry::positions(self.params(), self.sin_cos())
    }

    /// The height of link 2's tip above the fixed joint, m: −l1 cos θ1 − l2 cos(θ1 + θ2), from
    /// −(l1 + l2) hanging to l1 + l2 upright.
    #[must_use]
    pub fn tip_height(&self) -> A::Scalar {
        let [_, [_, height]] = self.positions();
        height
    }

    /// The derivative of the state, \[θ̇1, θ̇2, θ̈1, θ̈2\] in rad/s and rad/s², under a torque, N
    /// m, by the [equations](crate::guide::equations) of [`Params::dynamics`]. A torque that is not
    /// finite gives what IEEE 754 gives. Your own integrator [sets](Self::set_state) each state at
    /// which it needs the derivative.
    #[must_use]
    pub fn derivative(&self, torque: A::Scalar) -> [A::Scalar; 4] {
        equations::derivative::<A, A::Scalar>(&self.model, self.y, Some(self.sin_cos()), torque)
    }

    /// The mechanical energy, J. The potential energy is 0 at the height of the fixed joint.
    ///
    /// Without torque and friction, `Dynamics::Book` conserves it and `Dynamics::Nips` does not.
    /// Extreme velocities or parameters can make it infinite or NaN.
    #[must_use]
    pub fn energy(&self) -> A::Scalar {
        let [_, _, dtheta1, dtheta2] = self.y;
        let sin_cos = self.sin_cos();
        let [[m11, m12], [_, m22]] = self.mass_matrix();
        let momentum1 = m11 * dtheta1 + m12 * dtheta2;
        let momentum2 = m12 * dtheta1 + m22 * dtheta2;
        let kinetic = A::Scalar::from_f64(0.5) * (momentum1 * dtheta1 + momentum2 * dtheta2);
        let common = &self.model.constants;
        let [(_, cos1), (_, cos_sum)] = geometry::directions(sin_cos);
        kinetic - common.gravity1 * cos1 - common.gravity2 * cos_sum
    }

    /// The mass matrix M at the state, kg m², symmetric and positive definite. The kinetic energy
    /// is θ̇ᵀ M θ̇ / 2. Extreme parameters can make its elements infinite or NaN.
    #[must_use]
    pub fn mass_matrix(&self) -> [[A::Scalar; 2]; 2] {
        let [_, (_, cos2)] = self.sin_cos();
        let Model { params, constants } = &self.model;
        let [link1, tip, ..] = A::Scalar::inertias(params);
        let coupling = constants.coupling * cos2 - params.rotor;
        let d2 = constants.link2 + coupling;
        [[link1 + tip + coupling + d2, d2], [d2, constants.link2]]
    }

    /// Adds impulses to both joints, N m s: θ̇ changes by M⁻¹ times them, without a bound. A hand
    /// that pulls for a step is the impulse of its torques times `dt` before the step.
    ///
    /// # Errors
    ///
    /// A velocity becomes infinite or NaN.
    pub fn push(&mut self, [impulse1, impulse2]: [A::Scalar; 2]) -> Result<(), Error> {
        let [[m11, m12], [_, m22]] = self.mass_matrix();
        let inverse = A::Scalar::from_f64(1.0) / (m11 * m22 - m12 * m12);
        let [theta1, theta2, dtheta1, dtheta2] = self.y;
        self.set_state(State {
            theta1,
            theta2,
            dtheta1: dtheta1 + (m22 * impulse1 - m12 * impulse2) * inverse,
            dtheta2: dtheta2 + (m11 * impulse2 - m12 * impulse1) * inverse,
        })
    }

    /// Sine and cosine of θ1, then of θ2, which the pendulum caches.
    #[must_use]
    #[inline]
    pub fn sin_cos(&self) -> [(A::Scalar, A::Scalar); 2] {
        if self.is_current { self.sin_cos } else { sin_cos::<A>(self.angles()) }
    }

    #[inline]
    pub(crate) fn model(&self) -> &Model<A::Scalar> {
        &self.model
    }

    #[inline]
    fn angles(&self) -> [A::Scalar; 2] {
        let [theta1, theta2, ..] = self.y;
        [theta1, theta2]
    }
}

for_f32_and_f64! {
    impl Params<S> {
        /// [`Pendulum::new`] in a `const`, for every arithmetic except `Host`, which squares with
        /// the C library:
        ///
        /// ```compile_fail,E0080
        /// use acrobot::arithmetic::Host;
        /// use acrobot::{Params, State};
        ///
        /// let pendulum = Params::<f64>::DEFAULT.pendulum::<Host>(State::HANGING);
        /// ```
        ///
        /// Its errors are those of [`Pendulum::new`].
        pub const fn pendulum<A: Arithmetic<Scalar = S>>(
            self,
            state: State<S>,
        ) -> Result<Pendulum<A>, Error> {
            const { assert!(A::SQUARES_IN_CONST, "a const cannot square as this arithmetic does") };
            if let Err(error) = self.check(A::HAS_FRICTION) {
                return Err(error);
            }
            if let Err(error) = state.check() {
                return Err(error);
            }
            let (l1, lc1, lc2) = (self.length1, self.center_of_mass1, self.center_of_mass2);
            let squares = [l1 * l1, lc1 * lc1, lc2 * lc2];
            let model = Model::<S>::new(A::FORM, A::HAS_FRICTION, self, squares);
            let State { theta1, theta2, dtheta1, dtheta2 } = state;
            Ok(Pendulum::from_model(model, [theta1, theta2, dtheta1, dtheta2]))
        }
    }
}

impl<A: Arithmetic> PartialEq for Pendulum<A> {
    /// Compares parameters and state. Extreme parameters can make constants NaN.
    fn eq(&self, other: &Self) -> bool {
        self.params() == other.params() && self.y == other.y
    }
}

#[cfg(feature = "defmt")]
impl<A: Arithmetic> defmt::Format for Pendulum<A> {
    fn format(&self, f: defmt::Formatter<'_>) {
        let (params, state) = (self.params(), self.state());
        defmt::write!(f, "Pendulum {{ params: {}, state: {} }}", params, state);
    }
}

#[cfg(feature = "serde")]
impl<A: Arithmetic> serde::Serialize for Pendulum<A> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        (self.params(), self.state()).serialize(serializer)
    }
}

#[cfg(feature = "serde")]
impl<'de, A: Arithmetic> serde::Deserialize<'de> for Pendulum<A> {
    /// Rejects what `new` rejects.
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let (params, state) = serde::Deserialize::deserialize(deserializer)?;
        Self::new(params, state).map_err(serde::de::Error::custom)
    }
}

pub(crate) fn check_torque<S: Real>(torque: S) -> Result<(), Error> {
    Range::Finite.check("torque", torque.to_f64(), "N m")
}

/// Sines and cosines of angles of any size.
pub(crate) fn sin_cos<A: Arithmetic>(angles: [A::Scalar; 2]) -> [SinCos<A::Scalar>; 2] {
    /// Out of line to save flash: a step does not call it.
    #[inline(never)]
    fn sin_cos_out_of_line<A: Arithmetic>(x: A::Scalar) -> SinCos<A::Scalar> {
        A::sin_cos(x)
    }
    let [theta1, theta2] = angles;
    [sin_cos_out_of_line::<A>(theta1), sin_cos_out_of_line::<A>(theta2)]
}
