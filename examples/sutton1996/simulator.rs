//! The acrobot of Sutton & Barto (1st edition, 11.3) as it was simulated: four time steps of 0.05 s for each decision,
//! where Gymnasium takes one Runge-Kutta step of 0.2 s.
//!
//! The integrator is semi-implicit Euler, as in Sutton's Lisp: it updates the velocities first, and the angles with the
//! new velocities. Explicit Euler, which uses the old ones, adds energy and reaches the goal in about half the steps.

use acrobot::physics::{Pendulum, bound};
use acrobot::{Params, Portable, State};

/// Gymnasium's parameters with shorter time steps. A decision lasts as long as Gymnasium's.
pub const PARAMS: Params = Params {
    dt: 0.05,
    ..Params::DEFAULT
};

/// The time steps of a decision.
const STEPS: u32 = 4;

/// The acrobot in a state.
pub fn acrobot(state: State) -> Pendulum<Portable> {
    Pendulum::new(PARAMS, state).expect("the state is finite")
}

/// Takes one time step under a torque in N m.
pub fn advance(acrobot: &mut Pendulum<Portable>, torque: f64) {
    let state = acrobot.state();
    let [_, _, acceleration1, acceleration2] = acrobot.derivative(torque);
    let velocity = |old, acceleration, limit| bound(old + PARAMS.dt * acceleration, limit);
    let dtheta1 = velocity(state.dtheta1, acceleration1, PARAMS.max_velocity1);
    let dtheta2 = velocity(state.dtheta2, acceleration2, PARAMS.max_velocity2);
    let next = State {
        theta1: state.theta1 + PARAMS.dt * dtheta1,
        theta2: state.theta2 + PARAMS.dt * dtheta2,
        dtheta1,
        dtheta2,
    };
    acrobot.set_state(next).expect("the velocities are bounded");
}

/// Whether the tip is more than a link's length above the joint.
pub fn is_goal(acrobot: &Pendulum<Portable>) -> bool {
    acrobot.tip_height() > PARAMS.length1
}

/// Takes the time steps of a decision. The goal ends it early.
pub fn decide(acrobot: &mut Pendulum<Portable>, torque: f64) {
    for _ in 0..STEPS {
        advance(acrobot, torque);
        if is_goal(acrobot) {
            break;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// Updates both angles with the old velocities.
    fn explicit_euler(acrobot: &mut Pendulum<Portable>) {
        let (y, rates) = (<[f64; 4]>::from(acrobot.state()), acrobot.derivative(0.0));
        let next = std::array::from_fn::<f64, 4, _>(|i| y[i] + PARAMS.dt * rates[i]);
        acrobot.set_state(next.into()).unwrap();
    }

    #[test]
    fn the_simulator_keeps_the_energy_where_explicit_euler_does_not() {
        let start = acrobot(State::from([1.0, -0.5, 0.0, 0.0]));
        let farthest = |step: fn(&mut Pendulum<Portable>)| {
            let mut acrobot = start.clone();
            let errors = (0..2000).map(|_| {
                step(&mut acrobot);
                (acrobot.energy() - start.energy()).abs()
            });
            errors.fold(0.0, f64::max)
        };
        // In 100 s without torque; from hanging to upright are 39.2 J.
        let [kept, fed] = [
            farthest(|acrobot| advance(acrobot, 0.0)),
            farthest(explicit_euler),
        ];
        assert!(kept < 2.0, "{kept} J");
        assert!(fed > 10.0, "{fed} J");
    }

    #[test]
    fn the_simulator_updates_the_velocities_first_and_bounds_them() {
        let mut swinging = acrobot(State::from([0.3, -0.2, 1.0, -2.0]));
        let [_, _, acceleration1, acceleration2] = swinging.derivative(1.0);
        advance(&mut swinging, 1.0);
        let next = swinging.state();
        assert_eq!(next.dtheta1, 1.0 + 0.05 * acceleration1);
        assert_eq!(next.dtheta2, -2.0 + 0.05 * acceleration2);
        assert_eq!(next.theta1, 0.3 + 0.05 * next.dtheta1);
        assert_eq!(next.theta2, -0.2 + 0.05 * next.dtheta2);

        let mut whirling = acrobot(State::from([0.0, 0.0, 50.0, -50.0]));
        advance(&mut whirling, 0.0);
        let bounded = whirling.state();
        assert_eq!([bounded.dtheta1, bounded.dtheta2], [4.0 * PI, -9.0 * PI]);
    }

    #[test]
    fn the_goal_ends_a_decision_early() {
        let mut rising = acrobot(State::from([2.0, 0.0, 1.0, 0.0]));
        assert!(!is_goal(&rising));
        let (mut risen, mut steps) = (rising.clone(), 0);
        while !is_goal(&risen) {
            advance(&mut risen, 0.0);
            steps += 1;
        }
        assert!(steps < 4, "{steps}");
        decide(&mut rising, 0.0);
        assert_eq!(rising, risen);
        let [mut decided, mut four] = [(); 2].map(|()| acrobot(State::HANGING));
        decide(&mut decided, 1.0);
        (0..4).for_each(|_| advance(&mut four, 1.0));
        assert_eq!(decided, four);
    }
}
