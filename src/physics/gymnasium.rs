//! Gymnasium's expressions, operation by operation.

use core::marker::PhantomData;

use super::common::{Common, FromParams};
use super::equations::{Arithmetic, Form, Model};
use super::friction::{Friction, Frictionless, resist};
use super::params::Params;
use crate::math::{Numbers, Real, SinCos};

/// The equations as Gymnasium's source has them: four divisions and four trigonometric calls for each evaluation.
/// `F` is the friction of the joints.
#[derive(Clone, Copy, Debug)]
pub struct Gymnasium<F = Frictionless>(PhantomData<F>);

/// The constants.
#[derive(Clone, Copy, Debug)]
pub struct Constants<V> {
    common: Common<V>,
    /// m1 lc1², kg m².
    link1: V,
    /// l1² + lc2², m².
    arms_squared: V,
    /// l1 lc2, m².
    arms_product: V,
    /// lc2², m².
    lc2_squared: V,
    /// 2 m2 l1 lc2, kg m².
    twice_coupling: V,
}

for_f32_and_f64! {
    impl Constants<S> {
        /// From parameters and l1², lc1² and lc2².
        pub(crate) const fn new(
            params: &Params<S, impl Copy>,
            [l1_squared, lc1_squared, lc2_squared]: [S; 3],
        ) -> Self {
            let common = Common::<S>::new(params, lc2_squared);
            Self {
                common,
                link1: params.mass1 * lc1_squared,
                arms_squared: l1_squared + lc2_squared,
                arms_product: params.length1 * params.center_of_mass2,
                lc2_squared,
                twice_coupling: 2.0 * common.coupling,
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

const MAX_TURNS: u32 = 64;

impl<S: Real, F: Friction<S, Of<S> = F>> Form<S> for Gymnasium<F>
where
    Constants<S>: FromParams<S>,
{
    type Friction = F;
    type Constants<V: Numbers<S>> = Constants<V>;
    const DEFAULT: Constants<S> = FromParams::DEFAULT;
    const COMPACT: bool = false;

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
            link1: f(constants.link1, numbers.link1),
            arms_squared: f(constants.arms_squared, numbers.arms_squared),
            arms_product: f(constants.arms_product, numbers.arms_product),
            lc2_squared: f(constants.lc2_squared, numbers.lc2_squared),
            twice_coupling: f(constants.twice_coupling, numbers.twice_coupling),
        }
    }

    /// `AcrobotEnv._dsdt`, except for the place of the factors 2, which are exact.
    // Inlined with `std`, because `Host` takes a tenth longer otherwise. On a microcontroller inlining would cost flash
    // and gain nothing.
    #[cfg_attr(feature = "std", inline(always))]
    fn derivative<A: Arithmetic<Scalar = S, Form = Self>, V: Numbers<S>>(
        model: &Model<A, V>,
        [theta1, theta2, dtheta1, dtheta2]: [V; 4],
        sin_cos: Option<[SinCos<V>; 2]>,
        torque: V,
    ) -> [V; 4] {
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
            link1,
            arms_squared,
            arms_product,
            lc2_squared,
            twice_coupling,
        } = &model.constants;
        let &Params {
            mass2: m2,
            inertia1,
            inertia2,
            ..
        } = &model.params;
        let (sin2, cos2) = match sin_cos {
            Some([_, second]) => second,
            None => A::sin_cos_near(theta2),
        };
        let (quarter, two) = (V::splat(S::PI * S::HALF), V::splat(S::from_f64(2.0)));
        let square = |x: V| x.map(A::square);

        // Computed first, because no float stays in a register across a call on x86-64.
        let phi2 = gravity2 * (theta1 + theta2 - quarter).map(A::cos);
        let cos1 = (theta1 - quarter).map(A::cos);
        let arm = arms_product * cos2;
        let d1 = link1 + m2 * (arms_squared + two * arm) + inertia1 + inertia2;
        let d2 = m2 * (lc2_squared + arm) + inertia2;
        let velocities = [dtheta1, dtheta2];
        let (torque, resistance) = resist::<S, F, V>(&model.params.friction, torque, velocities);
        let mut phi1 = -coupling * square(dtheta2) * sin2
            - twice_coupling * dtheta2 * dtheta1 * sin2
            + gravity1 * cos1
            + phi2;
        if let Some(resistance) = resistance {
            phi1 = phi1 + resistance;
        }
        let driven = torque + d2 / d1 * phi1;
        let centrifugal = coupling * square(dtheta1) * sin2;
        let driven = nips.select_within(S::ZERO, driven - centrifugal, driven);
        let ddtheta2 = (driven - phi2) / (link2 - square(d2) / d1);
        let ddtheta1 = -(d2 * ddtheta2 + phi1) / d1;
        [dtheta1, dtheta2, ddtheta1, ddtheta2]
    }

    /// Subtracts turn by turn, as Gymnasium does. Beyond `MAX_TURNS`, where Gymnasium takes long or never returns, it
    /// takes the remainder.
    #[inline(always)]
    fn wrap<V: Numbers<S>>(x: V) -> V {
        x.map(|mut x| {
            for _ in 0..MAX_TURNS {
                if x > S::PI {
                    x = x - S::TAU;
                } else if x < -S::PI {
                    x = x + S::TAU;
                } else {
                    return x;
                }
            }
            wrap_by_remainder(x)
        })
    }

    #[inline(always)]
    fn reaches_goal<A: Arithmetic<Scalar = S>, V: Numbers<S>>(
        [theta1, theta2]: [V; 2],
        [(_, cos1), _]: [SinCos<V>; 2],
    ) -> V::Mask {
        let height = cos1.zip(theta2 + theta1, |cos1, sum| {
            // Without a positive −cos θ1 the sum cannot exceed 1, so the second cosine is not computed.
            if cos1 >= S::ZERO {
                S::ZERO
            } else {
                -cos1 - A::cos(sum)
            }
        });
        height.above(S::ONE)
    }
}

#[cold]
fn wrap_by_remainder<S: Real>(x: S) -> S {
    let x = x.remainder(S::TAU);
    let turn = if x > S::PI {
        -S::TAU
    } else if x < -S::PI {
        S::TAU
    } else {
        S::ZERO
    };
    (x + turn).bound(S::PI)
}
