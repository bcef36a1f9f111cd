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
//! For your own integrators and controllers, the functions [`derivative`], [`energy`], [`mass_matrix`], [`positions`]
//! and [`tip_height`] take any parameters and any state, and [`rk4`] integrates any derivative. The guide explains the
//! [equations](crate::guide::equations).

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

                #[inline(always)]
                fn common(&self) -> &Common<S> {
                    &self.common
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
mod gymnasium;
mod lean;
mod model;
mod params;
mod pendulum;
mod rk4;
mod state;
mod step;

pub use bounds::{bound, wrap};
pub use gymnasium::Gymnasium;
pub use lean::Lean;
pub(crate) use model::FromParams;
pub use params::{Dynamics, Params};
pub use pendulum::{Pendulum, derivative, energy, mass_matrix, positions, tip_height};
pub(crate) use pendulum::{check_torque, sin_cos};
pub use rk4::rk4;
pub use state::{ResetBounds, State};
pub(crate) use step::step;
