//! The pure functions, for any numbers.

use std::f64::consts::TAU;

use acrobot::arithmetic::{Damped, Real, Reference};
use acrobot::physics::{Pendulum, bound, wrap};
use acrobot::{Fast, Observation, Params, Portable, State};
use common::{bits, in_every_arithmetic};
use proptest::prelude::*;

use crate::given::{Range, Tested, acrobot, holds, number, params, state};

/// The angle x after a step in which nothing moves.
fn stepped<A: Tested>(x: A::Scalar) -> A::Scalar {
    let zero = A::Scalar::ZERO;
    let params = Params::<A::Scalar> { gravity: zero, ..Default::default() };
    let mut pendulum = Pendulum::<A>::new(params, State::from([x, zero, zero, zero])).unwrap();
    pendulum.step(zero).unwrap();
    pendulum.state().theta1
}

#[test]
fn angles_wrap_into_half_a_turn_to_either_side() {
    fn check<A: Tested>() {
        // The lean form counts turns exactly up to 2²² in `f32` and 2⁵¹ in `f64`, and beyond not
        // symmetrically.
        let counted = match size_of::<A::Scalar>() {
            8 => TAU * (1_u64 << 51) as f64,
            _ => TAU * f64::from(1 << 22),
        };
        let is_lean = !["host", "reference"].iter().any(|name| A::NAME.ends_with(name));
        holds(5000, number::<A::Scalar>(Range::Any), |x| {
            let pi = A::Scalar::PI;
            let (wrapped, after_step) = (wrap(x), stepped::<A>(x));
            for (wrapped, mirrored, counted) in [
                (wrapped, wrap(-x), counted),
                (after_step, stepped::<A>(-x), if is_lean { counted } else { f64::INFINITY }),
            ] {
                assert!(-pi <= wrapped && wrapped <= pi, "{wrapped}");
                if x.to_f64().abs() <= counted {
                    assert_eq!(mirrored, -wrapped);
                }
            }
            if is_lean {
                assert_eq!(after_step, wrapped);
            }
            if -pi <= x && x <= pi {
                assert_eq!(bits([wrapped]), bits([x]));
                assert_eq!(after_step, x);
            }
        });
        for pi in [A::Scalar::PI, -A::Scalar::PI] {
            assert_eq!([wrap(pi), stepped::<A>(pi)], [pi; 2]);
        }
    }
    in_every_arithmetic!(check);
}

#[test]
fn angles_wrap_by_whole_turns() {
    /// Rounding is relative to x, and to π near 0.
    fn check<A: Tested>(wrap: fn(A::Scalar) -> A::Scalar, [relative, absolute]: [f64; 2]) {
        let angle = (0.0..15.0_f64).prop_map(f64::exp);
        holds(5000, (angle, any::<bool>()), |(x, negative)| {
            let x = A::Scalar::from_f64(if negative { -x } else { x });
            let (x, wrapped) = (x.to_f64(), wrap(x).to_f64());
            let turns = (x - wrapped) / TAU;
            let error = (turns - turns.round()).abs() * TAU;
            assert!(error <= relative * x.abs() + absolute, "{error:e}");
        });
    }
    check::<Fast>(wrap, [1.2e-7, 2e-7]);
    check::<Portable>(wrap, [5e-16, 4e-16]);
    // Up to 64 turns it subtracts one by one.
    check::<Reference>(stepped::<Reference>, [1e-14, 4e-16]);
}

#[test]
fn bound_is_clamp() {
    fn check<A: Tested>() {
        let given = (number::<A::Scalar>(Range::Any), number(Range::Any));
        holds(1000, given, |(x, limit): (A::Scalar, A::Scalar)| {
            let limit = if limit < A::Scalar::ZERO { -limit } else { limit };
            let clamped = x.to_f64().clamp(-limit.to_f64(), limit.to_f64());
            assert_eq!(bound(x, limit).to_f64(), clamped);
        });
    }
    in_every_arithmetic!(check);
}

#[test]
fn sines_and_cosines_are_on_the_unit_circle() {
    fn check<A: Tested>() {
        holds(5000, number::<A::Scalar>(Range::Any), |x| {
            let (sin, cos) = A::sin_cos(x);
            let [sine, cosine] = [sin, cos].map(Real::to_f64);
            assert!(sine.abs() <= 1.0 && cosine.abs() <= 1.0, "{sine} {cosine}");
            let radius = sine * sine + cosine * cosine;
            // For large angles, which are far apart in `f32`, `Micro` leaves the range of its
            // polynomials.
            assert!((radius - 1.0).abs() <= 1e-4, "{radius}");
            assert_eq!(A::sin_cos(-x), (-sin, cos));
            // Farther, any result is valid.
            if x.to_f64().abs() <= 524_288.0 {
                assert_eq!(bits([A::cos_near(x)]), bits([cos]));
            }
        });
    }
    in_every_arithmetic!(check);
}

/// An acrobot returns the parameters and the state that it was given, and the tip is within reach.
#[test]
fn the_tip_is_within_reach() {
    fn check<A: Tested>() {
        let given = (params::<A>(Range::Any), state(Range::Any));
        holds(1000, given, |(params, state)| {
            let acrobot = acrobot::<A>(params, state, 0);
            assert_eq!(acrobot.params(), &params);
            assert_eq!(acrobot.state(), state);
            let height = acrobot.pendulum().tip_height();
            // As above, `Micro`'s sines of large angles are not quite on the unit circle.
            let reach = A::Scalar::from_f64(1.0001) * (params.length1 + params.length2);
            assert!(-reach <= height && height <= reach, "{height}");

            let angles = Observation::<4>::from(state);
            assert_eq!(angles.to_array(), <[A::Scalar; 4]>::from(state).map(|x| x.to_f64() as f32));
        });
    }
    in_every_arithmetic!(check);
}

/// For moderate parameters and states. Extreme ones can exceed the range of the scalar.
#[test]
fn the_equations_are_those_of_a_pendulum() {
    fn check<A: Tested>() {
        let given = (params::<A>(Range::Moderate), state(Range::Moderate), number(Range::Moderate));
        holds(2000, given, |(params, state, torque)| {
            let mut pendulum = Pendulum::<A>::new(params, state).unwrap();
            let rates = pendulum.derivative(torque).map(Real::to_f64);
            assert!(rates.into_iter().all(f64::is_finite), "{rates:?}");
            let State { dtheta1, dtheta2, .. } = state.cast::<f64>();
            assert_eq!(rates[..2], [dtheta1, dtheta2]);

            let [[m11, m12], [m21, m22]] = pendulum.mass_matrix().map(|row| row.map(Real::to_f64));
            assert_eq!(m12, m21);
            assert!(m11 > 0.0 && m22 > 0.0, "{m11} {m22}");

            // The kinetic energy is never negative, except for rounding where parts cancel.
            let total = pendulum.energy().to_f64();
            let at_rest = State { dtheta1: A::Scalar::ZERO, dtheta2: A::Scalar::ZERO, ..state };
            pendulum.set_state(at_rest).unwrap();
            let potential = pendulum.energy().to_f64();
            let parts = m11 * dtheta1 * dtheta1 + m22 * dtheta2 * dtheta2 + potential.abs();
            assert!(total >= potential - 1e-5 * parts, "{total} {potential}");
        });
    }
    in_every_arithmetic!(check);
}

#[test]
fn casts_to_a_wider_scalar_are_exact() {
    holds(
        1000,
        (params::<Damped<Fast>>(Range::Any), state::<f32>(Range::Any)),
        |(params, state)| {
            assert_eq!(params.cast::<f64>().cast::<f32>(), params);
            assert_eq!(bits(state.cast::<f64>().cast::<f32>()), bits(state));
            assert_eq!(params.cast::<f64>().validate(), Ok(()));
        },
    );
}
