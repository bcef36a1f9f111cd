//! The equations of motion of the double pendulum with a motor in its middle joint.
//!
//! M(θ2) θ̈ = f(θ, θ̇, torque), with the mass matrix M = \[\[d1, d2\], \[d2, m2 lc2² + I2\]\] and the
//! names of Sutton & Barto, *Reinforcement Learning: An Introduction* (1998), section 11.3: d1, d2,
//! phi1 and phi2. The same equations stand here in two orders of evaluation, one below the other.

use core::marker::PhantomData;

use crate::arithmetic::{Arithmetic, Fast, Form, Numbers, Real, kernel};
use crate::bounds::wrap;
use crate::lanes::Lanes;
use crate::params::{Dynamics, Params};
use crate::rk4::Derivative;
use crate::state::State;

/// Sine and cosine of one angle.
pub(crate) type SinCos<S> = (S, S);

/// The parameters, and every part of the equations that depends on them alone, computed once when
/// they are set.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Model<S> {
    pub(crate) params: Params<S>,
    /// m2 l1 lc2, kg m²: how strongly the links turn each other.
    coupling: S,
    /// m2 lc2² + I2, kg m²: link 2 about its joint.
    link2: S,
    /// (m1 lc1 + m2 l1) g, N m.
    gravity1: S,
    /// m2 lc2 g, N m.
    gravity2: S,
    /// What else the form of the equations needs; the form alone knows the names.
    own: [S; 4],
    /// dt/2, dt and dt/6, s.
    pub(crate) dts: [S; 3],
}

impl<S: Real> Model<S> {
    pub(crate) fn new<A: Arithmetic<Scalar = S>>(params: Params<S>) -> Self {
        let Params {
            length1: l1,
            mass1: m1,
            mass2: m2,
            center_of_mass1: lc1,
            center_of_mass2: lc2,
            inertia1,
            inertia2,
            gravity,
            ..
        } = params;
        let link1 = m1 * A::square(lc1);
        let lc2_squared = A::square(lc2);
        let link2 = m2 * lc2_squared + inertia2;
        let own = match A::FORM {
            Form::Gymnasium => [link1, A::square(l1) + lc2_squared, l1 * lc2, lc2_squared],
            Form::Lean => {
                let m2_l1_squared = m2 * A::square(l1);
                let [book, nips] = match params.dynamics {
                    Dynamics::Book => [S::from_f64(1.0), S::ZERO],
                    Dynamics::Nips => [S::ZERO, S::from_f64(1.0)],
                };
                [
                    link1 + inertia1 + m2_l1_squared,
                    (link1 + inertia1) * link2 + m2_l1_squared * inertia2,
                    book,
                    nips,
                ]
            }
        };
        Self {
            params,
            coupling: m2 * l1 * lc2,
            link2,
            gravity1: (m1 * lc1 + m2 * l1) * gravity,
            gravity2: m2 * lc2 * gravity,
            own,
            dts: [
                params.dt * S::from_f64(0.5),
                params.dt,
                params.dt / S::from_f64(6.0),
            ],
        }
    }

    /// As `AcrobotEnv._dsdt` evaluates them, operation by operation: `2 * x` excepted, which is
    /// exact wherever it stands.
    // `Host` takes a tenth longer otherwise; on a chip it would cost `Portable` flash and gain nothing.
    #[cfg_attr(feature = "std", inline(always))]
    fn gymnasium<A: Arithmetic<Scalar = S>>(
        &self,
        [theta1, theta2, dtheta1, dtheta2]: [S; 4],
        sin1: Option<S>,
        (sin2, cos2): SinCos<S>,
        torque: S,
    ) -> [S; 4] {
        let Params {
            mass2: m2,
            inertia1,
            inertia2,
            dynamics,
            ..
        } = self.params;
        // m1 lc1², l1² + lc2², l1 lc2, lc2².
        let [link1, arms, arm, lc2_squared] = self.own;
        let two = S::from_f64(2.0);
        let coupling = self.coupling;

        // First, for calls keep no floats in registers on x86-64.
        let phi2 = self.gravity2 * A::cos_from_horizontal(theta1 + theta2, None);
        let cos1 = A::cos_from_horizontal(theta1, sin1);
        let arm = arm * cos2;
        let d1 = link1 + m2 * (arms + two * arm) + inertia1 + inertia2;
        let d2 = m2 * (lc2_squared + arm) + inertia2;
        let phi1 = -coupling * A::square(dtheta2) * sin2
            - two * coupling * dtheta2 * dtheta1 * sin2
            + self.gravity1 * cos1
            + phi2;
        let driven = torque + d2 / d1 * phi1;
        let driven = match dynamics {
            Dynamics::Book => driven - coupling * A::square(dtheta1) * sin2,
            Dynamics::Nips => driven,
        };
        let ddtheta2 = (driven - phi2) / (self.link2 - A::square(d2) / d1);
        let ddtheta1 = -(d2 * ddtheta2 + phi1) / d1;
        [dtheta1, dtheta2, ddtheta1, ddtheta2]
    }

    /// Cramer's rule on the equations for the absolute angles θ1 and θ1 + θ2, whose mass matrix is
    /// \[\[upper, c\], \[c, link2\]\] with c = coupling cos θ2. Its determinant is a sum of squares
    /// and positive constants, so that nothing cancels. The angles θ1 + θ2 − π/2 and θ1 − π/2 go by
    /// the addition theorem.
    #[inline(always)]
    pub(crate) fn lean<V: Numbers<S>>(
        &self,
        [_, _, dtheta1, dtheta2]: [V; 4],
        [(sin1, cos1), (sin2, cos2)]: [SinCos<V>; 2],
        torque: V,
    ) -> [V; 4] {
        // m1 lc1² + I1 + m2 l1², the determinant at a right angle, and which equations, as 1 and 0.
        let [upper, determinant, book, nips] = self.own;
        let (upper, determinant) = (V::splat(upper), V::splat(determinant));
        let (book, nips) = (V::splat(book), V::splat(nips));
        let (coupling, link2) = (V::splat(self.coupling), V::splat(self.link2));
        let (gravity1, gravity2) = (V::splat(self.gravity1), V::splat(self.gravity2));
        let coupling_cos = coupling * cos2;
        let coupling_sin = coupling * sin2;
        let sin_sum = sin1 * cos2 + cos1 * sin2;
        let dtheta_sum = dtheta1 + dtheta2;
        let square = dtheta1 * dtheta1;

        // The force on θ1 with its sign changed, and that on θ1 + θ2.
        let force1 =
            (gravity1 * sin1 - coupling_sin * (dtheta_sum * dtheta_sum - nips * square)) + torque;
        let force2 = torque - gravity2 * sin_sum - coupling_sin * (book * square);
        let inverse = V::splat(S::from_f64(1.0)) / (determinant + coupling_sin * coupling_sin);
        let common = link2 * force1 + coupling_cos * force2;
        let ddtheta1 = -(common * inverse);
        let ddtheta2 = (common + upper * force2 + coupling_cos * force1) * inverse;
        [dtheta1, dtheta2, ddtheta1, ddtheta2]
    }

    pub(crate) fn mass_matrix<A: Arithmetic<Scalar = S>>(&self, state: &State<S>) -> [[S; 2]; 2] {
        let Params {
            length1: l1,
            mass1: m1,
            mass2: m2,
            center_of_mass1: lc1,
            inertia1,
            ..
        } = self.params;
        let upper = m1 * A::square(lc1) + inertia1 + m2 * A::square(l1);
        let coupling = self.coupling * A::cos(state.theta2);
        let d2 = self.link2 + coupling;
        [[upper + coupling + d2, d2], [d2, self.link2]]
    }

    pub(crate) fn energy<A: Arithmetic<Scalar = S>>(&self, state: &State<S>) -> S {
        let State {
            dtheta1, dtheta2, ..
        } = *state;
        let [[m11, m12], [_, m22]] = self.mass_matrix::<A>(state);
        let momentum1 = m11 * dtheta1 + m12 * dtheta2;
        let momentum2 = m12 * dtheta1 + m22 * dtheta2;
        let kinetic = S::from_f64(0.5) * (momentum1 * dtheta1 + momentum2 * dtheta2);
        let [cos1, cos_sum] = absolute_cosines::<A>(state);
        kinetic - self.gravity1 * cos1 - self.gravity2 * cos_sum
    }

    pub(crate) fn tip_height<A: Arithmetic<Scalar = S>>(&self, state: &State<S>) -> S {
        let [cos1, cos_sum] = absolute_cosines::<A>(state);
        -self.params.length1 * cos1 - self.params.length2 * cos_sum
    }
}

/// A model under a torque in N m that stays for a step, of one acrobot or of many.
pub(crate) struct Driven<'a, A: Arithmetic, V> {
    arithmetic: PhantomData<A>,
    model: &'a Model<A::Scalar>,
    torque: V,
}

impl<'a, A: Arithmetic, V> Driven<'a, A, V> {
    #[inline(always)]
    pub(crate) fn new(model: &'a Model<A::Scalar>, torque: V) -> Self {
        Self {
            arithmetic: PhantomData,
            model,
            torque,
        }
    }
}

impl<A: Arithmetic> Derivative<A::Scalar, 4> for Driven<'_, A, A::Scalar> {
    /// \[θ̇1, θ̇2, θ̈1, θ̈2\] at `y` = \[θ1, θ2, θ̇1, θ̇2\].
    #[inline(always)]
    fn at(&self, y: [A::Scalar; 4]) -> [A::Scalar; 4] {
        let second = A::sin_cos_near(y[1]);
        match A::FORM {
            Form::Gymnasium => self.model.gymnasium::<A>(y, None, second, self.torque),
            Form::Lean => self
                .model
                .lean(y, [A::sin_cos_near(y[0]), second], self.torque),
        }
    }
}

impl<A: Arithmetic> Driven<'_, A, A::Scalar> {
    /// The same where the sines and cosines of θ1 and θ2 are known already.
    #[inline(always)]
    pub(crate) fn with_sin_cos(
        &self,
        y: [A::Scalar; 4],
        sin_cos: [SinCos<A::Scalar>; 2],
    ) -> [A::Scalar; 4] {
        let [(sin1, _), second] = sin_cos;
        match A::FORM {
            Form::Gymnasium => self
                .model
                .gymnasium::<A>(y, Some(sin1), second, self.torque),
            Form::Lean => self.model.lean(y, sin_cos, self.torque),
        }
    }
}

impl<const N: usize> Derivative<Lanes<N>, 4> for Driven<'_, Fast, Lanes<N>> {
    #[inline(always)]
    fn at(&self, y: [Lanes<N>; 4]) -> [Lanes<N>; 4] {
        self.model
            .lean(y, [kernel(y[0]), kernel(y[1])], self.torque)
    }
}

/// The cosines of both links' angles against the vertical; wrapped, because the sum of two large
/// angles may not be finite.
fn absolute_cosines<A: Arithmetic>(state: &State<A::Scalar>) -> [A::Scalar; 2] {
    let theta1 = wrap::<A>(state.theta1);
    [A::cos(theta1), A::cos(theta1 + wrap::<A>(state.theta2))]
}

/// Whether −cos θ1 − cos(θ1 + θ2) > 1: the goal of Gymnasium, whatever the lengths of the links.
#[inline]
pub(crate) fn reaches_goal<A: Arithmetic>(
    state: &State<A::Scalar>,
    [(sin1, cos1), (sin2, cos2)]: [SinCos<A::Scalar>; 2],
) -> bool {
    let cos_sum = match A::FORM {
        // Below the joint link 2 cannot reach: its cosine, at most 1, need not be computed.
        Form::Gymnasium if cos1 >= A::Scalar::ZERO => return false,
        Form::Gymnasium => A::cos(state.theta2 + state.theta1),
        Form::Lean => cos1 * cos2 - sin1 * sin2,
    };
    -cos1 - cos_sum > A::Scalar::from_f64(1.0)
}

/// The sines and cosines of θ1 and θ2, wherever they are.
pub(crate) fn sin_cos<A: Arithmetic>(state: &State<A::Scalar>) -> [SinCos<A::Scalar>; 2] {
    /// Apart, for flash: starts are few.
    #[inline(never)]
    fn apart<A: Arithmetic>(x: A::Scalar) -> SinCos<A::Scalar> {
        A::sin_cos(x)
    }
    [apart::<A>(state.theta1), apart::<A>(state.theta2)]
}

/// The equations of motion: \[θ̇1, θ̇2, θ̈1, θ̈2\] in rad/s and rad/s², at a state and under a torque
/// between the links in N m.
///
/// The arithmetic's [`Form`] decides the order of evaluation, and `params.dynamics` between the
/// equations of the book and those of the paper. Nothing is checked: values out of range give what
/// IEEE 754 gives. What depends on the parameters alone is computed anew with each call; an
/// [`Acrobot`](crate::Acrobot) keeps it.
///
/// ```
/// use acrobot::{Params, Portable, State, derivative};
///
/// let hanging = derivative::<Portable>(&Params::DEFAULT, &State::default(), 0.0);
/// assert!(hanging.iter().all(|rate| rate.abs() < 1e-15));
/// ```
#[must_use]
pub fn derivative<A: Arithmetic>(
    params: &Params<A::Scalar>,
    state: &State<A::Scalar>,
    torque: A::Scalar,
) -> [A::Scalar; 4] {
    let model = &Model::new::<A>(*params);
    let y: [A::Scalar; 4] = (*state).into();
    Driven::<A, _>::new(model, torque).with_sin_cos(y, sin_cos::<A>(state))
}

/// The mass matrix M at a state, kg m²: the kinetic energy is θ̇ᵀ M θ̇ / 2, and M is symmetric and
/// positive definite. Of parameters as extreme as for [`energy`] its numbers may be infinite or NaN.
///
/// ```
/// use acrobot::{Params, Portable, State, mass_matrix};
///
/// let stretched = mass_matrix::<Portable>(&Params::DEFAULT, &State::default());
/// assert_eq!(stretched, [[4.5, 1.75], [1.75, 1.25]]);
/// ```
#[must_use]
pub fn mass_matrix<A: Arithmetic>(
    params: &Params<A::Scalar>,
    state: &State<A::Scalar>,
) -> [[A::Scalar; 2]; 2] {
    Model::new::<A>(*params).mass_matrix::<A>(state)
}

/// The total mechanical energy of a state, J; the potential energy is 0 at the height of the fixed
/// joint, so that hanging at rest has the least.
///
/// The book's equations conserve it where the torque is 0; those of the paper do not. Where velocities or
/// parameters are so extreme that a part of it is beyond the scalar, it may be infinite or NaN.
///
/// ```
/// use acrobot::{Params, Portable, State, energy};
///
/// let hanging = energy::<Portable>(&Params::DEFAULT, &State::default());
/// assert!((hanging + 9.8 * (0.5 + 1.5)).abs() < 1e-12);
/// ```
#[must_use]
pub fn energy<A: Arithmetic>(params: &Params<A::Scalar>, state: &State<A::Scalar>) -> A::Scalar {
    Model::new::<A>(*params).energy::<A>(state)
}

/// The height of link 2's tip above the fixed joint, m: −l1 cos θ1 − l2 cos(θ1 + θ2), from
/// −(l1 + l2) hanging to l1 + l2 upright.
///
/// ```
/// use acrobot::{Params, Portable, State, tip_height};
///
/// assert_eq!(tip_height::<Portable>(&Params::DEFAULT, &State::default()), -2.0);
/// ```
#[must_use]
pub fn tip_height<A: Arithmetic>(
    params: &Params<A::Scalar>,
    state: &State<A::Scalar>,
) -> A::Scalar {
    Model::new::<A>(*params).tip_height::<A>(state)
}
