//! Estimates the state of a machine from its angles alone, and its parameters: an extended Kalman
//! filter.
//!
//! What the model does not say acts as a torque of the motor, whose variance follows the errors of
//! the predicted angles. After a push the velocities are in doubt, but not the parameters.

use super::error::ControlError;
use super::linearize::MassMatrix;
use super::linearize_step::linearize_step;
use super::matrix::{Matrix, add_scaled, apply, transpose};
use crate::arithmetic::Arithmetic;
use crate::error::{Error, Range};
use crate::math::Real;
use crate::math::sealed::Sealed as _;
use crate::physics::{Model, Params, Pendulum, State, directions, dry_friction, sin_cos, wrap};

/// The standard deviation of the velocities at first, rad/s.
const AT_FIRST: f64 = 10.0;
/// An angle is farther than so many standard deviations from its prediction only after a push.
const PUSH: f64 = 6.0;
/// The deviation of a parameter grows in each step by this part of the first one.
const DRIFT: f64 = 3e-5;
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
    deviations: [A::Scalar; K],
    noise: Noise<A::Scalar>,
    /// The variance of the torque, (N m)².
    torque: A::Scalar,
    /// The covariances of the state, those of each parameter with the state, and of the parameters.
    of_state: Matrix<A::Scalar>,
    with_state: [[A::Scalar; 4]; K],
    of_params: [[A::Scalar; K]; K],
    /// Whether an angle was measured.
    is_started: bool,
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

impl<A: Arithmetic> Estimator<A, PARAMETERS> {
    /// An estimator of the state and of the parameters `mass1`, `mass2`, `length1`, `inertia1`,
    /// `inertia2`, `rotor`, `friction` and `coulomb`, given the standard deviation of each in its
    /// unit; one of 0 is known. Other fields of `deviations` do not count.
    ///
    /// # Errors
    ///
    /// Those of [`new`](Estimator::new), and a deviation is not finite, below 0, or that of a
    /// friction or of the rotor in an arithmetic without friction.
    pub fn with_params(
        params: Params<A::Scalar>,
        mut deviations: Params<A::Scalar>,
        noise: Noise<A::Scalar>,
    ) -> Result<Self, Error> {
        const NAMES: [&str; PARAMETERS] = [
            "mass1",
            "mass2",
            "length1",
            "inertia1",
            "inertia2",
            "rotor",
            "friction.joint1",
            "friction.joint2",
            "coulomb.joint1",
            "coulomb.joint2",
        ];
        let deviations = fields(&mut deviations).map(|x| *x);
        for (i, (name, deviation)) in NAMES.into_iter().zip(deviations).enumerate() {
            let (value, unit) = (deviation.to_f64(), "times its unit");
            Range::AtLeastZero.check(name, value, unit)?;
            if i >= 5 && !A::HAS_FRICTION && value > 0.0 {
                let rule = "known unless the arithmetic is Damped, in";
                return Err(Error::OutOfRange { name, value, unit, rule });
            }
        }
        Self::build(params, noise, deviations)
    }
}

/// The parameters that can be estimated: all that the motion tells.
const PARAMETERS: usize = 10;

fn fields<S>(params: &mut Params<S>) -> [&mut S; PARAMETERS] {
    [
        &mut params.mass1,
        &mut params.mass2,
        &mut params.length1,
        &mut params.inertia1,
        &mut params.inertia2,
        &mut params.rotor,
        &mut params.friction.joint1,
        &mut params.friction.joint2,
        &mut params.coulomb.joint1,
        &mut params.coulomb.joint2,
    ]
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
        let mut of_params = [[zero; K]; K];
        for (i, (row, deviation)) in of_params.iter_mut().zip(deviations).enumerate() {
            if let Some(place) = row.get_mut(i) {
                *place = deviation * deviation;
            }
        }
        Ok(Self {
            model: Pendulum::new(params, State::HANGING)?,
            given: params,
            deviations,
            noise,
            torque: noise.torque * noise.torque * A::Scalar::from_f64(1e4),
            of_state: [[zero; 4]; 4],
            with_state: [[zero; 4]; K],
            of_params,
            is_started: false,
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

    /// The standard deviations of the state, rad and rad/s.
    #[must_use]
    pub fn deviations(&self) -> [A::Scalar; 4] {
        let [a, b, c, d] = &self.of_state;
        [a[0], b[1], c[2], d[3]].map(A::Scalar::sqrt)
    }

    /// Corrects the estimate by measured angles θ1 and θ2, rad. The first ones are taken as they
    /// are, with velocities of 0.
    ///
    /// # Errors
    ///
    /// An angle is not finite.
    pub fn measure(&mut self, [theta1, theta2]: [A::Scalar; 2]) -> Result<(), Error> {
        let [zero, of_angle, of_velocity] =
            [A::Scalar::ZERO, self.noise.angle, A::Scalar::from_f64(AT_FIRST)].map(|x| x * x);
        let measured = State { theta1, theta2, dtheta1: zero, dtheta2: zero };
        measured.validate()?;
        if !self.is_started {
            self.of_state = [
                [of_angle, zero, zero, zero],
                [zero, of_angle, zero, zero],
                [zero, zero, of_velocity, zero],
                [zero, zero, zero, of_velocity],
            ];
            self.is_started = true;
            return self.model.set_state(measured);
        }
        self.correct::<0>(theta1);
        self.correct::<1>(theta2);
        Ok(())
    }

    /// Corrects by the angle of joint `I`.
    #[expect(clippy::indexing_slicing, reason = "I is 0 or 1")]
    fn correct<const I: usize>(&mut self, angle: A::Scalar) {
        let number = A::Scalar::from_f64;
        let mut y: [A::Scalar; 4] = self.model.state().into();
        let error = wrap(angle - y[I]);
        let square = error * error;
        let of_angle = self.noise.angle * self.noise.angle;
        let ratio = square / (self.of_state[I][I] + of_angle);
        self.follow(ratio);
        if ratio > number(PUSH * PUSH) {
            self.doubt_velocities(square);
        }
        let row = self.of_state[I];
        let inverse = A::Scalar::ONE / (row[I] + of_angle);
        let gain = row.map(|x| x * inverse);
        add_scaled(&mut y, error, &gain);
        for (covariances, x) in self.of_state.iter_mut().zip(row) {
            add_scaled(covariances, -x, &gain);
        }
        let with_angle = self.with_state.map(|x| x[I]);
        for (covariances, x) in self.with_state.iter_mut().zip(with_angle) {
            add_scaled(covariances, -x, &gain);
        }
        let mut params = *self.model.params();
        let mut given = self.given;
        let places = fields(&mut params).into_iter().zip(fields(&mut given));
        let rows = self.of_params.iter_mut().zip(self.deviations);
        for ((row, deviation), (x, (place, given))) in rows.zip(with_angle.into_iter().zip(places))
        {
            let gain = x * inverse;
            for (covariance, x) in row.iter_mut().zip(with_angle) {
                *covariance = *covariance - gain * x;
            }
            let most = number(MOST) * deviation;
            let changed = *place + gain * error - *given;
            *place = *given
                + if changed > most {
                    most
                } else if changed < -most {
                    -most
                } else {
                    changed
                };
        }
        // A friction below 0 is 0, and what has no valid parameters keeps the former ones.
        for friction in [&mut params.friction, &mut params.coulomb] {
            for place in [&mut friction.joint1, &mut friction.joint2] {
                if *place < A::Scalar::ZERO {
                    *place = A::Scalar::ZERO;
                }
            }
        }
        let _ = self.model.set_params(params);
        let _ = self.model.set_state(State::from(y));
    }

    /// Lets the variance of the torque follow the square of an error, relative to its variance.
    fn follow(&mut self, ratio: A::Scalar) {
        let number = A::Scalar::from_f64;
        let most = number(12.0);
        let ratio = if ratio < most { ratio } else { most };
        let torque = self.torque * (A::Scalar::ONE + number(0.02) * (ratio - A::Scalar::ONE));
        let given = self.noise.torque * self.noise.torque;
        let (low, high) = (given * number(1e-2), given * number(1e4));
        self.torque = if torque < low {
            low
        } else if torque > high {
            high
        } else {
            torque
        };
    }

    /// Forgets the velocities, which a push changed, given the square of an error, rad².
    fn doubt_velocities(&mut self, square: A::Scalar) {
        let zero = A::Scalar::ZERO;
        let dt = self.model.params().dt;
        let of_velocity = square / (dt * dt);
        let [[a, b, ..], [c, d, ..], ..] = self.of_state;
        let larger = |x| if x > square { x } else { square };
        self.of_state = [
            [larger(a), b, zero, zero],
            [c, larger(d), zero, zero],
            [zero, zero, of_velocity, zero],
            [zero, zero, zero, of_velocity],
        ];
        self.with_state = [[zero; 4]; K];
    }

    /// Takes a step of `dt` with a torque, N m.
    ///
    /// # Errors
    ///
    /// The torque is not finite, or a derivative overflows.
    pub fn step(&mut self, torque: A::Scalar) -> Result<(), ControlError> {
        let number = A::Scalar::from_f64;
        let linear = linearize_step(&self.model, torque)?;
        let before: [A::Scalar; 4] = self.model.state().into();
        self.model.step(torque)?;
        let by_params: [[A::Scalar; 4]; K] = self.slopes(before);

        // A P Aᵀ, and the parts of the parameters.
        let half = transpose(&self.of_state.map(|row| apply(&linear.a, &row)));
        let mut of_state = half.map(|row| apply(&linear.a, &row));
        for (i, covariances) in self.with_state.iter_mut().enumerate() {
            let moved = apply(&linear.a, covariances);
            let mut next = moved;
            for (slopes, row) in by_params.iter().zip(&self.of_params) {
                if let Some(x) = row.get(i) {
                    add_scaled(&mut next, *x, slopes);
                }
            }
            *covariances = next;
            if let Some(slopes) = by_params.get(i) {
                for (row, (moved, slope)) in of_state.iter_mut().zip(moved.into_iter().zip(slopes))
                {
                    add_scaled(row, moved, slopes);
                    add_scaled(row, *slope, &next);
                }
            }
        }
        // What the model does not say, and rounding.
        let angle = number(1e-6) * number(1e-6);
        let velocity = number(1e-3) * number(1e-3);
        for (row, b) in of_state.iter_mut().zip(linear.b) {
            add_scaled(row, self.torque * b, &linear.b);
        }
        let [a, b, c, d] = &mut of_state;
        let noises = [angle, angle, velocity, velocity];
        for (place, noise) in [&mut a[0], &mut b[1], &mut c[2], &mut d[3]].into_iter().zip(noises) {
            *place = *place + noise;
        }
        for (i, (row, deviation)) in self.of_params.iter_mut().zip(self.deviations).enumerate() {
            let drift = number(DRIFT) * deviation;
            if let Some(place) = row.get_mut(i) {
                *place = *place + drift * drift;
            }
        }
        // Symmetric, also after rounding.
        let transposed = transpose(&of_state);
        for (row, other) in of_state.iter_mut().zip(&transposed) {
            *row = row.map(|x| x * A::Scalar::HALF);
            add_scaled(row, A::Scalar::HALF, other);
        }
        self.of_state = of_state;
        Ok(())
    }

    /// The derivatives of the last step, from the state before, by each parameter: those of the
    /// accelerations in the middle of the step.
    fn slopes(&self, before: [A::Scalar; 4]) -> [[A::Scalar; 4]; K] {
        let mut slopes = [[A::Scalar::ZERO; 4]; K];
        if K == 0 {
            return slopes;
        }
        let model = self.model.model();
        let (half, dt) = (model.constants.half_dt, model.params.dt);
        let [_, _, dtheta1, dtheta2]: [A::Scalar; 4] = self.model.state().into();
        let [theta1, theta2, before1, before2] = before;
        let middle = |x, y| (x + y) * A::Scalar::HALF;
        let rates = [middle(before1, dtheta1), middle(before2, dtheta2)];
        let angles = [theta1 + half * rates[0], theta2 + half * rates[1]];
        let accelerations = [(dtheta1 - before1) / dt, (dtheta2 - before2) / dt];
        for (place, [by1, by2]) in
            slopes.iter_mut().zip(by_params::<A>(model, angles, rates, accelerations))
        {
            *place = [half * (dt * by1), half * (dt * by2), dt * by1, dt * by2];
        }
        slopes
    }
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
        [ddbeta, ddtheta1],
        [-dtheta1, zero],
        [dtheta2, -dtheta2],
        [-dry1, zero],
        [dry2, -dry2],
    ]
    .map(|forces| mass.solve(forces))
}
