//! The lean form: one division and the sines and cosines of θ1 and θ2 for each evaluation.

use core::marker::PhantomData;

use super::bounds::wrap_each;
use super::common::{Common, FromParams};
use super::equations::{Arithmetic, Form, Model};
use super::friction::{Friction, Frictionless, resist};
use super::params::Params;
use crate::math::{Numbers, Real, SinCos};

/// The equations solved by Cramer's rule, with one division: for arithmetics that need not have Gymnasium's bits.
/// `F` is the friction of the joints.
#[derive(Clone, Copy, Debug)]
pub struct Lean<F = Frictionless>(PhantomData<F>);

/// The equations for the absolute angles θ1 and θ1 + θ2 have the mass matrix
/// \[\[upper, c\], \[c, link2\]\] with c = coupling cos θ2.
#[derive(Clone, Copy, Debug)]
pub struct Constants<V> {
    common: Common<V>,
    /// m1 lc1² + I1 + m2 l1², kg m².
    upper: V,
    /// The determinant at θ2 = ±π/2, where c is 0, kg² m⁴.
    determinant: V,
    /// 1 for the equations of the book, otherwise 0.
    book: V,
}

for_f32_and_f64! {
    impl Constants<S> {
        /// From parameters and l1², lc1² and lc2².
        pub(crate) const fn new(
            params: &Params<S, impl Copy>,
            [l1_squared, lc1_squared, lc2_squared]: [S; 3],
        ) -> Self {
            let common = Common::<S>::new(params, lc2_squared);
            let link1 = params.mass1 * lc1_squared + params.inertia1;
            let m2_l1_squared = params.mass2 * l1_squared;
            Self {
                common,
                upper: link1 + m2_l1_squared,
                determinant: link1 * common.link2 + m2_l1_squared * params.inertia2,
                book: 1.0 - common.nips,
            }
        }
    }

    impl FromParams<S> for Constants<S> {
        const DEFAULT: Self = Self::new(&Params::DEFAULT, [1.0, 0.25, 0.25]);

        fn from_params(params: &Params<S, impl Copy>, squares: [S; 3]) -> Self {
            Self::new(params, squares)
        }
    }
}

impl<S: Real, F: Friction<S, Of<S> = F>> Form<S> for Lean<F>
where
    Constants<S>: FromParams<S>,
{
    type Friction = F;
    type Constants<V: Numbers<S>> = Constants<V>;
    const DEFAULT: Constants<S> = FromParams::DEFAULT;
    const COMPACT: bool = true;

    #[inline(always)]
    fn constants(params: &Params<S, F>, squares: [S; 3]) -> Constants<S> {
        FromParams::from_params(params, squares)
    }

    #[inline(always)]
    fn common<V: Numbers<S>>(constants: &Constants<V>) -> &Common<V> {
        &constants.common
    }

    #[inline(always)]
    fn zip<V: Numbers<S>, W: Numbers<S>>(
        constants: Constants<V>,
        numbers: Constants<S>,
        f: impl Fn(V, S) -> W + Copy,
    ) -> Constants<W> {
        Constants {
            common: constants.common.zip(numbers.common, f),
            upper: f(constants.upper, numbers.upper),
            determinant: f(constants.determinant, numbers.determinant),
            book: f(constants.book, numbers.book),
        }
    }

    /// The determinant is a positive constant plus a square, so nothing cancels. Gymnasium's cos(θ1 − π/2) is sin θ1
    /// here, and its cos(θ1 + θ2 − π/2) is sin(θ1 + θ2), by the addition theorem.
    #[inline(always)]
    fn derivative<A: Arithmetic<Scalar = S, Form = Self>, V: Numbers<S>>(
        model: &Model<A, V>,
        [theta1, theta2, dtheta1, dtheta2]: [V; 4],
        sin_cos: Option<[SinCos<V>; 2]>,
        torque: V,
    ) -> [V; 4] {
        let [(sin1, cos1), (sin2, cos2)] = match sin_cos {
            Some(sin_cos) => sin_cos,
            None => [A::sin_cos_near(theta1), A::sin_cos_near(theta2)],
        };
        let &Constants {
            common:
                Common {
                    coupling,
                    link2,
                    gravity1,
                    gravity2,
                    nips,
                    ..
                },
            upper,
            determinant,
            book,
        } = &model.constants;
        let coupling_cos = coupling * cos2;
        let coupling_sin = coupling * sin2;
        let sin_sum = sin1 * cos2 + cos1 * sin2;
        let dtheta_sum = dtheta1 + dtheta2;
        let square = dtheta1 * dtheta1;

        // The generalized forces: the negated one on θ1, and the one on θ1 + θ2.
        let velocities = [dtheta1, dtheta2];
        let (torque, resistance) = resist::<S, F, V>(&model.params.friction, torque, velocities);
        let mut force1 =
            (gravity1 * sin1 - coupling_sin * (dtheta_sum * dtheta_sum - nips * square)) + torque;
        if let Some(resistance) = resistance {
            force1 = force1 + resistance;
        }
        let force2 = torque - gravity2 * sin_sum - coupling_sin * (book * square);
        let inverse = V::splat(S::ONE) / (determinant + coupling_sin * coupling_sin);
        let common = link2 * force1 + coupling_cos * force2;
        let ddtheta1 = -(common * inverse);
        let ddtheta2 = (common + upper * force2 + coupling_cos * force1) * inverse;
        [dtheta1, dtheta2, ddtheta1, ddtheta2]
    }

    /// Subtracts the rounded number of turns at once.
    #[inline(always)]
    fn wrap<V: Numbers<S>>(x: V) -> V {
        wrap_each(x)
    }

    #[inline(always)]
    fn reaches_goal<A: Arithmetic<Scalar = S>, V: Numbers<S>>(
        _: [V; 2],
        [(sin1, cos1), (sin2, cos2)]: [SinCos<V>; 2],
    ) -> V::Mask {
        let cos_sum = cos1 * cos2 - sin1 * sin2;
        (-cos1 - cos_sum).above(S::ONE)
    }
}
