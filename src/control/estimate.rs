//! Estimates the state of a machine from its angles alone, and its parameters.

mod estimator;
mod noise;

pub use estimator::{Estimator, KalmanFilter, ParameterEstimator};
pub use noise::{Noise, ParameterStd};
