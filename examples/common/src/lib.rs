//! Code that several example programs share.

pub mod animation;
pub mod exit;
pub mod files;
pub mod heat_map;
pub mod search;
pub mod svg;
pub mod weights;

use acrobot::Action;

/// The bang-bang policy: torque against θ̇1, in rad/s.
pub fn bang_bang(dtheta1: impl Into<f64>) -> Action {
    if dtheta1.into() > 0.0 {
        Action::Negative
    } else {
        Action::Positive
    }
}
