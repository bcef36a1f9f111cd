//! The model: parameters, and the constants of the equations that follow from them.

use super::params::{Dynamics, Params};
use crate::error::Error;
use crate::math::Real;

/// How the equations of motion are evaluated. Both forms agree up to rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Form {
    /// Solved by Cramer's rule, with one division.
    Lean,
    /// As Gymnasium's source has them, with four divisions.
    Gymnasium,
}

/// The velocity, rad/s, from which on Coulomb friction is constant, if dt allows it. A machine that
/// friction holds creeps at less than this velocity, whatever its size: docs/equations.md has what
/// that means for small and large machines.
pub(crate) const WIDTH: f64 = 0.02;
/// RK4 is stable up to a rate of 2.78/dt. With Coulomb friction the rate is at most this.
const STABLE: f64 = 2.5;

/// The constants, of one acrobot or of many, named as in Sutton & Barto (1998), section 11.3.
#[derive(Clone, Copy, Debug)]
pub struct Constants<V> {
    /// 1 for the equations of the 1996 paper, otherwise 0.
    pub nips: V,
    /// m2 l1 lc2, kg m²: how strongly the links accelerate each other.
    pub coupling: V,
    /// m2 lc2² + I2, kg m²: the inertia of link 2 about its joint.
    pub link2: V,
    /// (m1 lc1 + m2 l1) g, N m.
    pub gravity1: V,
    /// m2 lc2 g, N m.
    pub gravity2: V,
    /// dt/2, s.
    pub half_dt: V,
    /// dt/6, s.
    pub sixth_dt: V,
    /// 1 over the velocity from which on Coulomb friction is constant, s/rad.
    pub inverse_width: V,
    /// Those of one form, which names them where it unpacks them.
    pub own: [V; 5],
}

/// The parameters, and the constants that follow from them: of one acrobot or of many.
#[derive(Clone, Copy, Debug)]
pub struct Model<V> {
    pub(crate) params: Params<V>,
    pub(crate) constants: Constants<V>,
}

impl<V: Copy> Model<V> {
    /// Applies `f` to each pair of numbers. The dynamics are those of `self`.
    #[inline(always)]
    pub(crate) fn zip<W: Copy, X>(
        &self,
        other: &Model<W>,
        f: impl Fn(&V, &W) -> X + Copy,
    ) -> Model<X> {
        let (one, two) = (&self.constants, &other.constants);
        let ([a, b, c, d, e], [v, w, x, y, z]) = (&one.own, &two.own);
        Model {
            params: self.params.zip(&other.params, f),
            constants: Constants {
                nips: f(&one.nips, &two.nips),
                coupling: f(&one.coupling, &two.coupling),
                link2: f(&one.link2, &two.link2),
                gravity1: f(&one.gravity1, &two.gravity1),
                gravity2: f(&one.gravity2, &two.gravity2),
                half_dt: f(&one.half_dt, &two.half_dt),
                sixth_dt: f(&one.sixth_dt, &two.sixth_dt),
                inverse_width: f(&one.inverse_width, &two.inverse_width),
                own: [f(a, v), f(b, w), f(c, x), f(d, y), f(e, z)],
            },
        }
    }
}

/// Parameters that are known at compile time.
pub trait Given {
    const PARAMS: Params;
}

/// Their models. A generic constant cannot compute them, so each scalar has a type that does.
pub trait Models<S> {
    const LEAN: Model<S>;
    const GYMNASIUM: Model<S>;
}

/// Gymnasium's parameters.
pub(crate) struct Defaults;

impl Given for Defaults {
    const PARAMS: Params = Params::<f64>::ACROBOT;
}

/// A scalar with the models of parameters that are known at compile time: `f32` or `f64`.
pub trait Modeled: Real {
    #[doc(hidden)]
    type Of<G: Given>: Models<Self>;

    #[doc(hidden)]
    const DEFAULT: Params<Self>;

    #[doc(hidden)]
    const SWINGUP: Params<Self>;

    #[doc(hidden)]
    fn check(params: &Params<Self>, has_friction: bool) -> Result<(), Error>;

    #[doc(hidden)]
    fn inertias(params: &Params<Self>) -> [Self; 4];

    #[doc(hidden)]
    fn moments(params: &Params<Self>) -> [Self; 2];

    /// The model of `params`, given l1², lc1² and lc2².
    #[doc(hidden)]
    fn model(
        form: Form,
        has_friction: bool,
        params: Params<Self>,
        squares: [Self; 3],
    ) -> Model<Self>;
}

impl<S: Modeled> Params<S> {
    /// The parameters of Gymnasium's `Acrobot-v1`, each rounded to the scalar.
    pub const DEFAULT: Self = S::DEFAULT;

    /// The parameters of dm_control's acrobot, whose velocities have no bounds.
    pub const SWINGUP: Self = S::SWINGUP;

    /// Checks every field against the range in its documentation. With extreme but valid parameters
    /// [a step can still overflow](super::Pendulum#results-that-are-not-finite).
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] with the first field outside its range, and for a link without inertia
    /// about its joint.
    pub fn validate(&self) -> Result<(), Error> {
        S::check(self, true)
    }
}

for_f32_and_f64! {
    impl Model<S> {
        /// See [`Modeled::model`]. Squares are given, because `Host` computes them with the C
        /// library.
        #[inline(always)]
        pub(crate) const fn new(
            form: Form,
            has_friction: bool,
            mut params: Params<S>,
            squares: [S; 3],
        ) -> Self {
            params.max_velocity1 = Self::in_f32(params.max_velocity1);
            params.max_velocity2 = Self::in_f32(params.max_velocity2);
            let Params { inertia2, gravity, dt, .. } = params;
            let nips = match params.dynamics {
                Dynamics::Book => 0.0,
                Dynamics::Nips => 1.0,
            };
            let [moment1, moment2] = params.moments();
            let [link1, tip, link2, coupling] = params.inertias_by(squares);
            let own = match form {
                Form::Lean => {
                    // Of the mass matrix where θ2 is ±π/2, kg² m⁴.
                    let determinant = link1 * link2 + tip * inertia2;
                    let Params { coulomb1, coulomb2, rotor, .. } = params;
                    let dry = if has_friction { coulomb1 + coulomb2 + rotor.abs() } else { 0.0 };
                    [link1 + tip, determinant, 1.0 - nips, dry, 0.0]
                }
                Form::Gymnasium => {
                    let [l1_squared, lc1_squared, lc2_squared] = squares;
                    let (arms_squared, arms) =
                        (l1_squared + lc2_squared, params.length1 * params.center_of_mass2);
                    [params.mass1 * lc1_squared, arms_squared, arms, lc2_squared, 2.0 * coupling]
                }
            };
            let constants = Constants {
                nips,
                coupling,
                link2,
                gravity1: moment1 * gravity,
                gravity2: moment2 * gravity,
                half_dt: dt * 0.5,
                sixth_dt: dt / 6.0,
                inverse_width: if has_friction { 1.0 / Self::width(&params) } else { 0.0 },
                own,
            };
            Self { params, constants }
        }

        /// The velocity from which on Coulomb friction is constant, rad/s: so wide that a step is
        /// stable. At rest the rates are those of M⁻¹ (B + C), where B has the slopes of viscous
        /// friction and C those of Coulomb's. Their sum is convex in cos θ2, so largest where the
        /// elbow is straight or folded. Infinite where viscous friction leaves Coulomb's no rate.
        const fn width(params: &Params<S>) -> S {
            let [link1, tip, link2, coupling] = params.inertias();
            let upper = link1 + tip;
            let &Params { damping1, damping2, coulomb1, coulomb2, .. } = params;
            let mut width = WIDTH as S;
            let mut ends: &[S] = &[coupling - params.rotor, -coupling - params.rotor];
            while let &[between, ref left @ ..] = ends {
                let inertia1 = upper + link2 + 2.0 * between;
                let determinant = upper * link2 - between * between;
                let of_viscous = damping1 * link2 + damping2 * inertia1;
                let of_coulomb = coulomb1 * link2 + coulomb2 * inertia1;
                let rest = STABLE as S - of_viscous / determinant * params.dt;
                let least = 1.5 * of_coulomb / determinant * params.dt / rest;
                let least = if rest > 0.0 { least } else { S::INFINITY };
                if least > width {
                    width = least;
                }
                ends = left;
            }
            width
        }

        const fn in_f32(bound: S) -> S {
            const LARGEST: S = f32::MAX as S;
            if bound > LARGEST { LARGEST } else { bound }
        }
    }

    const _: () = {
        #[derive(Debug)]
        pub struct Of<G>(core::marker::PhantomData<G>);

        impl<G: Given> Of<G> {
            const fn model(form: Form) -> Model<S> {
                let params = Params::<S>::round(G::PARAMS);
                let (l1, lc1, lc2) =
                    (params.length1, params.center_of_mass1, params.center_of_mass2);
                Model::<S>::new(form, true, params, [l1 * l1, lc1 * lc1, lc2 * lc2])
            }
        }

        impl<G: Given> Models<S> for Of<G> {
            const LEAN: Model<S> = Self::model(Form::Lean);
            const GYMNASIUM: Model<S> = Self::model(Form::Gymnasium);
        }

        impl Modeled for S {
            type Of<G: Given> = Of<G>;

            const DEFAULT: Params<Self> = Params::<S>::ACROBOT;
            const SWINGUP: Params<Self> = Params::<S>::CAPSULES;

            fn check(params: &Params<Self>, has_friction: bool) -> Result<(), Error> {
                params.check(has_friction)
            }

            #[inline(always)]
            fn inertias(params: &Params<Self>) -> [Self; 4] {
                params.inertias()
            }

            #[inline(always)]
            fn moments(params: &Params<Self>) -> [Self; 2] {
                params.moments()
            }

            #[inline(always)]
            fn model(
                form: Form,
                has_friction: bool,
                params: Params<Self>,
                squares: [Self; 3],
            ) -> Model<Self> {
                Model::<S>::new(form, has_friction, params, squares)
            }
        }
    };
}
