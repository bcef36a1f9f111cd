//! Identifies a machine from recordings of its angles and torques.

mod regression;
mod windows;

pub use regression::{Fit, Regression, Sample};
pub use windows::{identify, prediction_error};
