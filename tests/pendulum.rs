//! A pendulum equals an acrobot without noise. Its positions follow from its state.

use acrobot::arithmetic::{Arithmetic, Real};
use acrobot::physics::Pendulum;
use acrobot::{Acrobot, Params, Portable, State};
use common::{bits, in_every_arithmetic};

#[test]
fn a_pendulum_equals_an_acrobot_without_noise() {
    fn check<A: Arithmetic>() {
        let number = A::Scalar::from_f64;
        let params = Params { mass2: number(1.5), dt: number(0.1), ..Params::default() };
        let mut acrobot = Acrobot::<A>::new(5);
        acrobot.set_params(params).unwrap();
        let mut pendulum = Pendulum::<A>::new(params, acrobot.state()).unwrap();
        let mut terminated = 0;
        for _ in 0..500 {
            // Torque along link 1's velocity, which swings it up.
            let torque = number(if acrobot.state().dtheta1 > number(0.0) { -2.0 } else { 2.0 });
            let step = acrobot.step_torque(torque).unwrap();
            assert_eq!(pendulum.step(torque), Ok(step.terminated));
            assert_eq!(bits(pendulum.state()), bits(acrobot.state()));
            let placed = Acrobot::from_pendulum(pendulum.clone(), ());
            assert_eq!(placed.observation(), step.observation);
            let State { theta1, theta2, .. } = pendulum.state();
            assert_eq!(pendulum.sin_cos(), [theta1, theta2].map(A::sin_cos));
            terminated += u32::from(step.terminated);
        }
        assert!(terminated > 10, "{terminated}");
    }
    in_every_arithmetic!(check);
}

/// After each step, whose sines are cached, a pendulum gives the same bits as a new one in its
/// state.
#[test]
fn a_pendulum_after_a_step_equals_a_new_one() {
    fn check<A: Arithmetic>() {
        let number = A::Scalar::from_f64;
        let params = Params {
            length1: number(1.25),
            length2: number(0.75),
            mass2: number(1.5),
            ..Params::default()
        };
        let mut stepped = Pendulum::<A>::new(params, State::HANGING).unwrap();
        for i in 0..200 {
            let torque = number(f64::from(i % 5 - 2));
            stepped.step(torque).unwrap();
            let new = Pendulum::<A>::new(params, stepped.state()).unwrap();
            let [found, expected] = [stepped.clone(), new].map(|pendulum| {
                (
                    bits(pendulum.derivative(torque)),
                    bits([pendulum.energy(), pendulum.tip_height()]),
                    pendulum.mass_matrix().map(bits),
                    pendulum.positions().map(bits),
                )
            });
            assert_eq!(found, expected);
        }
    }
    in_every_arithmetic!(check);
}

/// Elbow and tip are at the ends of their links, x to the right and y up.
#[test]
fn positions_follow_from_the_angles() {
    use std::f64::consts::FRAC_PI_2;
    let params = Params { length1: 1.5, length2: 0.5, ..Params::DEFAULT };
    let at = |theta1: f64, theta2: f64| {
        let state = State::from([theta1, theta2, 0.0, 0.0]);
        let pendulum = Pendulum::<Portable>::new(params, state).unwrap();
        let [elbow, tip] = pendulum.positions();
        assert!((tip[1] - pendulum.tip_height()).abs() <= 1e-15);
        [elbow, tip]
    };
    let close = |[x, y]: [f64; 2], [right, up]: [f64; 2]| {
        let distance = (x - right).hypot(y - up);
        assert!(distance <= 1e-15, "{x} {y} and {right} {up}");
    };
    // Counter-clockwise is positive: a quarter turn from hanging points to the right.
    let [elbow, tip] = at(FRAC_PI_2, -FRAC_PI_2);
    close(elbow, [1.5, 0.0]);
    close(tip, [1.5, -0.5]);
    for i in -30..30 {
        let (theta1, theta2) = (f64::from(i) * 0.1, f64::from(i) * 0.37);
        let [elbow, tip] = at(theta1, theta2);
        let (sin, cos) = Portable::sin_cos(theta1);
        close(elbow, [1.5 * sin, -1.5 * cos]);
        let (sin, cos) = Portable::sin_cos(theta1 + theta2);
        close(tip, [elbow[0] + 0.5 * sin, elbow[1] - 0.5 * cos]);
    }
}
