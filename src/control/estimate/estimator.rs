//! Estimates the state of a machine from its angles alone, and its parameters: an extended Kalman
//! filter.
//!
//! What the model does not say acts as a torque of the motor, whose variance follows the errors of
//! the predicted angles. After a push the velocities are in doubt, but not the parameters.
//!
//! Constants have the machine's own units or none. Those that count measurements are of statistics,
//! which need a number of samples and not a time.

use core::array::from_fn;

use super::noise::{Given, Noise};
use super::parameter_std::{
    FRICTION, PARAMETERS, Parameter, ParameterStd, ROTOR, ZEROS, estimated,
};
use crate::arithmetic::Arithmetic;
use crate::error::{Error, Range};
use crate::math::Real;
use crate::math::matrix::{Matrix, add_outer, add_scaled, check_finite, diagonal, spread};
use crate::math::sealed::Sealed as _;
use crate::physics::{FIELDS, Params, Pendulum, State, plus_scaled, saturate, wrap};

/// An angle is farther than so many standard deviations from its prediction only after a push.
const PUSH: f64 = 6.0;
/// The variance of the torque follows the errors of about 1/0.02 = 50 measurements, of which none
/// counts for more than so many variances.
const FOLLOWS: [f64; 2] = [0.02, 12.0];
/// An estimated parameter differs from the given one by at most so many deviations.
const MOST: f64 = 4.0;
/// After a measurement the count of those that no motion explains has this part left.
const FORGETS: f64 = 0.995;
/// The variance of an angle is at least this part of that of its measurement, if its zero is
/// estimated: rounding loses a smaller one.
const LEAST: f64 = 1e-3;

/// Estimates the state of a machine.
///
/// ```
/// # use acrobot::control::estimate::{Estimator, Noise};
/// # use acrobot::{Params, Portable};
/// let params = Params { gravity: 0.0, ..Params::DEFAULT }; // so a straight machine turns evenly
/// let noise = Noise { angle_std: 1e-3, torque_std: 0.01 }; // rad, N m
/// let mut estimator = Estimator::<Portable>::new(params, noise)?;
/// for tick in 0..50 {
///     estimator.correct([0.1 * f64::from(tick), 0.0])?; // rad
///     estimator.predict(0.0)?; // N m
/// }
/// assert!((estimator.state().dtheta1 - 0.5).abs() < 1e-3); // rad/s
/// # Ok::<(), acrobot::Error>(())
/// ```
pub type Estimator<A> = KalmanFilter<A, 0>;

/// Estimates the state of a machine and its parameters.
///
/// ```
/// # use acrobot::control::estimate::{Noise, ParameterEstimator, ParameterStd};
/// # use acrobot::{Params, Portable};
/// let std = ParameterStd { mass2: 0.1, ..ParameterStd::default() }; // kg
/// let noise = Noise { angle_std: 1e-3, torque_std: 0.01 }; // rad, N m
/// let mut estimator = ParameterEstimator::<Portable>::new(Params::DEFAULT, std, noise)?;
/// for _ in 0..100 {
///     estimator.correct([-0.3311, 1.5708])?; // rad: link 2 stays bent
///     estimator.predict(5.097)?; // N m, which hold it
/// }
/// assert!((estimator.params().mass2 - 1.1).abs() < 0.01); // kg, 0.1 more than given
/// # Ok::<(), acrobot::Error>(())
/// ```
pub type ParameterEstimator<A> = KalmanFilter<A, PARAMETERS>;

/// An extended Kalman filter for the state of a machine and `K` of its parameters: an [`Estimator`]
/// or a [`ParameterEstimator`].
///
/// In each `dt` of the parameters call [`correct`](Self::correct), decide, and call
/// [`predict`](Self::predict): [an example](crate::guide::control#a-machine-that-you-measure). With
/// the `serde` feature it can be saved, and a loaded one continues bit-identically.
#[derive(Clone, Debug)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(
        serialize = "[Parameter<A::Scalar, K>; K]: serde::Serialize",
        deserialize = "[Parameter<A::Scalar, K>; K]: serde::Deserialize<'de>"
    ))
)]
pub struct KalmanFilter<A: Arithmetic, const K: usize> {
    pub(super) model: Pendulum<A>,
    pub(super) given: Given<A::Scalar>,
    /// The variance of the torque, in parts of the given one.
    pub(super) torque: A::Scalar,
    /// The covariances of the state. `None` before a measurement, and after an overflow.
    of_state: Option<Matrix<A::Scalar>>,
    pub(super) parameters: [Parameter<A::Scalar, K>; K],
    /// What the encoders say where the angles are 0, rad, and the part of a torque that acts.
    zeros: [A::Scalar; 2],
    factor: A::Scalar,
    /// How many of the last angles no motion of the model explains.
    misses: A::Scalar,
}

impl<A: Arithmetic> Estimator<A> {
    /// An estimator of the state. The first measurement sets it.
    ///
    /// # Errors
    ///
    /// The errors of [`Pendulum::new`], and a [noise](Noise) is out of its range.
    pub fn new(params: Params<A::Scalar>, noise: Noise<A::Scalar>) -> Result<Self, Error> {
        Self::build(Pendulum::new(params, State::HANGING)?, noise, [])
    }
}

impl<A: Arithmetic> ParameterEstimator<A> {
    /// An estimator of the state and of the parameters that are not known.
    ///
    /// # Errors
    ///
    /// The errors of [`Estimator::new`], and a standard deviation is not finite, below 0, or not 0
    /// for a friction or the rotor in an arithmetic without friction.
    pub fn new(
        params: Params<A::Scalar>,
        std: ParameterStd<A::Scalar>,
        noise: Noise<A::Scalar>,
    ) -> Result<Self, Error> {
        Self::with_std(Pendulum::new(params, State::HANGING)?, std, noise)
    }
}

impl<A: Arithmetic, const K: usize> KalmanFilter<A, K> {
    /// An estimator of the first `K` parameters.
    #[expect(clippy::indexing_slicing, reason = "i is below K, which is at most PARAMETERS")]
    pub(in crate::control) fn with_std(
        model: Pendulum<A>,
        std: ParameterStd<A::Scalar>,
        noise: Noise<A::Scalar>,
    ) -> Result<Self, Error> {
        const { assert!(K <= PARAMETERS) };
        let (std, zero, one) = (std.numbers(), A::Scalar::ZERO, A::Scalar::ONE);
        let instruments = [("zero1", zero), ("zero2", zero), ("torque_factor", one)];
        let given = estimated(model.params().numbers(), instruments);
        let units = ["rad", "rad", "of the torque"].map(|unit| ("", unit, Range::AtLeastZero));
        let units = estimated(FIELDS, units);
        let mut parameters = [Parameter::NONE; K];
        for (i, parameter) in parameters.iter_mut().enumerate() {
            let ((name, given), (_, unit, _), deviation) = (given[i], units[i], std[i]);
            let value = deviation.to_f64();
            Range::AtLeastZero.check(name, value, unit)?;
            let is_friction = (FRICTION.contains(&i) || i == ROTOR) && !A::HAS_FRICTION;
            if is_friction && value > 0.0 {
                let rule = "known unless the arithmetic is Damped, in";
                return Err(Error::OutOfRange { name, value, unit, rule });
            }
            let most = A::Scalar::from_f64(MOST) * deviation;
            let is_signed = i == ROTOR || ZEROS.contains(&i);
            let is_negative = given - most < zero && !is_signed;
            let limits = [if is_negative { zero } else { given - most }, given + most];
            *parameter = Parameter { deviation, limits, ..Parameter::NONE };
        }
        Self::build(model, noise, parameters)
    }

    fn build(
        model: Pendulum<A>,
        noise: Noise<A::Scalar>,
        parameters: [Parameter<A::Scalar, K>; K],
    ) -> Result<Self, Error> {
        let mut given = Given::new(model.params(), noise)?;
        let Params { coulomb1, coulomb2, .. } = *model.params();
        let doubts = parameters.iter().enumerate().filter(|(i, _)| FRICTION.contains(i));
        let doubt = doubts.fold(coulomb1 + coulomb2, |sum, (_, x)| sum + x.deviation);
        if doubt == A::Scalar::ZERO {
            given.slow = A::Scalar::ZERO;
        }
        let (zeros, factor, misses) = ([A::Scalar::ZERO; 2], A::Scalar::ONE, A::Scalar::ZERO);
        let torque = given.limits[1];
        Ok(Self { model, given, torque, of_state: None, parameters, zeros, factor, misses })
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

    /// What the encoders are estimated to say where the angles are 0, rad.
    #[must_use]
    pub fn zeros(&self) -> [A::Scalar; 2] {
        self.zeros
    }

    /// The torque that is estimated to act, divided by the one that is sent.
    #[must_use]
    pub fn torque_factor(&self) -> A::Scalar {
        self.factor
    }

    /// How many of about the last hundred measurements no motion of the model explains, so that the
    /// machine was pushed, or an encoder is broken.
    #[must_use]
    pub fn misses(&self) -> A::Scalar {
        self.misses
    }

    /// The standard deviations of the state, rad and rad/s. `None` before a measurement, and after
    /// an error of [`predict`](Self::predict).
    #[must_use]
    pub fn state_std(&self) -> Option<[A::Scalar; 4]> {
        let root = |x| if x > A::Scalar::ZERO { A::Scalar::sqrt(x) } else { A::Scalar::ZERO };
        self.of_state.as_ref().map(|covariances| diagonal(covariances).map(root))
    }

    /// Corrects the estimate by measured angles θ1 and θ2, rad. The first ones, and those after an
    /// overflow, are taken as they are, with velocities of 0.
    ///
    /// # Errors
    ///
    /// An angle is not finite.
    pub fn correct(&mut self, angles: [A::Scalar; 2]) -> Result<(), Error> {
        let ([angle1, angle2], [zero1, zero2]) = (angles, self.zeros);
        let rest = A::Scalar::ZERO;
        let measured = State::from([angle1 - zero1, angle2 - zero2, rest, rest]);
        measured.validate()?;
        let corrected = self.of_state.and_then(|of_state| self.corrected(of_state, angles));
        self.of_state = corrected.or_else(|| self.begin(measured));
        Ok(())
    }

    /// Begins with a state and the given deviations.
    #[expect(clippy::indexing_slicing, reason = "i is below K")]
    fn begin(&mut self, state: State<A::Scalar>) -> Option<Matrix<A::Scalar>> {
        for (i, parameter) in self.parameters.iter_mut().enumerate() {
            let deviation = parameter.deviation;
            parameter.with_state = from_fn(|angle| match ZEROS.get(angle) == Some(&i) {
                true => -deviation,
                false => A::Scalar::ZERO,
            });
            parameter.with_params = [A::Scalar::ZERO; K];
            parameter.with_params[i] = A::Scalar::ONE;
        }
        let Given { of_angle, of_velocity, limits, .. } = self.given;
        self.torque = limits[1];
        self.model.set_state(state).ok()?;
        // An angle is as wrong as the zero that was taken off.
        let [of_angle1, of_angle2] = ZEROS.map(|place| {
            let zero = self.parameters.get(place).map_or(A::Scalar::ZERO, |own| own.deviation);
            of_angle + zero * zero
        });
        Some(spread([of_angle1, of_angle2, of_velocity, of_velocity]))
    }

    /// What the zero of encoder `i` adds to the covariances of the measured angle: with the state,
    /// and with itself beside that of the angle.
    fn of_zero(&self, i: usize) -> ([A::Scalar; 4], A::Scalar) {
        let zero = ZEROS.get(i).and_then(|place| Some((self.parameters.get(*place)?, *place)));
        let Some((zero, place)) = zero else { return ([A::Scalar::ZERO; 4], A::Scalar::ZERO) };
        let own = zero.with_params.get(place).copied().unwrap_or(A::Scalar::ZERO);
        (zero.with_state.map(|x| x * zero.deviation), own * zero.deviation * zero.deviation)
    }

    /// The covariances after a measurement. `None` if a number overflows.
    #[expect(clippy::indexing_slicing, reason = "i is 0 or 1")]
    fn corrected(
        &mut self,
        mut of_state: Matrix<A::Scalar>,
        angles: [A::Scalar; 2],
    ) -> Option<Matrix<A::Scalar>> {
        let (zero, one, number) = (A::Scalar::ZERO, A::Scalar::ONE, A::Scalar::from_f64);
        let Given { of_angle, limits, slow, .. } = self.given;
        let mut y: [A::Scalar; 4] = self.model.state().into();
        let (mut params, mut zeros, mut factor) = (*self.model.params(), self.zeros, self.factor);
        // Dry friction at rest can be any torque, so a machine at rest says nothing on parameters.
        // Their covariances with the state follow, as in a Schmidt-Kalman filter.
        let is_resting = y[2].abs() < slow && y[3].abs() < slow;
        let (dt, [zero1, zero2]) = (params.dt, &mut zeros);
        let mut values = estimated(params.numbers_mut(), [zero1, zero2, &mut factor]);
        angles.into_iter().enumerate().for_each(|(i, angle)| {
            // Not by indices: Rust 1.89 would check them at opt-level z.
            let Some(own) = ZEROS.get(i).and_then(|place| values.get(*place)) else { return };
            let error = wrap(angle - **own - y[i]);
            let square = error * error;
            let (mut with_zero, mut of_zero) = self.of_zero(i);
            // The variance of the torque follows the errors.
            let ratio = square / (of_angle + sum(of_state[i][i], with_zero[i], of_zero));
            let [rate, most] = FOLLOWS.map(number);
            let change = rate * (saturate(ratio, most) - one);
            self.torque = within(self.torque + self.torque * change, limits);
            let is_miss = ratio > number(PUSH * PUSH);
            self.misses = self.misses * number(FORGETS) + if is_miss { one } else { zero };
            if is_miss {
                // The velocities are in doubt by as much as the error needs in one step.
                let of_velocity = square / (dt * dt);
                let [of_angle1, of_angle2, ..] =
                    diagonal(&of_state).map(|x| if x > square { x } else { square });
                of_state = spread([of_angle1, of_angle2, of_velocity, of_velocity]);
                self.parameters.iter_mut().for_each(|x| x.with_state = [zero; 4]);
                (with_zero, of_zero) = self.of_zero(i);
            }

            let before = of_state[i][i];
            let with_angle = plus_scaled(of_state[i], one, with_zero);
            let inverse = one / (of_angle + sum(before, with_zero[i], of_zero));
            let gain = with_angle.map(|x| x * inverse);
            add_scaled(&mut y, error, &gain);
            add_outer(&mut of_state, -one, &with_angle, &gain);
            if of_zero > zero {
                // Rounding loses a smaller one.
                let least = number(LEAST) * of_angle;
                of_state[i][i] = within(of_state[i][i], [least, before + least]);
            } else {
                of_state[i][i] = before * of_angle * inverse; // the same, without cancellation
            }
            let deviation = self.parameters.get(ZEROS[i]).map_or(zero, |own| own.deviation);
            let with_angle = self.parameters.each_ref().map(|parameter| {
                let with_zero = parameter.with_params.get(ZEROS[i]).copied().unwrap_or(zero);
                parameter.with_state[i] + deviation * with_zero
            });
            let values = values.iter_mut().zip(with_angle);
            for (parameter, (value, x)) in self.parameters.iter_mut().zip(values) {
                add_scaled(&mut parameter.with_state, -x, &gain);
                if is_resting {
                    continue;
                }
                let part = x * inverse;
                for (covariance, x) in parameter.with_params.iter_mut().zip(with_angle) {
                    *covariance = *covariance - part * x;
                }
                **value = **value + parameter.deviation * (part * error);
            }
        });
        self.bound(&mut y, values);
        if K > 0 {
            // What no machine has changes nothing.
            let _ = self.model.set_params(params);
            if check_finite("", &[zeros[0], zeros[1], factor]).is_ok() {
                (self.zeros, self.factor) = (zeros, factor);
            }
        }
        self.model.set_state(y.into()).ok()?;
        check_finite("", of_state.as_flattened()).is_ok().then_some(of_state)
    }

    /// Takes a step of `dt` with a torque, N m. Before a measurement it does nothing.
    ///
    /// # Errors
    ///
    /// The torque is not finite. Or a derivative or a covariance overflows, or a joint turns by
    /// more than half a turn in the step, so that its velocity does not follow from its angles.
    /// Then the next measurement begins again.
    pub fn predict(&mut self, torque: A::Scalar) -> Result<(), Error> {
        let sent = torque;
        let torque = sent * self.factor;
        let mut next = self.model.clone();
        next.step(torque)?;
        if let Some(of_state) = self.of_state.take() {
            let State { dtheta1, dtheta2, .. } = next.state();
            for (name, velocity) in [("dtheta1", dtheta1), ("dtheta2", dtheta2)] {
                if velocity.abs() * self.model.params().dt > A::Scalar::PI {
                    let rule = "at most half a turn in a step, in";
                    let (value, unit) = (velocity.to_f64(), "rad/s");
                    return Err(Error::OutOfRange { name, value, unit, rule });
                }
            }
            let of_state = self.predicted(of_state, next.state(), [sent, torque])?;
            (self.model, self.of_state) = (next, Some(of_state));
        }
        Ok(())
    }
}

/// The variance of the sum of two numbers, given theirs and their covariance.
fn sum<S: Real>(one: S, both: S, other: S) -> S {
    let x = (one + both) + (both + other);
    if x > S::ZERO { x } else { S::ZERO } // where rounding made it negative
}

pub(super) fn within<S: Real>(x: S, [least, most]: [S; 2]) -> S {
    let x = if x < least { least } else { x };
    if x > most { most } else { x }
}
