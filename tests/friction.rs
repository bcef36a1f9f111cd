//! A real machine: its friction and its rotor.

use std::f64::consts::PI;

use acrobot::arithmetic::{Arithmetic, Damped, Real, Reference};
use acrobot::control::model::LinearModel;
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::{Pendulum, wrap};
use acrobot::task::{Draw, Draws};
use acrobot::{Acrobot, Fast, Params, Portable, State};
use common::text_of;

/// A machine of `realaigym.txt`, and its steps: a state, the torque, the next state.
fn machines() -> Vec<(Params, Vec<[f64; 9]>)> {
    let text = text_of("tests/data/realaigym.txt");
    let mut machines: Vec<(Params, Vec<_>)> = Vec::new();
    let numbers = |words: &str| -> Vec<f64> {
        words.split(' ').filter_map(|word| word.parse().ok()).collect()
    };
    for line in text.lines() {
        match line.split_once(' ') {
            Some(("machine", words)) => {
                let [mass1, mass2, lc1, lc2, i1, i2, rotor] = numbers(words)[..] else { panic!() };
                let params = Params {
                    length1: 0.2,
                    length2: 0.3,
                    mass1,
                    mass2,
                    center_of_mass1: lc1,
                    center_of_mass2: lc2,
                    gravity: 9.81,
                    dt: 0.002,
                    max_velocity1: f64::INFINITY,
                    max_velocity2: f64::INFINITY,
                    damping1: 0.001,
                    damping2: 0.002,
                    ..Params::DEFAULT
                };
                let params = params.with_inertias_about_joints([i1, i2]).with_rotor(rotor, 6.0);
                // They have a motor in the fixed joint, too.
                let inertia1 = params.inertia1 + 36.0 * rotor;
                machines.push((Params { inertia1, ..params }, Vec::new()));
            }
            Some(("step", words)) => {
                machines.last_mut().unwrap().1.push(numbers(words).try_into().unwrap());
            }
            _ => {}
        }
    }
    machines
}

/// Also where link 2's inertia is negative about the centre of mass that they print.
#[test]
fn steps_equal_realaigyms() {
    fn check<A: Arithmetic<Scalar = f64>>() {
        for (params, steps) in machines() {
            assert_eq!(
                steps.len(),
                20,
                "steps of each machine in tests/data/realaigym.txt: edit this count"
            );
            for [a, b, c, d, torque, after @ ..] in steps {
                let mut pendulum = Pendulum::<A>::new(params, State::from([a, b, c, d])).unwrap();
                pendulum.step(torque).unwrap();
                let next: [f64; 4] = pendulum.state().into();
                for (x, y) in next.into_iter().zip(after) {
                    let error = wrap(x - y).abs(); // they do not wrap
                    assert!(error < 1e-11, "{error:e} {params:?}");
                }
            }
        }
    }
    check::<Damped<Portable>>();
    check::<Damped<Reference>>();
}

/// The largest inertia of a rotor is that with which the mass matrix is still positive definite.
#[test]
fn a_rotor_that_no_machine_has_is_rejected() {
    let rule = "so small that the mass matrix is positive definite, in kg m²";
    let params = Params::<f64>::DEFAULT; // U L = 2.25 · 1.25, coupling 0.5
    let most = (2.25_f64 * 1.25).sqrt() - 0.5;
    for sign in [-1.0, 1.0] {
        let with = |rotor| Params { rotor: sign * rotor, ..params }.validate();
        assert!(with(0.999 * most).is_ok());
        let message = with(1.001 * most).unwrap_err().to_string();
        assert!(message.starts_with(&format!("rotor must be {rule}, got ")), "{message}");
    }
    assert!(params.with_rotor(100.0, 6.0).validate().is_ok());
}

/// Whatever else is drawn: link 1 has 1.25 kg m² about its joint and link 2 has 1 kg m² about its
/// centre of mass, so any rotor below √1.25 kg m² is possible.
#[test]
fn drawn_rotors_are_those_of_machines() {
    let draw = |high| -> Result<(), String> {
        let rotor = Draw::Uniform { low: 0.0, high };
        let mass2 = Draw::LogUniform { low: 1e-3, high: 1e3 };
        let draws = Draws::new(Params { rotor, mass2, ..Draws::FIXED }).unwrap();
        let mut acrobot = Acrobot::<Damped<Fast>>::new(1);
        for _ in 0..1000 {
            acrobot.draw_params(&draws).map_err(|error| error.to_string())?;
            acrobot.params().validate().unwrap();
        }
        Ok(())
    };
    assert_eq!(draw(1.117), Ok(()));
    let rule =
        "rotor must be below √((inertia1 + m1 lc1²) inertia2) where one of them is drawn, in kg m²";
    assert!(draw(1.119).unwrap_err().starts_with(rule));
}

/// Point masses without inertia about the joint but that of rotors have the least room for a rotor:
/// none, where the lengths are in proportion. Whatever draws are accepted near this limit, all that
/// they draw is valid, to the last digit.
#[test]
fn rotors_near_their_limit_are_valid_or_no_draws() {
    fn check<A: Arithmetic>() {
        let mut rng = Pcg64::new(3);
        let [mut accepted, mut rejected] = [0, 0];
        for i in 0..4000 {
            let mut decades = |low, high| f64::exp(uniform(&mut rng, low, high) * f64::ln(10.0));
            let (length1, center_of_mass2, inertia2) =
                (decades(-1.0, 1.0), decades(-1.0, 1.0), decades(-4.0, 0.0));
            let inertia1 = inertia2 * f64::powi(length1 / center_of_mass2, 2);
            let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
            let params = Params {
                length1,
                center_of_mass1: 0.0,
                center_of_mass2,
                inertia1,
                inertia2,
                rotor: sign * f64::sqrt(inertia1 * inertia2) * (1.0 - decades(-16.0, -2.0)),
                mass2: decades(-1.0, 1.0),
                ..Params::DEFAULT
            };
            let high = params.mass2 * decades(0.0, 2.0);
            let [low, high] = [params.mass2, high].map(A::Scalar::from_f64);
            let mass2 = Draw::LogUniform { low, high };
            let draws = Draws::new(Params { mass2, ..Draws::FIXED }).unwrap();
            let mut acrobot = Acrobot::<A>::new(i);
            if acrobot.set_params(params.cast()).is_err() {
                continue;
            }
            for _ in 0..8 {
                if acrobot.draw_params(&draws).is_err() {
                    rejected += 1;
                    break;
                }
                acrobot.params().validate().unwrap();
                acrobot.set_params(params.cast()).unwrap();
                accepted += 1;
            }
        }
        assert!(accepted > 1000 && rejected > 100, "{accepted} {rejected}");
    }
    check::<Damped<Fast>>();
    check::<Damped<Portable>>();
}

/// The rate of viscous friction in a machine at rest, 1/s: the largest of a straight and of a
/// folded elbow, where the sum of both joints' rates is largest.
fn rate(params: Params) -> f64 {
    let ends = [0.0, PI].map(|theta2| {
        let state = State { theta2, ..State::HANGING };
        let pendulum = Pendulum::<Damped<Portable>>::new(params, state).unwrap();
        let LinearModel { a, .. } = pendulum.linearize(0.0).unwrap();
        -a[2][2] - a[3][3]
    });
    ends[0].max(ends[1])
}

/// The energy never grows without a torque, however long the steps are and strong the friction:
/// at rest friction holds, and does not shake. Viscous friction has rates of up to 2.7/dt, where a
/// step is still stable.
#[test]
fn friction_holds_in_steps_of_any_length() {
    let mut rng = Pcg64::new(3);
    let mut draw = |low: f64, high: f64| uniform(&mut rng, low, high);
    for i in 0..2000 {
        let mut params = Params {
            dt: draw(1e-3, 0.05),
            length1: draw(0.2, 2.0),
            mass1: draw(0.2, 2.0),
            mass2: draw(0.2, 2.0),
            inertia1: draw(0.01, 0.5),
            inertia2: draw(0.01, 0.5),
            gravity: 0.0,
            damping1: draw(0.0, 1.0),
            damping2: draw(0.0, 1.0),
            ..Params::DEFAULT
        };
        let part = if i % 2 == 0 { 0.0 } else { draw(0.0, 2.7) / params.dt / rate(params) };
        params.damping1 *= part;
        params.damping2 *= part;
        (params.coulomb1, params.coulomb2) = (draw(0.0, 2.0), draw(0.0, 2.0));
        let start = State::from([0.0, draw(-3.0, 3.0), draw(-0.1, 0.1), draw(-0.1, 0.1)]);
        let mut pendulum = Pendulum::<Damped<Fast>>::new(params.cast(), start.cast()).unwrap();
        let first = pendulum.energy();
        for _ in 0..400 {
            let before = pendulum.energy();
            pendulum.step(0.0).unwrap();
            assert!(pendulum.energy() <= before + 1e-6 * first, "{params:?} {start:?}");
        }
    }
}

/// Where viscous friction alone is at the limit of a stable step, it leaves nothing to Coulomb's,
/// so the motion is that without Coulomb friction, also of a constant.
#[test]
fn viscous_friction_at_its_limit_leaves_nothing_to_coulombs() {
    const fn machine(coulomb: f32) -> Pendulum<Damped<Fast>> {
        let [friction, coulomb] = [25.0, coulomb];
        let params = Params {
            damping1: friction,
            damping2: friction,
            coulomb1: coulomb,
            coulomb2: coulomb,
            ..Params::<f32>::DEFAULT
        };
        let state = State { theta1: 0.5, theta2: 0.1, dtheta1: 0.2, dtheta2: -0.3 };
        match params.pendulum(state) {
            Ok(pendulum) => pendulum,
            Err(_) => panic!(),
        }
    }
    const VISCOUS: Pendulum<Damped<Fast>> = machine(0.0);
    const BOTH: Pendulum<Damped<Fast>> = machine(1.0);
    let [viscous, both] = [VISCOUS, BOTH].map(|mut pendulum| {
        pendulum.step(0.0).unwrap();
        pendulum.state()
    });
    assert_eq!(viscous, both);
    assert_ne!(both, BOTH.state());
}

/// Friction that holds creeps: under half of Coulomb's torque at 0.35 of the width of 0.02 rad/s,
/// whatever the machine's size. `docs/equations.md` has what that is in the machine's own time.
#[test]
fn friction_that_holds_creeps_at_a_third_of_the_width() {
    for size in [0.1, 1.0, 10.0, 100.0] {
        let square = size * size;
        let params = Params {
            length1: size,
            center_of_mass1: size / 2.0,
            center_of_mass2: size / 2.0,
            inertia1: square,
            inertia2: square,
            gravity: 0.0,
            dt: 1e-3,
            coulomb1: square,
            coulomb2: square,
            ..Params::DEFAULT
        };
        let mut pendulum = Pendulum::<Damped<Portable>>::new(params, State::HANGING).unwrap();
        for _ in 0..2000 {
            pendulum.step(0.5 * square).unwrap();
        }
        let State { dtheta1, dtheta2, .. } = pendulum.state();
        assert!(dtheta1.abs() < 1e-4, "{dtheta1}");
        assert!((dtheta2 / 0.02 - 0.347).abs() < 1e-3, "{dtheta2}");
    }
}

/// RealAIGym's c atan(100 v) differs by at most 31 % of the largest, and 7 % from 0.1 rad/s on.
#[test]
fn coulomb_friction_is_near_realaigyms() {
    let params = Params { gravity: 0.0, dt: 1e-4, coulomb1: 0.0, coulomb2: 1.0, ..Params::DEFAULT };
    let [mut most, mut most_of_fast] = [0.0_f64; 2];
    for i in 1..=10_000 {
        let dtheta2 = f64::from(i) * 1e-4;
        let state = State { dtheta2, ..State::HANGING };
        let pendulum = Pendulum::<Damped<Portable>>::new(params, state).unwrap();
        let [_, torque] = pendulum.inverse_dynamics([0.0; 2]).unwrap().torques;
        let difference = (torque - f64::atan(100.0 * dtheta2) / (PI / 2.0)).abs();
        most = most.max(difference);
        if dtheta2 >= 0.1 {
            most_of_fast = most_of_fast.max(difference);
        }
    }
    assert!((0.30..0.31).contains(&most) && (0.06..0.07).contains(&most_of_fast));
}
