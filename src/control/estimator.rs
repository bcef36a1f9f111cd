//! Estimates the state of a machine from its angles alone, and its parameters: an extended Kalman
//! filter.
//!
//! What the model does not say acts as a torque of the motor, whose variance follows the errors of
//! the predicted angles. After a push the velocities are in doubt, but not the parameters.

use super::error::ControlError;
use super::linearize::{LinearModel, MassMatrix};
use super::linearize_step::linearize_step;
use super::matrix::{Matrix, add_scaled, apply, diagonal, transpose};
use crate::arithmetic::Arithmetic;
use crate::error::{Error, Range};
use crate::math::Real;
use crate::math::sealed::Sealed as _;
use crate::physics::{
    Model, Params, Pendulum, State, directions, dry_friction, saturate, sin_cos, wrap,
};

/// The standard deviation of the velocities at first, rad/s.
const AT_FIRST: f64 = 10.0;
/// An angle is farther than so many standard deviations from its prediction only after a push.
const PUSH: f64 = 6.0;
/// The deviation of a parameter grows in each step by this part of the first one.
const DRIFT: f64 = 3e-5;
/// The variance of the torque is between these parts of the given one. At first it is the most, so
/// that wrong parameters do not count as motion.
const LEAST_NOISE: f64 = 1e-2;
const MOST_NOISE: f64 = 1e4;
/// An estimated parameter differs from the given one by at most so many deviations.
const MOST: f64 = 4.0;

/// The standard deviations of what an [`Estimator`] measures and of what acts on the machine.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Noise<S = f64> {
    /// Of a measured angle, rad; above 0. An encoder with n counts for a turn has 1.8 / n.
    pub angle: S,
    /// Of the torque that acts, N m; above 0. The estimator changes it between a tenth and a
    /// hundred times.
    pub torque: S,
}

/// Estimates the state of a machine, and `K` of its parameters: 0 or [`PARAMETERS`](Self::PARAMETERS).
///
/// In each `dt` of the parameters call [`measure`](Self::measure), decide, and call
/// [`step`](Self::step).
///
/// ```
/// use acrobot::control::{Estimator, Noise};
/// use acrobot::{Fast, Params};
///
/// let params = Params { dt: 0.002, ..Params::DEFAULT };
/// let noise = Noise { angle: 1.8 / 4096.0, torque: 0.05 };
/// let mut estimator = Estimator::<Fast>::new(params, noise)?;
/// for tick in 0..500 {
///     let angle = 0.01 * (tick as f32 * 0.002); // 0.01 rad/s
///     estimator.measure([angle, 0.0])?;
///     estimator.step(0.0)?;
/// }
/// assert!((estimator.state().dtheta1 - 0.01).abs() < 0.01);
/// # Ok::<(), acrobot::control::ControlError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Estimator<A: Arithmetic, const K: usize = 0> {
    model: Pendulum<A>,
    given: Params<A::Scalar>,
    noise: Noise<A::Scalar>,
    /// The variance of the torque, (N m)².
    torque: A::Scalar,
    /// The covariances of the state. `None` before a measurement.
    of_state: Option<Matrix<A::Scalar>>,
    parameters: [Parameter<A::Scalar, K>; K],
}

/// What is known of a parameter.
#[derive(Clone, Copy, Debug)]
struct Parameter<S, const K: usize> {
    /// The standard deviation at first.
    deviation: S,
    /// The covariances with the state, and with each parameter.
    with_state: [S; 4],
    with_params: [S; K],
}

impl<A: Arithmetic> Estimator<A> {
    /// An estimator of the state. The first measurement sets it.
    ///
    /// # Errors
    ///
    /// Those of [`Pendulum::new`], and a noise is not finite and above 0.
    pub fn new(params: Params<A::Scalar>, noise: Noise<A::Scalar>) -> Result<Self, Error> {
        Self::build(params, noise, [])
    }
}

/// The parameters that can be estimated: all that a motion tells.
const PARAMETERS: usize = 10;

/// Those among the numbers of the parameters.
fn estimated<T>(numbers: [T; 21]) -> [T; PARAMETERS] {
    let [length1, _, mass1, mass2, _, _, inertia1, inertia2, others @ ..] = numbers;
    let [.., viscous1, viscous2, coulomb1, coulomb2, rotor] = others;
    [mass1, mass2, length1, inertia1, inertia2, viscous1, viscous2, coulomb1, coulomb2, rotor]
}

impl<A: Arithmetic> Estimator<A, PARAMETERS> {
    /// An estimator of the state and of the parameters `mass1`, `mass2`, `length1`, `inertia1`,
    /// `inertia2`, `friction`, `coulomb` and `rotor`, given the standard deviation of each in its
    /// unit; one of 0 is known. Other fields of `deviations` do not count.
    ///
    /// # Errors
    ///
    /// Those of [`new`](Estimator::new), and a deviation is not finite, below 0, or that of a
    /// friction or of the rotor in an arithmetic without friction.
    pub fn with_params(
        params: Params<A::Scalar>,
        deviations: Params<A::Scalar>,
        noise: Noise<A::Scalar>,
    ) -> Result<Self, Error> {
        let deviations = estimated(deviations.numbers());
        for (i, (name, deviation)) in deviations.into_iter().enumerate() {
            let (value, unit) = (deviation.to_f64(), "its unit");
            Range::AtLeastZero.check(name, value, unit)?;
            if i >= 5 && !A::HAS_FRICTION && value > 0.0 {
                let rule = "known unless the arithmetic is Damped, in";
                return Err(Error::OutOfRange { name, value, unit, rule });
            }
        }
        Self::build(params, noise, deviations.map(|(_, deviation)| deviation))
    }
}

impl<A: Arithmetic, const K: usize> Estimator<A, K> {
    /// How many parameters [`with_params`](Estimator::with_params) estimates.
    pub const PARAMETERS: usize = PARAMETERS;

    fn build(
        params: Params<A::Scalar>,
        noise: Noise<A::Scalar>,
        deviations: [A::Scalar; K],
    ) -> Result<Self, Error> {
        Range::AboveZero.check("angle", noise.angle.to_f64(), "rad")?;
        Range::AboveZero.check("torque", noise.torque.to_f64(), "N m")?;
        let zero = A::Scalar::ZERO;
        let mut parameters = deviations.map(|deviation| Parameter {
            deviation,
            with_state: [zero; 4],
            with_params: [zero; K],
        });
        for (i, parameter) in parameters.iter_mut().enumerate() {
            parameter.doubt(i, parameter.deviation);
        }
        Ok(Self {
            model: Pendulum::new(params, State::HANGING)?,
            given: params,
            noise,
            torque: noise.torque * noise.torque * A::Scalar::from_f64(MOST_NOISE),
            of_state: None,
            parameters,
        })
    }

    /// The estimated state.
    #[must_use]
    pub fn state(&self) -> State<A::Scalar> {
        self.model.state()
    }

    /// The estimated parameters.
    #[must_use]
    pub fn params(&self) -> &Params<A::Scalar> {
        self.model.params()
    }

    /// The standard deviations of the state, rad and rad/s. `None` before a measurement.
    #[must_use]
    pub fn deviations(&self) -> Option<[A::Scalar; 4]> {
        self.of_state.as_ref().map(|covariances| diagonal(covariances).map(A::Scalar::sqrt))
    }

    /// Corrects the estimate by measured angles θ1 and θ2, rad. The first ones are taken as they
    /// are, with velocities of 0.
    ///
    /// # Errors
    ///
    /// An angle is not finite.
    pub fn measure(&mut self, [theta1, theta2]: [A::Scalar; 2]) -> Result<(), Error> {
        let zero = A::Scalar::ZERO;
        let measured = State { theta1, theta2, dtheta1: zero, dtheta2: zero };
        measured.validate()?;
        match self.of_state {
            None => {
                let noises = [self.noise.angle, A::Scalar::from_f64(AT_FIRST)];
                let [angle, velocity] = noises.map(|x| x * x);
                self.of_state = Some(spread([angle, angle, velocity, velocity]));
                self.model.set_state(measured)
            }
            Some(of_state) => {
                let of_state = self.correct::<0>(theta1, of_state);
                self.of_state = Some(self.correct::<1>(theta2, of_state));
                Ok(())
            }
        }
    }

    /// Corrects by the angle of joint `I`. Returns the covariances of the state.
    #[expect(clippy::indexing_slicing, reason = "I is 0 or 1")]
    fn correct<const I: usize>(
        &mut self,
        angle: A::Scalar,
        mut of_state: Matrix<A::Scalar>,
    ) -> Matrix<A::Scalar> {
        let number = A::Scalar::from_f64;
        let mut y: [A::Scalar; 4] = self.model.state().into();
        let error = wrap(angle - y[I]);
        let square = error * error;
        let of_angle = self.noise.angle * self.noise.angle;
        let ratio = square / (of_state[I][I] + of_angle);
        self.follow(ratio);
        if ratio > number(PUSH * PUSH) {
            // The velocities are in doubt by as much as the error needs in one step.
            let dt = self.model.params().dt;
            let of_velocity = square / (dt * dt);
            let [of_angle1, of_angle2, ..] =
                diagonal(&of_state).map(|x| if x > square { x } else { square });
            of_state = spread([of_angle1, of_angle2, of_velocity, of_velocity]);
            self.parameters.iter_mut().for_each(|x| x.with_state = [A::Scalar::ZERO; 4]);
        }

        let row = of_state[I];
        let inverse = A::Scalar::ONE / (row[I] + of_angle);
        let gain = row.map(|x| x * inverse);
        add_scaled(&mut y, error, &gain);
        for (covariances, x) in of_state.iter_mut().zip(row) {
            add_scaled(covariances, -x, &gain);
        }
        let with_angle = self.parameters.map(|parameter| parameter.with_state[I]);
        let mut params = *self.model.params();
        let places =
            estimated(params.numbers_mut()).into_iter().zip(estimated(self.given.numbers()));
        for ((parameter, x), (place, (name, given))) in
            self.parameters.iter_mut().zip(with_angle).zip(places)
        {
            add_scaled(&mut parameter.with_state, -x, &gain);
            let part = x * inverse;
            for (covariance, x) in parameter.with_params.iter_mut().zip(with_angle) {
                *covariance = *covariance - part * x;
            }
            let most = number(MOST) * parameter.deviation;
            *place = given + saturate(*place + part * error - given, most);
            if *place < A::Scalar::ZERO && name != "rotor" {
                *place = A::Scalar::ZERO;
            }
        }
        // Parameters that no machine has change nothing.
        let _ = self.model.set_params(params);
        let _ = self.model.set_state(y.into());
        of_state
    }

    /// Lets the variance of the torque follow the square of an error, relative to its variance.
    fn follow(&mut self, ratio: A::Scalar) {
        let number = A::Scalar::from_f64;
        let within = |x, low, high| {
            if x < low {
                low
            } else if x > high {
                high
            } else {
                x
            }
        };
        let ratio = within(ratio, A::Scalar::ZERO, number(12.0));
        let torque = self.torque * (A::Scalar::ONE + number(0.02) * (ratio - A::Scalar::ONE));
        let given = self.noise.torque * self.noise.torque;
        self.torque = within(torque, given * number(LEAST_NOISE), given * number(MOST_NOISE));
    }

    /// Takes a step of `dt` with a torque, N m. Before a measurement it does nothing.
    ///
    /// # Errors
    ///
    /// The torque is not finite, or a derivative overflows.
    pub fn step(&mut self, torque: A::Scalar) -> Result<(), ControlError> {
        let number = A::Scalar::from_f64;
        let LinearModel { a, b } = linearize_step(&self.model, torque)?;
        let Some(of_state) = self.of_state else { return Ok(()) };
        let before: [A::Scalar; 4] = self.model.state().into();
        self.model.step(torque)?;

        // A P Aᵀ, and the parts of the parameters and of the torque.
        let half = transpose(&of_state.map(|row| apply(&a, &row)));
        let mut of_state = half.map(|row| apply(&a, &row));
        let slopes: [[A::Scalar; 4]; K] = self.slopes(before);
        for (i, (parameter, slope)) in self.parameters.iter_mut().zip(&slopes).enumerate() {
            let moved = apply(&a, &parameter.with_state);
            parameter.with_state = moved;
            for (slope, x) in slopes.iter().zip(&parameter.with_params) {
                add_scaled(&mut parameter.with_state, *x, slope);
            }
            for (row, (moved, x)) in of_state.iter_mut().zip(moved.into_iter().zip(slope)) {
                add_scaled(row, moved, slope);
                add_scaled(row, *x, &parameter.with_state);
            }
            parameter.doubt(i, number(DRIFT) * parameter.deviation);
        }
        for (row, x) in of_state.iter_mut().zip(b) {
            add_scaled(row, self.torque * x, &b);
        }
        // What the model does not say, and rounding.
        let [angle, velocity] = [1e-6, 1e-3].map(|x| number(x * x));
        let [one, half] = [A::Scalar::ONE, A::Scalar::HALF];
        let (transposed, noise) =
            (transpose(&of_state), spread([angle, angle, velocity, velocity]));
        for (row, (other, noise)) in of_state.iter_mut().zip(transposed.iter().zip(&noise)) {
            *row = row.map(|x| x * half);
            add_scaled(row, half, other);
            add_scaled(row, one, noise);
        }
        self.of_state = Some(of_state);
        Ok(())
    }

    /// The derivatives of the last step, from the state before, by each parameter: those of the
    /// accelerations in the middle of the step.
    fn slopes(&self, before: [A::Scalar; 4]) -> [[A::Scalar; 4]; K] {
        let mut slopes = [[A::Scalar::ZERO; 4]; K];
        if K > 0 {
            let model = self.model.model();
            let (half, dt) = (model.constants.half_dt, model.params.dt);
            let [_, _, dtheta1, dtheta2]: [A::Scalar; 4] = self.model.state().into();
            let [theta1, theta2, before1, before2] = before;
            let rates =
                [(before1, dtheta1), (before2, dtheta2)].map(|(x, y)| (x + y) * A::Scalar::HALF);
            let angles = [theta1 + half * rates[0], theta2 + half * rates[1]];
            let accelerations = [(dtheta1 - before1) / dt, (dtheta2 - before2) / dt];
            let found = by_params::<A>(model, angles, rates, accelerations);
            for (slope, [by1, by2]) in slopes.iter_mut().zip(found) {
                *slope = [half * (dt * by1), half * (dt * by2), dt * by1, dt * by2];
            }
        }
        slopes
    }
}

impl<S: Real, const K: usize> Parameter<S, K> {
    /// Adds a standard deviation to that of this parameter, which is at place `i`.
    fn doubt(&mut self, i: usize, deviation: S) {
        if let Some(own) = self.with_params.get_mut(i) {
            *own = *own + deviation * deviation;
        }
    }
}

/// A matrix with this diagonal.
fn spread<S: Real>([a, b, c, d]: [S; 4]) -> Matrix<S> {
    let o = S::ZERO;
    [[a, o, o, o], [o, b, o, o], [o, o, c, o], [o, o, o, d]]
}

/// The derivatives of \[θ̈1, θ̈2\] by each parameter: M⁻¹ (∂f/∂p − ∂M/∂p q̈), as in `partials`.
fn by_params<A: Arithmetic>(
    model: &Model<A::Scalar>,
    angles: [A::Scalar; 2],
    [dtheta1, dtheta2]: [A::Scalar; 2],
    [ddtheta1, ddtheta2]: [A::Scalar; 2],
) -> [[A::Scalar; 2]; PARAMETERS] {
    let (zero, one) = (A::Scalar::ZERO, A::Scalar::ONE);
    let params = &model.params;
    let sines = sin_cos::<A>(angles);
    let [_, (sin2, cos2)] = sines;
    let [(sin1, _), (sin_sum, _)] = directions(sines);
    let (l1, lc1, lc2) = (params.length1, params.center_of_mass1, params.center_of_mass2);
    let (dbeta, ddbeta) = (dtheta1 + dtheta2, ddtheta1 + ddtheta2);
    let nips = model.constants.nips;
    // Of l1 lc2 m2: what the links do to each other.
    let square = dtheta1 * dtheta1;
    let on_link1 = sin2 * (dbeta * dbeta - nips * square) - cos2 * ddbeta;
    let on_link2 = -(sin2 * ((one - nips) * square)) - cos2 * ddtheta1;
    let weight1 = params.gravity * sin1;
    let weight2 = params.gravity * sin_sum;
    let [dry1, dry2] =
        [dtheta1, dtheta2].map(|dtheta| dry_friction::<A, A::Scalar>(model, dtheta).0);
    let mass = MassMatrix::new::<A>(model, (sin2, cos2));
    [
        [-(lc1 * (weight1 + lc1 * ddtheta1)), zero],
        [
            l1 * (lc2 * on_link1 - weight1 - l1 * ddtheta1),
            lc2 * (l1 * on_link2 - weight2 - lc2 * ddbeta),
        ],
        [
            params.mass2 * (lc2 * on_link1 - weight1 - (l1 + l1) * ddtheta1),
            params.mass2 * lc2 * on_link2,
        ],
        [-ddtheta1, zero],
        [zero, -ddbeta],
        [-dtheta1, zero],
        [dtheta2, -dtheta2],
        [-dry1, zero],
        [dry2, -dry2],
        [ddbeta, ddtheta1],
    ]
    .map(|forces| mass.solve(forces))
}
