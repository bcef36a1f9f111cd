//! Estimates the state of a machine from its angles alone, and its parameters: an extended Kalman
//! filter.
//!
//! What the model does not say acts as a torque of the motor, whose variance follows the errors of
//! the predicted angles. After a push the velocities are in doubt, but not the parameters.

use core::array::from_fn;

use super::error::ControlError;
use super::linearize::{LinearModel, MassMatrix, linearize};
use super::matrix::{
    Matrix, add_outer, add_scaled, apply, diagonal, dot, spread, symmetrize, transpose,
};
use crate::arithmetic::Arithmetic;
use crate::error::{Error, Range};
use crate::math::Real;
use crate::math::sealed::Sealed as _;
use crate::physics::{
    Params, Pendulum, State, coulomb_friction, directions, plus_scaled, saturate, wrap,
};

/// The standard deviation of the velocities at first, rad/s.
const AT_FIRST: f64 = 10.0;
/// An angle is farther than so many standard deviations from its prediction only after a push.
const PUSH: f64 = 6.0;
/// The deviation of a parameter grows in each step by this part of the first one.
const DRIFT: f64 = 3e-5;
/// The variance of the torque is between these parts of the given one. At first it is the most, so
/// that wrong parameters do not count as motion.
const OF_TORQUE: [f64; 2] = [1e-2, 1e4];
/// What the model does not say in a step, and rounding: standard deviations, rad and rad/s.
const IN_A_STEP: [f64; 2] = [1e-6, 1e-3];
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

/// Estimates the state of a machine, and `K` of its parameters: none, or
/// [`PARAMETERS`](Self::PARAMETERS).
///
/// In each `dt` of the parameters call [`measure`](Self::measure), decide, and call
/// [`step`](Self::step): [an example](crate::guide::control#a-machine-that-you-measure).
#[derive(Clone, Debug)]
pub struct Estimator<A: Arithmetic, const K: usize = 0> {
    model: Pendulum<A>,
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
    /// The smallest and the largest number.
    limits: [S; 2],
    /// The variance that each step adds.
    drift: S,
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
    #[expect(clippy::indexing_slicing, reason = "i is below PARAMETERS")]
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
        let zero = A::Scalar::ZERO;
        let given = estimated(params.numbers());
        let parameters = from_fn(|i| {
            let ((name, given), (_, deviation)) = (given[i], deviations[i]);
            let [most, drift] = [MOST, DRIFT].map(|x| A::Scalar::from_f64(x) * deviation);
            let is_negative = given - most < zero && name != "rotor";
            Parameter {
                limits: [if is_negative { zero } else { given - most }, given + most],
                drift: drift * drift,
                with_state: [zero; 4],
                with_params: from_fn(|j| if i == j { deviation * deviation } else { zero }),
            }
        });
        Self::build(params, noise, parameters)
    }
}

impl<A: Arithmetic, const K: usize> Estimator<A, K> {
    /// How many parameters [`with_params`](Estimator::with_params) estimates.
    pub const PARAMETERS: usize = PARAMETERS;

    fn build(
        params: Params<A::Scalar>,
        noise: Noise<A::Scalar>,
        parameters: [Parameter<A::Scalar, K>; K],
    ) -> Result<Self, Error> {
        Range::AboveZero.check("angle", noise.angle.to_f64(), "rad")?;
        Range::AboveZero.check("torque", noise.torque.to_f64(), "N m")?;
        let model = Pendulum::new(params, State::HANGING)?;
        let torque = noise.torque * noise.torque * A::Scalar::from_f64(OF_TORQUE[1]);
        Ok(Self { model, noise, torque, of_state: None, parameters })
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
        let root = |x| if x > A::Scalar::ZERO { A::Scalar::sqrt(x) } else { A::Scalar::ZERO };
        self.of_state.as_ref().map(|covariances| diagonal(covariances).map(root))
    }

    /// Corrects the estimate by measured angles θ1 and θ2, rad. The first ones are taken as they
    /// are, with velocities of 0.
    ///
    /// # Errors
    ///
    /// An angle is not finite.
    #[expect(clippy::indexing_slicing, reason = "i is 0 or 1")]
    pub fn measure(&mut self, angles: [A::Scalar; 2]) -> Result<(), Error> {
        let (zero, one, number) = (A::Scalar::ZERO, A::Scalar::ONE, A::Scalar::from_f64);
        let measured = State::from([angles[0], angles[1], zero, zero]);
        measured.validate()?;
        let [of_angle, of_torque] = [self.noise.angle, self.noise.torque].map(|x| x * x);
        let Some(mut of_state) = self.of_state else {
            let of_velocity = number(AT_FIRST * AT_FIRST);
            self.of_state = Some(spread([of_angle, of_angle, of_velocity, of_velocity]));
            return self.model.set_state(measured);
        };
        let mut y: [A::Scalar; 4] = self.model.state().into();
        let mut params = *self.model.params();
        angles.into_iter().enumerate().for_each(|(i, angle)| {
            let error = wrap(angle - y[i]);
            let square = error * error;
            // The variance of the torque follows the errors.
            let ratio = square / (of_state[i][i] + of_angle);
            let rate = number(0.02) * (saturate(ratio, number(12.0)) - one);
            let limits = OF_TORQUE.map(|part| of_torque * number(part));
            self.torque = within(self.torque + self.torque * rate, limits);
            if ratio > number(PUSH * PUSH) {
                // The velocities are in doubt by as much as the error needs in one step.
                let of_velocity = square / (params.dt * params.dt);
                let [of_angle1, of_angle2, ..] =
                    diagonal(&of_state).map(|x| if x > square { x } else { square });
                of_state = spread([of_angle1, of_angle2, of_velocity, of_velocity]);
                self.parameters.iter_mut().for_each(|x| x.with_state = [zero; 4]);
            }

            let with_angle = of_state[i];
            let inverse = one / (with_angle[i] + of_angle);
            let gain = with_angle.map(|x| x * inverse);
            add_scaled(&mut y, error, &gain);
            add_outer(&mut of_state, -one, &with_angle, &gain);
            of_state[i][i] = with_angle[i] * of_angle * inverse; // the same, without cancellation
            let with_angle = self.parameters.map(|parameter| parameter.with_state[i]);
            let places = estimated(params.numbers_mut()).into_iter().zip(with_angle);
            for (parameter, (place, x)) in self.parameters.iter_mut().zip(places) {
                add_scaled(&mut parameter.with_state, -x, &gain);
                let part = x * inverse;
                for (covariance, x) in parameter.with_params.iter_mut().zip(with_angle) {
                    *covariance = *covariance - part * x;
                }
                *place = within(*place + part * error, parameter.limits);
            }
        });
        self.of_state = finite(of_state);
        if K > 0 {
            // Parameters that no machine has change nothing.
            let _ = self.model.set_params(params);
        }
        let _ = self.model.set_state(y.into());
        Ok(())
    }

    /// Takes a step of `dt` with a torque, N m. Before a measurement it does nothing.
    ///
    /// # Errors
    ///
    /// The torque is not finite, or a derivative overflows.
    #[expect(clippy::indexing_slicing, reason = "i is below K or 4")]
    pub fn step(&mut self, torque: A::Scalar) -> Result<(), ControlError> {
        let [zero, one, half] = [A::Scalar::ZERO, A::Scalar::ONE, A::Scalar::HALF];
        let (mut next, mut middle) = (self.model.clone(), self.model.clone());
        next.step(torque)?;
        let Some(mut of_state) = self.of_state else { return Ok(()) };
        let [theta1, theta2, before1, before2]: [A::Scalar; 4] = middle.state().into();
        let [_, _, after1, after2]: [A::Scalar; 4] = next.state().into();
        let [v1, v2] = [(before1 + after1) * half, (before2 + after2) * half];
        let (dt, half_dt) = (middle.params().dt, middle.model().constants.half_dt);
        middle.set_state([theta1 + half_dt * v1, theta2 + half_dt * v2, v1, v2].into())?;
        // What a rate in the middle of the step changes until its end, to the second order in dt.
        let LinearModel { a, b } = linearize(&middle, torque)?;
        let mut lasting = a.map(|row| row.map(|x| dt * (half_dt * x)));
        add_diagonal(&mut lasting, [dt; 4]);
        let mut after = by_transposed(&lasting, &transpose(&a));
        add_diagonal(&mut after, [one; 4]);
        let slopes = self.slopes(&middle, [(after1 - before1) / dt, (after2 - before2) / dt]);
        let slopes = slopes.map(|[x1, x2]| apply(&lasting, &[zero, zero, x1, x2]));

        of_state = by_transposed(&by_transposed(&after, &of_state), &after);
        for (i, (parameter, slope)) in self.parameters.iter_mut().zip(&slopes).enumerate() {
            let moved = apply(&after, &parameter.with_state);
            let mut change = [zero; 4];
            for (slope, x) in slopes.iter().zip(parameter.with_params) {
                change = plus_scaled(change, x, *slope);
            }
            parameter.with_state = plus_scaled(moved, one, change);
            // Its transpose follows when the matrix becomes symmetric.
            add_outer(&mut of_state, one + one, slope, &plus_scaled(moved, half, change));
            parameter.with_params[i] = parameter.with_params[i] + parameter.drift;
        }
        let b = apply(&lasting, &b);
        add_outer(&mut of_state, self.torque, &b, &b);
        symmetrize(&mut of_state);
        let [angle, velocity] = IN_A_STEP.map(|x| A::Scalar::from_f64(x * x));
        // At opt-level z a `for` loop would keep a check of the index, here and in `measure`.
        [angle, angle, velocity, velocity].into_iter().enumerate().for_each(|(i, noise)| {
            // Rounding may have made it negative.
            let own = if of_state[i][i] > zero { of_state[i][i] } else { zero };
            of_state[i][i] = own + noise;
        });
        (self.model, self.of_state) = (next, finite(of_state));
        Ok(())
    }

    /// The derivatives of the accelerations \[a1, a2\] of a motion by each parameter:
    /// M⁻¹ (∂f/∂p − ∂M/∂p q̈), as in `partials`.
    fn slopes(&self, motion: &Pendulum<A>, [a1, a2]: [A::Scalar; 2]) -> [[A::Scalar; 2]; K] {
        let (o, one) = (A::Scalar::ZERO, A::Scalar::ONE);
        let mut slopes = [[o; 2]; K];
        if K == 0 {
            return slopes;
        }
        let (model, sines) = (motion.model(), motion.sin_cos());
        let State { dtheta1: v1, dtheta2: v2, .. } = motion.state();
        let (params, nips) = (&model.params, model.constants.nips);
        let (l1, lc1, lc2) = (params.length1, params.center_of_mass1, params.center_of_mass2);
        let [_, (sin2, cos2)] = sines;
        let [weight1, weight2] = directions(sines).map(|(sin, _)| params.gravity * sin);
        let [coulomb1, coulomb2] = [v1, v2].map(|v| coulomb_friction::<A, A::Scalar>(model, v).0);
        let (square, sum) = (v1 * v1, v1 + v2);
        // Of l1 lc2 m2: what the links do to each other.
        let on_link1 = sin2 * (sum * sum - nips * square) - cos2 * (a1 + a2);
        let on_link2 = -(sin2 * ((one - nips) * square)) - cos2 * a1;
        let of_tip = lc2 * on_link1 - weight1 - l1 * a1;
        let forces: [[A::Scalar; 2]; PARAMETERS] = [
            [-(lc1 * (weight1 + lc1 * a1)), o],
            [l1 * of_tip, lc2 * (l1 * on_link2 - weight2 - lc2 * (a1 + a2))],
            [params.mass2 * (of_tip - l1 * a1), params.mass2 * lc2 * on_link2],
            [-a1, o],
            [o, -(a1 + a2)],
            [-v1, o],
            [v2, -v2],
            [-coulomb1, o],
            [coulomb2, -coulomb2],
            [a1 + a2, a1],
        ];
        let mass = MassMatrix::new::<A>(model, (sin2, cos2));
        slopes.iter_mut().zip(forces).for_each(|(slope, forces)| *slope = mass.solve(forces));
        slopes
    }
}

#[expect(clippy::indexing_slicing, reason = "i is below 4")]
fn add_diagonal<S: Real>(m: &mut Matrix<S>, diagonal: [S; 4]) {
    diagonal.into_iter().enumerate().for_each(|(i, x)| m[i][i] = m[i][i] + x);
}

/// Where a variance overflows, the next measurement begins again.
fn finite<S: Real>(covariances: Matrix<S>) -> Option<Matrix<S>> {
    diagonal(&covariances).iter().all(|x| x.is_finite()).then_some(covariances)
}

/// x yᵀ.
#[inline(never)] // saves flash
fn by_transposed<S: Real>(x: &Matrix<S>, y: &Matrix<S>) -> Matrix<S> {
    x.map(|row| y.map(|column| dot(row, column)))
}

fn within<S: Real>(x: S, [least, most]: [S; 2]) -> S {
    let x = if x < least { least } else { x };
    if x > most { most } else { x }
}
