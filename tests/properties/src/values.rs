//! The pure functions, for any numbers.

use std::f64::consts::TAU;

use acrobot::arithmetic::{Real, Reference};
use acrobot::physics::{Pendulum, wrap};
use acrobot::{Fast, Params, Portable, State};
use common::{bits, in_every_arithmetic};
use proptest::prelude::*;

use crate::given::{Range, Tested, holds, number};

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
