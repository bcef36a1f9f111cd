//! The derivatives of a step.

use super::partials::partials;
use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::math::matrix::{check_finite, dot, transpose};
use crate::math::sealed::Sealed as _;
use crate::math::{Lanes, Numbers, Real, SinCos};
use crate::physics::{Model, Pendulum, check_torque, plus_scaled};

/// A linear model of one step of `dt`, x′ = A x + B u: x is the deviation from a state \[θ1, θ2,
/// θ̇1, θ̇2\], rad and rad/s, x′ that from the state after the step, and u that from a torque, N m,
/// which is constant during the step. [`dlqr`](crate::control::regulator::dlqr) has its regulator.
///
/// ```
/// use acrobot::{Portable, control::model::StepModel, physics::Pendulum};
///
/// let mut hanging = Pendulum::<Portable>::hanging();
/// let StepModel { b, .. } = hanging.linearize_step(0.0)?;
/// hanging.step(1e-3)?; // N m
/// assert!((hanging.state().dtheta2 - b[3] * 1e-3).abs() < 1e-8); // rad/s
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)] // for bindings/abi
pub struct StepModel<S = f64> {
    /// A by rows: `a[i][j]` is the derivative of the i-th number after the step by the j-th before.
    pub a: [[S; 4]; 4],
    /// B: the derivatives of the numbers after the step by the torque.
    pub b: [S; 4],
}

impl<A: Arithmetic> Pendulum<A> {
    /// Linearizes one step of `dt` about the state and a torque, N m.
    ///
    /// A and B are the derivatives of the Runge-Kutta step, exact up to rounding, and not a matrix
    /// exponential. The state need not be an equilibrium. Where the step clamps a velocity at its
    /// bound, the derivatives of that velocity are 0.
    /// [`Batch::linearize_step_into`](crate::batch::Batch::linearize_step_into) linearizes many.
    ///
    /// ```
    /// use acrobot::physics::Pendulum;
    /// use acrobot::{Params, Portable, State};
    ///
    /// let upright = Pendulum::<Portable>::new(Params::DEFAULT, State::UPRIGHT)?;
    /// let model = upright.linearize_step(0.0)?;
    /// assert!(model.a[0][0] > 1.0); // a lean grows
    /// # Ok::<(), acrobot::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The errors of [`linearize`](Self::linearize).
    #[inline(never)] // saves flash
    pub fn linearize_step(&self, torque: A::Scalar) -> Result<StepModel<A::Scalar>, Error> {
        let mut after = self.clone();
        after.step(torque)?;
        let bounds = by_bounds::<A, A::Scalar>(self.model(), after.state().into());
        self.linearize_step_within(torque, bounds)
    }

    /// As [`linearize_step`](Self::linearize_step), where no bound clamps, as at an equilibrium.
    pub(in crate::control) fn linearize_free_step(
        &self,
        torque: A::Scalar,
    ) -> Result<StepModel<A::Scalar>, Error> {
        self.linearize_step_within(torque, [A::Scalar::ZERO; 2])
    }

    /// As [`linearize_step`](Self::linearize_step), given [`by_bounds`].
    #[inline(never)] // saves flash
    fn linearize_step_within(
        &self,
        torque: A::Scalar,
        bounds: [A::Scalar; 2],
    ) -> Result<StepModel<A::Scalar>, Error> {
        check_torque(torque)?;
        let y = self.state().into();
        let mut columns = derivatives_alone::<A>(self.model(), y, self.sin_cos(), torque);
        clamp(&mut columns, bounds);
        let [columns @ .., b] = columns;
        let model = StepModel { a: transpose(&columns), b };
        check_finite("a", model.a.as_flattened())?;
        check_finite("b", &model.b)?;
        Ok(model)
    }
}

/// As [`derivatives`], out of line, which saves flash.
#[inline(never)]
pub(in crate::control) fn derivatives_alone<A: Arithmetic>(
    model: &Model<A::Scalar>,
    y: [A::Scalar; 4],
    sin_cos: [SinCos<A::Scalar>; 2],
    torque: A::Scalar,
) -> [[A::Scalar; 4]; 5] {
    derivatives::<A, false>(model, y, sin_cos, torque)
}

/// The columns of A, and B. `IN_LANES` inlines all, for a loop over lanes.
///
/// A Runge-Kutta step of the equations of motion and of their variational equations: columns of
/// derivatives by the four numbers of the state before the step and by the torque.
#[inline(always)]
pub(crate) fn derivatives<A: Arithmetic, const IN_LANES: bool>(
    model: &Model<A::Scalar>,
    y: [A::Scalar; 4],
    sin_cos: [SinCos<A::Scalar>; 2],
    torque: A::Scalar,
) -> [[A::Scalar; 4]; 5] {
    let common = &model.constants;
    let (half, dt, sixth) = (common.half_dt, model.params.dt, common.sixth_dt);
    let third = sixth + sixth;
    let [o, one] = [A::Scalar::ZERO, A::Scalar::ONE];
    let before = [[one, o, o, o], [o, one, o, o], [o, o, one, o], [o, o, o, one], [o, o, o, o]];
    let ([ddtheta1, ddtheta2], [by1, by2, by3, by4, by_torque]) =
        rates::<A, IN_LANES>(model, y, sin_cos, torque);
    let k = [y[2], y[3], ddtheta1, ddtheta2];
    let slopes = [
        [o, o, by1[0], by1[1]],
        [o, o, by2[0], by2[1]],
        [one, o, by3[0], by3[1]],
        [o, one, by4[0], by4[1]],
        [o, o, by_torque[0], by_torque[1]],
    ];
    let after = add(before, sixth, slopes);

    let mut stages = Stages { k, slopes, after };
    if !IN_LANES {
        for (h, weight) in [(half, third), (half, third), (dt, sixth)] {
            stages = stages.next::<A, false>(model, &before, y, torque, h, weight);
        }
        return stages.after;
    }
    let stages = stages.next::<A, true>(model, &before, y, torque, half, third);
    let stages = stages.next::<A, true>(model, &before, y, torque, half, third);
    stages.next::<A, true>(model, &before, y, torque, dt, sixth).after
}

/// The derivatives of the velocities of the state after a step by their bounds: 1 or −1 where they
/// are clamped, otherwise 0.
#[inline(always)]
pub(crate) fn by_bounds<A: Arithmetic, V: Numbers<A::Scalar>>(
    model: &Model<V>,
    y: [V; 4],
) -> [V; 2] {
    let one = A::Scalar::ONE;
    let side = |x: A::Scalar, bound| match x.abs() < bound {
        true => A::Scalar::ZERO,
        false => (x / bound).simd_clamp(-one, one),
    };
    [y[2].zip(model.params.max_velocity1, side), y[3].zip(model.params.max_velocity2, side)]
}

/// Makes the derivatives of velocities that are clamped 0.
#[inline(always)]
pub(crate) fn clamp<S: Real, V: Numbers<S>>(columns: &mut [[V; 4]], [side1, side2]: [V; 2]) {
    let keep = |x, side| if side == S::ZERO { x } else { S::ZERO };
    for [_, _, x1, x2] in columns {
        (*x1, *x2) = (x1.zip(side1, keep), x2.zip(side2, keep));
    }
}

/// A stage of the Runge-Kutta step: the rates of the state, those of the columns, and the sum of
/// the columns.
struct Stages<S> {
    k: [S; 4],
    slopes: [[S; 4]; 5],
    after: [[S; 4]; 5],
}

impl<S: Real> Stages<S> {
    /// The next stage, h after the first.
    #[inline(always)]
    fn next<A: Arithmetic<Scalar = S>, const IN_LANES: bool>(
        self,
        model: &Model<S>,
        before: &[[S; 4]; 5],
        y: [S; 4],
        torque: S,
        h: S,
        weight: S,
    ) -> Self {
        let x = plus_scaled(y, h, self.k);
        let sin_cos = [sin_cos_near::<A, IN_LANES>(x[0]), sin_cos_near::<A, IN_LANES>(x[1])];
        let ([ddtheta1, ddtheta2], [by1, by2, by3, by4, by_torque]) =
            rates::<A, IN_LANES>(model, x, sin_cos, torque);
        let rows = [[by1[0], by2[0], by3[0], by4[0]], [by1[1], by2[1], by3[1], by4[1]]];
        let mut slopes = add(*before, h, self.slopes);
        for x in &mut slopes {
            *x = [x[2], x[3], dot(rows[0], *x), dot(rows[1], *x)];
        }
        let [.., column] = &mut slopes;
        column[2] = column[2] + by_torque[0];
        column[3] = column[3] + by_torque[1];
        Self { k: [x[2], x[3], ddtheta1, ddtheta2], slopes, after: add(self.after, weight, slopes) }
    }
}

/// x + h y.
#[inline(always)]
fn add<S: Real>(mut x: [[S; 4]; 5], h: S, y: [[S; 4]; 5]) -> [[S; 4]; 5] {
    for (x, y) in x.iter_mut().zip(y) {
        *x = plus_scaled(*x, h, y);
    }
    x
}

/// The accelerations and their derivatives.
type Rates<S> = ([S; 2], [[S; 2]; 5]);

#[inline(always)]
fn rates<A: Arithmetic, const IN_LANES: bool>(
    model: &Model<A::Scalar>,
    y: [A::Scalar; 4],
    sin_cos: [SinCos<A::Scalar>; 2],
    torque: A::Scalar,
) -> Rates<A::Scalar> {
    #[inline(never)] // saves flash
    fn out_of_line<A: Arithmetic>(
        model: &Model<A::Scalar>,
        y: [A::Scalar; 4],
        sin_cos: [SinCos<A::Scalar>; 2],
        torque: A::Scalar,
    ) -> Rates<A::Scalar> {
        partials::<A>(model, y, sin_cos, torque)
    }
    match IN_LANES {
        true => partials::<A>(model, y, sin_cos, torque),
        false => out_of_line::<A>(model, y, sin_cos, torque),
    }
}

/// Sine and cosine by the code for a single number, or by that for lanes, which has no branch.
#[inline(always)]
pub(in crate::control) fn sin_cos_near<A: Arithmetic, const IN_LANES: bool>(
    x: A::Scalar,
) -> SinCos<A::Scalar> {
    if !IN_LANES {
        return A::sin_cos_near(x);
    }
    let (sin, cos) = A::sin_cos_near(Lanes([x]));
    (sin.lane(0), cos.lane(0))
}
