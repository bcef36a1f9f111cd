//! The pendulum alone: equations of motion, integrator and bounds, without a generator or an environment.
//!
//! [`Pendulum`] is the fast way to simulate: it caches the constants that depend on the parameters, and the sines and
//! cosines of its angles. It has no code for random numbers, so it takes about a third of the flash of an
//! [`Acrobot`](crate::Acrobot).
//!
//! ```
//! use acrobot::Fast;
//! use acrobot::physics::Pendulum;
//!
//! let mut pendulum = Pendulum::<Fast>::hanging();
//! for _ in 0..50 {
//!     let torque = if pendulum.state().dtheta1 > 0.0 { -1.0 } else { 1.0 }; // N m
//!     pendulum.step(torque)?;
//! }
//! assert!(pendulum.tip_height() > -2.0); // m
//! # Ok::<(), acrobot::Error>(())
//! ```
//!
//! For your own integrator, use [`Pendulum::derivative`]. The module [`control`] linearizes and regulates. The guide
//! explains the [equations](crate::guide::equations).

/// Repeats items for both scalars, named `S`: arithmetic in a `const fn` needs a concrete type.
macro_rules! for_f32_and_f64 {
    ($($item:item)*) => {
        const _: () = {
            type S = f32;
            $($item)*
        };
        const _: () = {
            type S = f64;
            $($item)*
        };
    };
}

/// Declares a struct of numbers `V`: one for all lanes, or one for each.
macro_rules! numbers {
    (
        $(#[$attribute:meta])*
        struct $name:ident$(($common:ident: Common<V>))? {
            $($(#[$doc:meta])* $number:ident: V,)*
        }
    ) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name<V> {
            $(pub $common: Common<V>,)?
            $($(#[$doc])* pub $number: V,)*
        }

        impl<V: Zeroed> Zeroed for $name<V> {
            const ZEROED: Self = Self {
                $($common: Zeroed::ZEROED,)?
                $($number: Zeroed::ZEROED,)*
            };
        }

        impl<V> $name<V> {
            /// Applies `f` to each pair of numbers.
            #[inline(always)]
            pub fn zip<W, X>(self, other: $name<W>, f: impl Fn(V, W) -> X + Copy) -> $name<X> {
                $name {
                    $($common: self.$common.zip(other.$common, f),)?
                    $($number: f(self.$number, other.$number),)*
                }
            }
        }
    };
}

/// The items of `Equations` that concern the `Constants` of a form.
macro_rules! equations_with_constants {
    () => {
        type Constants<V: Numbers<S>> = Constants<V>;
        const DEFAULT: Constants<S> = FromParams::DEFAULT;

        #[inline(always)]
        fn constants(params: &Params<S>, squares: [S; 3]) -> Constants<S> {
            FromParams::new(params, squares)
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
            constants.zip(numbers, f)
        }
    };
}

/// Implements `FromParams` for the `Constants` of a form. The block computes them from the parameters and l1², lc1²,
/// lc2².
macro_rules! constants_of_form {
    (|$params:ident, $squares:pat_param| $constants:block) => {
        for_f32_and_f64! {
            impl FromParams<S> for Constants<S> {
                const DEFAULT: Self = Self::compute(&Params::DEFAULT, [1.0, 0.25, 0.25]);

                fn new(params: &Params<S>, squares: [S; 3]) -> Self {
                    Self::compute(params, squares)
                }
            }

            impl Constants<S> {
                const fn compute($params: &Params<S>, $squares: [S; 3]) -> Self {
                    $constants
                }
            }
        }
    };
}

mod bounds;
pub mod control;
pub(crate) mod equations;
mod gymnasium;
mod lean;
mod model;
mod params;
mod params_range;
mod pendulum;
mod rk4;
mod state;
mod step;

pub use bounds::{bound, wrap};
pub(crate) use equations::{Arithmetic, Coefficients, Constants, Equations, Model};
pub use gymnasium::Gymnasium;
pub use lean::Lean;
pub use params::{Dynamics, Params};
pub use params_range::ParamsRange;
pub use pendulum::Pendulum;
pub(crate) use pendulum::{check_torque, sin_cos};
pub use rk4::rk4;
pub use state::{ResetBounds, State};
pub(crate) use step::step;
