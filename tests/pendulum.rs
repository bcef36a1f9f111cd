//! The positions of a pendulum follow from its state.

use acrobot::arithmetic::Arithmetic;
use acrobot::physics::Pendulum;
use acrobot::{Params, Portable, State};

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
