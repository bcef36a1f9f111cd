//! An acrobot in any arithmetic, with any values set at any time, and a pendulum that must agree.

#![no_main]

use std::str::FromStr;

use acrobot::arithmetic::{Arithmetic, Host, Micro, Real};
use acrobot::numpy::SeedSequence;
use acrobot::physics::{Pendulum, ResetBounds, wrap};
use acrobot::trajectory::Trajectory;
use acrobot::{Acrobot, Action, Fast, Portable, ResetOptions, TimeLimit};
use acrobot_fuzz::{assert_seen, assert_settled, assert_stepped, bits, number, params, state};
use libfuzzer_sys::arbitrary::{Result, Unstructured};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut u = Unstructured::new(bytes);
    // The end of the bytes is the end of the sequence.
    let _ = match u.int_in_range(0..=3) {
        Ok(0) => sequence::<Portable>(&mut u),
        Ok(1) => sequence::<Fast>(&mut u),
        Ok(2) => sequence::<Micro>(&mut u),
        _ => sequence::<Host>(&mut u),
    };
});

fn sequence<A: Arithmetic<Scalar: FromStr>>(u: &mut Unstructured<'_>) -> Result<()> {
    let real = A::Scalar::from_f64;
    let mut acrobot = Acrobot::<A>::new(u.arbitrary::<u64>()?);
    while !u.is_empty() {
        let before = acrobot.clone();
        let rejected = match u.int_in_range(0..=7)? {
            0 => {
                let params = params(u)?.cast();
                let set = acrobot.set_params(params);
                assert_eq!(set.is_ok(), params.validate().is_ok());
                assert!(set.is_err() || *acrobot.params() == params);
                set.is_err()
            }
            1 => {
                let state = state(u)?.cast();
                let set = acrobot.set_state(state);
                assert_eq!(set.is_ok(), state.validate().is_ok());
                assert!(set.is_err() || acrobot.state() == state);
                set.is_err()
            }
            2 => {
                let torque = real(number(u, 1.0)?);
                let pendulum = Pendulum::<A>::new(*acrobot.params(), acrobot.state());
                let mut pendulum = pendulum.expect("an acrobot's parameters and state are valid");
                assert_eq!(pendulum.positions(), acrobot.pendulum().positions());
                let step = acrobot.step_torque(torque);
                assert_eq!(step.is_ok(), torque.is_finite());
                if let Ok(step) = step {
                    assert_stepped(step, acrobot.state(), acrobot.params());
                }
                // A pendulum has no noise.
                if acrobot.params().torque_noise.to_f64() == 0.0 {
                    let terminated = step.ok().map(|step| step.terminated);
                    assert_eq!(pendulum.step(torque).ok(), terminated);
                    assert_eq!(bits(pendulum.state()), bits(acrobot.state()));
                }
                step.is_err()
            }
            3 => {
                let (low, high) = (number(u, -0.1)?, number(u, 0.1)?);
                let bounds = ResetBounds::new(low, high);
                let in_f32 = |x: f64| (x.abs() <= f32::MAX.into()).then_some(x);
                let valid = in_f32(low)
                    .zip(in_f32(high))
                    .is_some_and(|(low, high)| low <= high);
                assert_eq!(bounds.is_ok(), valid);
                if let Ok(bounds) = bounds {
                    acrobot.reset_with(bounds.into());
                    let [low, high] = [low, high].map(|bound| f64::from(bound as f32));
                    for x in <[f64; 4]>::from(acrobot.state().cast::<f64>()) {
                        assert!((low..=high).contains(&x), "{x} of {low} to {high}");
                    }
                }
                bounds.is_err()
            }
            4 => {
                let words: Vec<u32> = u.arbitrary()?;
                acrobot.reset_with(ResetOptions {
                    seed: Some(SeedSequence::from_words(&words)),
                    ..ResetOptions::default()
                });
                false
            }
            5 => {
                episode(&mut acrobot, u)?;
                false
            }
            6 => {
                let x = real(number(u, 100.0)?);
                let (sin, cos) = A::sin_cos(x);
                let wrapped = wrap::<A>(x);
                if x.is_finite() {
                    assert!([sin, cos].iter().all(|y| y.to_f64().abs() <= 1.0), "{x}");
                    assert!(wrapped.to_f64().abs() <= A::Scalar::PI.to_f64(), "{x}");
                }
                false
            }
            _ => {
                let number = u.arbitrary::<u8>()?;
                let action = Action::try_from(number);
                assert_eq!(action.is_ok(), number < 3);
                if let Ok(action) = action {
                    assert_stepped(acrobot.step(action), acrobot.state(), acrobot.params());
                }
                action.is_err()
            }
        };
        assert!(
            !rejected || acrobot == before,
            "a rejected call changed the acrobot"
        );
        assert_seen(acrobot.observation());
        // These may return any number, also NaN.
        let pendulum = acrobot.pendulum();
        let _ = (
            pendulum.derivative(A::Scalar::PI),
            pendulum.energy(),
            pendulum.mass_matrix(),
            pendulum.tip_height(),
        );
    }
    Ok(())
}

/// Some steps, recorded and written as CSV at once and row by row.
fn episode<A: Arithmetic<Scalar: FromStr>>(
    acrobot: &mut Acrobot<A>,
    u: &mut Unstructured<'_>,
) -> Result<()> {
    let mut limited = TimeLimit::new(acrobot.clone(), u.arbitrary()?);
    let mut trajectory = Trajectory::<_, 4>::new();
    let steps = u.int_in_range(1..=6)?;
    for count in 1..=steps {
        let step = trajectory.step(&mut limited, *u.choose(&Action::ALL)?);
        assert_eq!(step.truncated, count >= limited.limit().get());
        assert_settled(limited.state(), limited.params());
    }
    let mut csv = String::new();
    assert!(trajectory.write_csv(&mut csv).is_ok());
    assert_eq!(csv.lines().count() as u32, 1 + steps.min(4));
    let last = csv
        .lines()
        .last()
        .into_iter()
        .flat_map(|line| line.split(',').skip(7).take(4));
    let last: Vec<A::Scalar> = last.flat_map(str::parse).collect();
    let state: [A::Scalar; 4] = limited.state().into();
    assert_eq!(last, state, "{csv}");
    *acrobot = limited.inner().clone();
    Ok(())
}
