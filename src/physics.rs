//! The pendulum alone: equations of motion, integrator and bounds, without a generator or an
//! environment.
//!
//! [`Pendulum`] has no random numbers, so it takes a third of the flash of an
//! [`Acrobot`](crate::Acrobot).
//!
//! [`control`](crate::control) linearizes, regulates and plans. The guide explains the
//! [equations](crate::guide::equations).

/// Repeats items for both scalars, named `S`: arithmetic in a `const fn` needs a concrete type.
macro_rules! for_f32_and_f64 {
    ($($item:item)*) => {
        const _: () = {
            type S = f32;
            $($item)*
        };
        #[allow(clippy::unnecessary_cast, reason = "the casts are necessary where S is `f32`")]
        const _: () = {
            type S = f64;
            $($item)*
        };
    };
}

pub(crate) mod arithmetic;
mod bounds;
mod equations;
mod friction;
mod geometry;
mod gymnasium;
mod lean;
pub(crate) mod model;
mod params;
mod pendulum;
mod rk4;
mod state;
mod step;

pub(crate) use arithmetic::{check_params, default_model, model};
pub(crate) use bounds::wrap_each;
pub use bounds::{saturate, wrap};
pub(crate) use friction::{coulomb_friction, friction};
pub(crate) use geometry::{directions, positions};
pub(crate) use model::{Constants, Defaults, Given, Model, Modeled, WIDTH};
pub use params::{Dynamics, Params};
pub(crate) use params::{FIELDS, NUMBERS};
pub use pendulum::Pendulum;
pub(crate) use pendulum::{check_torque, sin_cos};
pub(crate) use rk4::plus_scaled;
pub use state::State;
pub(crate) use step::step;
