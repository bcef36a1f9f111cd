//! The deviation of a state from another one.

use crate::math::Real;
use crate::physics::{State, wrap};

/// The deviation of `state` from `target`, rad and rad/s. Differences of angles are wrapped to
/// \[−π, π\], so it is continuous upright, where θ1 jumps from π to −π.
#[must_use]
pub fn difference<S: Real>(state: State<S>, target: State<S>) -> [S; 4] {
    // Wrapped first, so that no difference overflows.
    let between = |x, y| wrap(wrap(x) - wrap(y));
    [
        between(state.theta1, target.theta1),
        between(state.theta2, target.theta2),
        state.dtheta1 - target.dtheta1,
        state.dtheta2 - target.dtheta2,
    ]
}
