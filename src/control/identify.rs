//! Identifies a machine from recordings of its angles and torques.

mod calibrate;
mod recording;
mod regression;
mod windows;

pub use calibrate::{Calibration, calibrate};
pub use recording::Sample;
pub use regression::{Fit, Regression};
pub use windows::{identify, prediction_error};
