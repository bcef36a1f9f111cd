//! Linear models and inverse dynamics: methods of [`Pendulum`](crate::physics::Pendulum).

pub(crate) mod by_params;
mod inverse_dynamics;
mod linear_model;
pub(super) mod partials;
pub(crate) mod step_model;

pub use inverse_dynamics::Forces;
pub use linear_model::LinearModel;
pub use step_model::StepModel;
