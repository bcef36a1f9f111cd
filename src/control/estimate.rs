//! Estimates the state of a machine from its angles alone, and its parameters.

mod estimator;
mod limits;
mod noise;
mod parameter_std;
mod predicted;

pub use estimator::{Estimator, KalmanFilter, ParameterEstimator};
pub use noise::Noise;
pub use parameter_std::ParameterStd;
pub(in crate::control) use parameter_std::USUAL;
