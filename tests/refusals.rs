//! Promise 3: what is out of range is refused before anything changes, and what is extreme but
//! valid neither hangs nor panics nor turns into NaN.

use acrobot::{
    Acrobot, Action, Arithmetic, Error, Fast, Host, Micro, Params, Portable, Real, StartBounds,
    State, TimeLimit,
};

const NOT_FINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// Every field of the parameters, by its name and how to set it, and whether 0 and −1 are allowed.
#[expect(clippy::type_complexity, reason = "a table")]
fn fields() -> [(&'static str, fn(&mut Params, f64), bool, bool); 16] {
    [
        ("length1", |p, x| p.length1 = x, false, false),
        ("length2", |p, x| p.length2 = x, false, false),
        ("mass1", |p, x| p.mass1 = x, false, false),
        ("mass2", |p, x| p.mass2 = x, false, false),
        ("center_of_mass1", |p, x| p.center_of_mass1 = x, true, false),
        ("center_of_mass2", |p, x| p.center_of_mass2 = x, true, false),
        ("inertia1", |p, x| p.inertia1 = x, true, false),
        ("inertia2", |p, x| p.inertia2 = x, true, false),
        ("gravity", |p, x| p.gravity = x, true, true),
        ("dt", |p, x| p.dt = x, false, false),
        ("max_velocity1", |p, x| p.max_velocity1 = x, false, false),
        ("max_velocity2", |p, x| p.max_velocity2 = x, false, false),
        ("torques[0]", |p, x| p.torques[0] = x, true, true),
        ("torques[1]", |p, x| p.torques[1] = x, true, true),
        ("torques[2]", |p, x| p.torques[2] = x, true, true),
        ("torque_noise", |p, x| p.torque_noise = x, true, false),
    ]
}

#[test]
fn parameters_out_of_range_are_refused_by_name() {
    let mut acrobot = Acrobot::<Portable>::new(1);
    for (field, set, zero, negative) in fields() {
        for value in NOT_FINITE.into_iter().chain([0.0, -1.0, 2.0]) {
            let before = acrobot.clone();
            let mut params = Params::DEFAULT;
            set(&mut params, value);
            let allowed = value == 2.0 || (value == 0.0 && zero) || (value == -1.0 && negative);
            match acrobot.set_params(params) {
                Ok(()) => {
                    assert!(allowed, "{field} = {value} was accepted");
                    assert_eq!(*acrobot.params(), params);
                }
                Err(error) => {
                    assert!(!allowed, "{error}");
                    let text = error.to_string();
                    assert!(
                        text.starts_with(&format!("{field} is {value} "))
                            && text.contains("allowed"),
                        "{text}"
                    );
                    assert_eq!(acrobot, before);
                }
            }
        }
    }
}

#[test]
fn a_link_needs_inertia_about_its_joint() {
    for point in [
        Params {
            inertia1: 0.0,
            center_of_mass1: 0.0,
            ..Params::DEFAULT
        },
        Params {
            inertia2: 0.0,
            center_of_mass2: 0.0,
            ..Params::DEFAULT
        },
        // Their squares vanish in f64.
        Params {
            inertia2: 0.0,
            center_of_mass2: 1e-170,
            ..Params::DEFAULT
        },
    ] {
        let text = point.validate().unwrap_err().to_string();
        assert!(
            text.contains("is 0 kg m²") && text.ends_with("lies on the joint"),
            "{text}"
        );
    }
    // Point masses at the tips are a pendulum all the same.
    let points = Params {
        inertia1: 0.0,
        inertia2: 0.0,
        center_of_mass1: 1.0,
        center_of_mass2: 1.0,
        ..Params::DEFAULT
    };
    points.validate().unwrap();
}

#[test]
fn states_and_torques_that_are_not_finite_are_refused() {
    let mut acrobot = TimeLimit::v1(Acrobot::<Portable>::new(1));
    let before = acrobot.clone();
    for value in NOT_FINITE {
        for (i, name) in ["theta1", "theta2", "dtheta1", "dtheta2"]
            .into_iter()
            .enumerate()
        {
            let mut numbers = [0.0; 4];
            numbers[i] = value;
            let text = acrobot
                .inner_mut()
                .set_state(State::from(numbers))
                .unwrap_err()
                .to_string();
            assert!(
                text.starts_with(&format!("{name} is {value} rad")),
                "{text}"
            );
        }
        let text = acrobot.step_torque(value).unwrap_err().to_string();
        assert_eq!(
            text,
            format!("torque is {value} N m; allowed is any finite number")
        );
    }
    assert_eq!(acrobot, before);
}

#[test]
fn bad_start_bounds_and_actions_are_refused() {
    for value in NOT_FINITE.into_iter().chain([1e39, -1e39]) {
        for (name, bounds) in [
            ("low", StartBounds::new(value, 0.1)),
            ("high", StartBounds::new(-0.1, value)),
        ] {
            let text = bounds.unwrap_err().to_string();
            assert!(
                text.starts_with(&format!("{name} is {value} rad")),
                "{text}"
            );
        }
    }
    assert_eq!(
        StartBounds::new(0.2, 0.1),
        Err(Error::ReversedBounds {
            low: 0.2,
            high: 0.1
        })
    );
    let text = StartBounds::new(0.2, 0.1).unwrap_err().to_string();
    assert!(
        text.contains("0.2") && text.contains("0.1") && text.contains("rad"),
        "{text}"
    );

    for (number, action) in (0..3).zip(Action::ALL) {
        assert_eq!(Action::try_from(number), Ok(action));
        assert_eq!(u8::from(action), number);
    }
    for number in 3..=u8::MAX {
        let text = Action::try_from(number).unwrap_err().to_string();
        assert!(
            text.starts_with(&format!("action is {number}; allowed is 0")),
            "{text}"
        );
    }
}

#[test]
fn what_cannot_be_represented_stops_where_it_is() {
    fn check<A: Arithmetic>() {
        let number = A::Scalar::from_f64;
        let mut acrobot = Acrobot::<A>::new(3);
        let huge = number(if number(1e300).is_finite() {
            1e300
        } else {
            1e38
        });
        let start = State::from([0.5, -0.25, 1.0, 2.0]).cast::<A::Scalar>();
        // The angles stay and the velocities are gone.
        acrobot
            .set_params(Params {
                dt: huge,
                ..Params::default()
            })
            .unwrap();
        acrobot.set_state(start).unwrap();
        acrobot.step(Action::Positive);
        assert_eq!(
            acrobot.state(),
            State {
                dtheta1: A::Scalar::ZERO,
                dtheta2: A::Scalar::ZERO,
                ..start
            }
        );
        // And goes on as if nothing had been.
        acrobot.set_params(Params::default()).unwrap();
        acrobot.step(Action::Positive);
        assert_ne!(acrobot.state().dtheta1, A::Scalar::ZERO);
    }
    check::<Portable>();
    check::<Host>();
    check::<Fast>();
    check::<Micro>();
}

/// Of what is derived from these parameters a part is not a number.
#[test]
fn whatever_its_parameters_an_acrobot_equals_its_clone() {
    let mut acrobot = Acrobot::<Fast>::new(0);
    let params = Params {
        length1: 1e38,
        inertia2: 0.0,
        ..Params::default()
    };
    acrobot.set_params(params).unwrap();
    assert_eq!(acrobot, acrobot.clone());
}
