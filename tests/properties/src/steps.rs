//! Steps of any acrobot: bounds and mirror symmetry.

use std::array;
use std::cell::Cell;
use std::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Micro, Real};
use acrobot::numpy::{Pcg64, integers};
use acrobot::physics::Pendulum;
use acrobot::{Acrobot, Action, Error, Fast, Params, Portable, ResetOptions, State, Step};
use proptest::prelude::*;

use crate::given::{Range, Tested, acrobot, action, holds, number, params, reset_bounds, state};
use common::{assert_says, in_every_arithmetic};

fn assert_seen<A: Arithmetic>(acrobot: &Acrobot<A>, observation: [f32; 6]) {
    assert_eq!(observation, acrobot.observation());
    let [trigonometric @ .., dtheta1, dtheta2] = observation;
    for x in trigonometric {
        assert!((-1.0..=1.0).contains(&x), "{observation:?}");
    }
    let state = acrobot.state();
    for (seen, x) in [(dtheta1, state.dtheta1), (dtheta2, state.dtheta2)] {
        assert_eq!(seen.to_bits(), (x.to_f64() as f32).to_bits());
    }
}

/// Promise 3 after a step: the state is within its bounds, and the results follow from it.
fn assert_stepped<A: Arithmetic>(acrobot: &Acrobot<A>, step: Step) {
    let Params { max_velocity1, max_velocity2, .. } = *acrobot.params();
    let limits = [A::Scalar::PI, A::Scalar::PI, max_velocity1, max_velocity2];
    let state = acrobot.state();
    for (x, limit) in <[A::Scalar; 4]>::from(state).into_iter().zip(limits) {
        assert!(-limit <= x && x <= limit, "{state:?}");
    }
    assert_seen(acrobot, step.observation);
    assert_eq!(step.reward, if step.terminated { 0.0 } else { -1.0 });
}

/// With optimization this takes ten million steps: `CASES` of 100 steps on average in four
/// arithmetics.
#[test]
fn any_settings_and_steps_stay_in_bounds() {
    const CASES: u32 = if cfg!(debug_assertions) { 500 } else { 25_500 };

    fn check<A: Tested>() {
        let set = ([(); 2].map(|()| params::<A>(Range::Any)), [(); 2].map(|()| state(Range::Any)));
        let done = (reset_bounds(), number(Range::Any), any::<u64>(), 0..=200_u32);
        holds(CASES, (set, done), |((params, states), done)| {
            let (bounds, torque, seed, count) = done;
            let mut choices = Pcg64::new(seed);
            let mut acrobot = Acrobot::<A>::new(seed);
            for (params, state) in params.into_iter().zip(states) {
                acrobot.set_params(params).unwrap();
                acrobot.set_state(state).unwrap();
                assert_seen(&acrobot, acrobot.observation());
                for _ in 0..count / 2 {
                    match integers(&mut choices, NonZeroU32::new(32).unwrap()) {
                        choice @ ..2 => {
                            let options =
                                if choice == 0 { bounds.into() } else { ResetOptions::default() };
                            let observation = acrobot.reset_with(options);
                            assert_seen(&acrobot, observation);
                        }
                        choice => {
                            let step = if choice < 4 {
                                acrobot.step_torque(torque).unwrap()
                            } else {
                                acrobot.step(Action::sample(&mut choices))
                            };
                            assert_stepped(&acrobot, step);
                        }
                    }
                }
            }
        });
    }
    in_every_arithmetic!(check);
}

fn mirror<S: Real>(state: State<S>) -> State<S> {
    <[S; 4]>::from(state).map(|x| -x).into()
}

fn mirrored<S: Real>(params: Params<S>) -> Params<S> {
    let [negative, zero, positive] = params.torques;
    Params { torques: [-positive, -zero, -negative], torque_noise: S::ZERO, ..params }
}

/// The largest angle that a Runge-Kutta step passes through, rad. An error if a number is not
/// finite.
fn reach<A: Arithmetic>(
    params: &Params<A::Scalar>,
    state: State<A::Scalar>,
    torque: A::Scalar,
) -> Result<f64, Error> {
    let mut pendulum = Pendulum::<A>::new(*params, state)?;
    let y = <[A::Scalar; 4]>::from(state);
    let mut reach = 0.0_f64;
    let mut rates_at = |h: A::Scalar, k: [A::Scalar; 4]| {
        pendulum.set_state(State::from(array::from_fn(|i| y[i] + h * k[i])))?;
        let State { theta1, theta2, .. } = pendulum.state().cast::<f64>();
        reach = reach.max(theta1.abs()).max(theta2.abs());
        Ok(pendulum.derivative(torque))
    };
    let (dt, zero, two) = (params.dt, A::Scalar::ZERO, A::Scalar::from_f64(2.0));
    let k1 = rates_at(zero, [zero; 4])?;
    let k2 = rates_at(dt / two, k1)?;
    let k3 = rates_at(dt / two, k2)?;
    let k4 = rates_at(dt, k3)?;
    let sum = array::from_fn(|i| k1[i] + two * k2[i] + two * k3[i] + k4[i]);
    rates_at(dt / A::Scalar::from_f64(6.0), sum)?;
    Ok(reach)
}

/// Mirroring state and torque mirrors the result, bit for bit, except for the sign of zero, up to
/// the angle where the lean wrap or the kernel loses count: beyond, |x| + 1.5 × 2²³ and −|x| + 1.5
/// × 2²³ round differently, in `f64` with 2⁵².
#[test]
fn mirrored_steps_are_mirror_images() {
    fn check<A: Tested>(farthest: f64) {
        let checked = Cell::new(0);
        let given = (params::<A>(Range::Any), state(Range::Any), action());
        holds(2000, given, |(params, state, action)| {
            let right = mirrored(params);
            let left = mirrored(right);
            let reach = reach::<A>(&left, state, left.torque(action));
            if !reach.is_ok_and(|reach| reach <= farthest) {
                return;
            }
            checked.set(checked.get() + 1);
            let opposite = Action::ALL[2 - action as usize];
            let mut left = acrobot::<A>(left, state, 0);
            let mut right = acrobot::<A>(right, mirror(state), 0);
            let [step, mirrored] = [left.step(action), right.step(opposite)];
            assert_eq!(left.state(), mirror(right.state()));
            assert_eq!(step.terminated, mirrored.terminated);
        });
        assert!(checked.get() > 500, "{} were checked", checked.get());
    }
    check::<Portable>(1e16);
    check::<Fast>(5e5);
    check::<Micro>(5e5);
    let limits = "if no angle within the step is beyond 5e5 rad, in `Portable` 1e16 rad";
    assert_says("docs/numbers.md", limits);
}
