//! Keeping a state in its bounds: angles wrap around, velocities stop.

use crate::arithmetic::{Arithmetic, Form, Real};
use crate::params::Params;
use crate::state::State;

/// How many turns Gymnasium's `wrap` is followed before its remainder is taken at once.
const MAX_TURNS: u32 = 64;

/// The angle `x` rad brought to \[−π, π\] by whole turns.
///
/// In Gymnasium's form it subtracts turn by turn, as Gymnasium does, up to 64 of them; beyond, where
/// Gymnasium's would take ever longer or never return, it takes the remainder. The lean form subtracts
/// one rounded quotient, which is right to the spacing that `f32` has at `x`: 1.2e-7 |x|. Either takes −x
/// to the mirror image, in `f32` up to 2²² turns. An angle that is infinite or NaN gives NaN.
///
/// ```
/// use acrobot::{Fast, Portable, wrap};
///
/// assert_eq!(wrap::<Portable>(4.0), 4.0 - core::f64::consts::TAU);
/// assert_eq!(wrap::<Fast>(4.0), 4.0 - core::f32::consts::TAU);
/// assert!(wrap::<Fast>(1e30).abs() <= core::f32::consts::PI);
/// ```
#[must_use]
#[inline]
pub fn wrap<A: Arithmetic>(x: A::Scalar) -> A::Scalar {
    match A::FORM {
        Form::Gymnasium => wrap_by_turns(x),
        Form::Lean => wrap_by_quotient(x),
    }
}

#[inline]
fn wrap_by_turns<S: Real>(mut x: S) -> S {
    for _ in 0..MAX_TURNS {
        if x > S::PI {
            x = x - S::TAU;
        } else if x < -S::PI {
            x = x + S::TAU;
        } else {
            return x;
        }
    }
    wrap_by_remainder(x)
}

#[cold]
fn wrap_by_remainder<S: Real>(x: S) -> S {
    let x = x.remainder(S::TAU);
    let turn = if x > S::PI {
        -S::TAU
    } else if x < -S::PI {
        S::TAU
    } else {
        S::ZERO
    };
    bound(x + turn, S::PI)
}

#[inline]
pub(crate) fn wrap_by_quotient<S: Real>(x: S) -> S {
    // An angle within bounds is left alone, also one next to ±π.
    if x.abs() <= S::PI {
        return x;
    }
    let turns = (x * S::from_f64(1.0 / core::f64::consts::TAU)).round_small();
    // The bound is for angles so large that their spacing exceeds a turn.
    bound(x - turns * S::TAU, S::PI)
}

/// Whether a state is as a step leaves it: finite, angles within ±π, velocities within their bounds.
#[inline]
pub(crate) fn is_settled<S: Real>(state: &State<S>, params: &Params<S>) -> bool {
    state.theta1.abs() <= S::PI
        && state.theta2.abs() <= S::PI
        && state.dtheta1.abs() <= params.max_velocity1
        && state.dtheta2.abs() <= params.max_velocity2
}

/// Brings a step's result there: wraps the angles and bounds the velocities. One that is not finite
/// becomes the angles before the step, at rest.
///
/// Apart from the step because few results need it.
#[inline(never)]
pub(crate) fn settle<A: Arithmetic>(
    state: &mut State<A::Scalar>,
    [theta1, theta2]: [A::Scalar; 2],
    params: &Params<A::Scalar>,
) {
    if state.validate().is_err() {
        *state = State {
            theta1,
            theta2,
            ..State::default()
        };
    }
    state.theta1 = wrap::<A>(state.theta1);
    state.theta2 = wrap::<A>(state.theta2);
    state.dtheta1 = bound(state.dtheta1, params.max_velocity1);
    state.dtheta2 = bound(state.dtheta2, params.max_velocity2);
}

/// `x` brought to \[−`limit`, `limit`\], for a `limit` of 0 or more; NaN stays NaN.
#[must_use]
#[inline]
pub fn bound<S: Real>(x: S, limit: S) -> S {
    if x > limit {
        limit
    } else if x < -limit {
        -limit
    } else {
        x
    }
}
