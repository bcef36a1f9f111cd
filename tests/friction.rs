//! A real machine: its friction and its rotor.

use acrobot::arithmetic::{Arithmetic, Damped, Reference};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::{Joints, Pendulum, wrap};
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
                    friction: Joints { joint1: 0.001, joint2: 0.002 },
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
            assert_eq!(steps.len(), 20);
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

/// Whatever else is drawn: where both inertias are 1 kg m², any rotor up to 1 kg m² is possible.
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
    assert_eq!(draw(1.0), Ok(()));
    let error = "rotor must be at most √(inertia1 inertia2) where one is drawn, in kg m², got 1.1";
    assert!(draw(1.1).unwrap_err().starts_with(error));
}

/// The energy never grows without a torque, however long the steps are and strong the friction:
/// at rest Coulomb friction holds, and does not shake.
#[test]
fn coulomb_friction_holds_in_steps_of_any_length() {
    let mut rng = Pcg64::new(3);
    let mut draw = |low: f64, high: f64| uniform(&mut rng, low, high);
    for _ in 0..2000 {
        let params = Params {
            dt: draw(1e-3, 0.05),
            length1: draw(0.2, 2.0),
            mass1: draw(0.2, 2.0),
            mass2: draw(0.2, 2.0),
            inertia1: draw(0.01, 0.5),
            inertia2: draw(0.01, 0.5),
            gravity: 0.0,
            coulomb: Joints { joint1: draw(0.0, 2.0), joint2: draw(0.0, 2.0) },
            ..Params::DEFAULT
        };
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
