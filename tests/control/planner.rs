//! A plan obeys the model and its largest torque, and ends where the regulator holds. Bad input
//! gives an error.

use acrobot::arithmetic::{Arithmetic, Damped, Micro, Real};
use acrobot::control::plan::{Cost, Knot, Plan, Planner, Problem, SwingUp};
use acrobot::control::regulator::BoundedRegulator;
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::{Pendulum, saturate};
use acrobot::{Acrobot, Error, Fast, Params, Portable, State};

use crate::cast;
use crate::recovery::holds;
use crate::regulators::diagonal;

/// Plans from hanging with three quarters of a torque, N m, and follows the plan from a nearby
/// state.
fn swings_up_and_holds<A: Arithmetic>(params: Params<A::Scalar>, limit: f64) {
    let [limit, planned] = cast([limit, 0.75 * limit]);
    let params = Params { dt: A::Scalar::from_f64(0.02), ..params };
    let mut planner = Planner::<A>::new(&Problem::swing_up(params, planned).unwrap()).unwrap();
    let mut memory = [Knot::EMPTY; 400];
    let plan = planner.plan_into(State::HANGING, 64, &mut Pcg64::new(1), &mut memory).unwrap();

    let mut exact = Pendulum::<A>::new(params, State::HANGING).unwrap();
    let nearby = State::from(cast([0.05, -0.05, 0.1, 0.1]));
    let disturbed = Pendulum::<A>::new(params, nearby).unwrap();
    assert!(holds(&plan, exact.clone(), limit) && holds(&plan, disturbed, limit));
    for step in plan.knots {
        assert_eq!((step.state, saturate(step.torque, planned)), (exact.state(), step.torque));
        exact.step(step.torque).unwrap();
    }
}

/// The example of docs/control.md.
#[test]
fn a_plan_from_hanging_serves_nearby_states() -> Result<(), Box<dyn std::error::Error>> {
    let params = Params { dt: 0.02, ..Params::DEFAULT };
    let mut planner = Planner::<Fast>::new(&Problem::swing_up(params, 0.8)?)?; // N m
    let mut memory = [Knot::EMPTY; 1250];
    let plan = planner.plan_into(State::HANGING, 64, &mut Pcg64::new(1), &mut memory)?;

    let mut machine = Acrobot::<Fast>::with_params(42, params)?;
    for tick in 0..2000 {
        let torque = plan.torque(tick, machine.state()); // after the plan: holds
        machine.step_torque(saturate(torque, 1.0))?; // a fifth is for corrections
    }
    let x = machine.state().deviation_from(State::UPRIGHT);
    assert!(x.iter().all(|x| x.abs() < 1e-2), "{x:?}");
    Ok(())
}

#[test]
fn plans_swing_up_and_hold_in_any_arithmetic_and_with_friction() {
    swings_up_and_holds::<Fast>(Params::DEFAULT, 8.0);
    swings_up_and_holds::<Micro>(Params::DEFAULT, 8.0);
    swings_up_and_holds::<Damped<Portable>>(Params::SWINGUP, 6.0);
}

/// From states of the whole circle, with a motor that is disturbed.
#[test]
fn decisions_swing_up_and_hold_without_a_plan() -> Result<(), Box<dyn std::error::Error>> {
    let params = Params { dt: 0.01, torque_noise: 0.5, ..Params::DEFAULT };
    let mut swing_up = SwingUp::<Fast>::new(params, 10.0)?;
    for angle in [-2.0, 0.0, 3.0] {
        let mut machine = Acrobot::<Fast>::with_params(42, params)?;
        machine.set_state(State { theta2: angle, ..State::HANGING })?;
        for _ in 0..10_000 {
            machine.step_torque(swing_up.torque(machine.state())?)?;
        }
        let x = machine.state().deviation_from(State::UPRIGHT);
        assert!(x[0].abs().max(x[1].abs()) < 0.1, "{angle} {x:?}");
    }
    Ok(())
}

/// More iterations lower the cost. The rest of a plan, planned again from another state, begins
/// there.
#[test]
fn improving_lowers_the_cost() {
    let params = Params { dt: 0.02, ..Params::DEFAULT };
    let mut planner = Planner::<Portable>::new(&Problem::swing_up(params, 5.0).unwrap()).unwrap();
    let mut plan = [Knot::open(1.0); 200];
    let mut costs = [0, 3, 10, 50].map(|n| planner.improve(State::HANGING, n, &mut plan).unwrap());
    assert!(costs.is_sorted_by(|a, b| a > b), "{costs:?}");
    let start = State { theta1: plan[50].state.theta1 + 0.01, ..plan[50].state };
    costs = [0, 3, 10, 50].map(|n| planner.improve(start, n, &mut plan[50..]).unwrap());
    assert!(plan[50].state == start && costs.is_sorted_by(|a, b| a > b), "{costs:?}");
}

#[test]
fn bad_input_gives_an_error_and_no_torque_that_is_not_finite() {
    for limit in [f32::NAN, f32::INFINITY, 0.0, -1.0] {
        let error = Problem::<f32>::swing_up(Params::DEFAULT, limit).unwrap_err();
        let rule = format!("the largest torque must be finite and above 0 N m, got {limit}");
        assert_eq!(error.to_string(), rule);
    }

    let mut memory = [Knot::EMPTY; 50];
    let rng = &mut Pcg64::new(1);
    let mut planner =
        Planner::<Fast>::new(&Problem::swing_up(Params::DEFAULT, 1e-3).unwrap()).unwrap();
    let nowhere = State { dtheta1: f32::INFINITY, ..State::HANGING };
    let error = planner.plan_into(nowhere, 3, rng, &mut memory).unwrap_err();
    assert!(error.to_string().starts_with("dtheta1 must be a finite number"), "{error}");
    for memory in [&mut memory[..], &mut []] {
        let error = planner.plan_into(State::HANGING, 3, rng, memory).unwrap_err();
        assert_eq!(error, Error::NoPlan { tries: 3 });
        assert_eq!(error.to_string(), "no plan ends upright in 3 tries");
    }

    // A plan of other numbers stays as it was.
    for (field, name) in [(0, "theta1"), (4, "torque"), (5, "gain")] {
        let mut numbers = [0.1; 9];
        numbers[field] = f32::NAN;
        let [x1, x2, x3, x4, torque, k1, k2, k3, k4] = numbers;
        let mut plan = [Knot::open(0.1); 3];
        plan[1] = Knot::new([x1, x2, x3, x4], torque, [k1, k2, k3, k4]);
        let before = format!("{plan:?}");
        let error = planner.improve(State::HANGING, 3, &mut plan).unwrap_err();
        assert_eq!((error.name(), format!("{plan:?}")), (name, before));
    }

    let fast = State { dtheta1: 1e30, dtheta2: -1e30, ..State::HANGING };
    let mut planner =
        Planner::<Fast>::new(&Problem::swing_up(Params::DEFAULT, 1e38).unwrap()).unwrap();
    for start in [fast, State::HANGING, State::UPRIGHT] {
        let _ = planner.plan_into(start, 10, rng, &mut memory);
        let x = memory[0].state.deviation_from(start);
        assert!(
            x.iter().all(|x| x.is_finite()) && memory.iter().all(|step| step.torque.is_finite())
        );
    }
}

/// Numbers of any size, in single numbers of a state or in all.
#[test]
fn extreme_states_give_an_error_or_a_torque_within_the_limit() {
    const OVERFLOW: &str = "torque must be a finite number of N m, got NaN";
    let rng = &mut Pcg64::new(5);
    let mut wild = || {
        let size = libm::pow(10.0, uniform(rng, -3.0, 38.0));
        (if uniform(rng, -1.0, 1.0) < 0.0 { -size } else { size }) as f32
    };
    let mut plan = [Knot::EMPTY; 5];
    for limit in [0.5, 10.0] {
        let params = Params { dt: 0.01, ..Params::DEFAULT };
        let mut planner = Planner::<Fast>::new(&Problem::swing_up(params, limit).unwrap()).unwrap();
        let mut swing_up = SwingUp::<Fast>::new(params, limit).unwrap();
        let mut counts = [0; 4];
        for i in 0..3000 {
            let x = wild();
            let state = State::from(match i % 3 {
                0 => [x, wild(), wild(), wild()],
                1 => [0.0, 0.5, x, 0.0],
                _ => [3.1, 0.0, 0.0, x],
            });
            match swing_up.torque(state) {
                Ok(torque) => {
                    assert!(torque.abs() <= limit, "{state:?} {torque}");
                    counts[0] += 1;
                }
                Err(error) => {
                    assert_eq!(error.to_string(), OVERFLOW);
                    counts[1] += 1;
                }
            }
            plan.fill(Knot::open(0.1));
            match planner.improve(state, 1, &mut plan) {
                Ok(cost) => {
                    assert!(cost.is_finite(), "{state:?} {cost}");
                    counts[2] += 1;
                }
                Err(error) => {
                    let text = error.to_string();
                    assert!(text == OVERFLOW || text.contains("must be finite"), "{text}");
                    counts[3] += 1;
                }
            }
        }
        assert!(counts.iter().all(|&count| count > 200), "{counts:?}");
    }
}

/// Machines and weights of any size.
#[test]
fn extreme_machines_give_an_error_or_gains_that_are_finite() {
    let rng = &mut Pcg64::new(5);
    let mut counts = [0; 3];
    for _ in 0..1500 {
        let mut wild = |decades: f64| libm::pow(10.0, uniform(rng, -decades, decades)) as f32;
        let [mass1, mass2, length1, length2] = [0; 4].map(|_| wild(6.0));
        let [center_of_mass1, center_of_mass2, inertia1, inertia2] = [0; 4].map(|_| wild(6.0));
        let links = Params { mass1, mass2, length1, length2, ..Params::DEFAULT };
        let params = Params { center_of_mass1, center_of_mass2, inertia1, inertia2, ..links };
        let (params, limit) = (Params { dt: wild(3.0), ..params }, wild(12.0));
        let [arrival, torque, power] = [0; 3].map(|_| wild(20.0));
        let planner = Problem::swing_up(params, limit).and_then(|problem| {
            let cost = Cost { arrival, torque, power, ..problem.cost };
            Planner::<Fast>::new(&Problem { cost, ..problem })
        });
        let Ok(mut planner) = planner else {
            counts[0] += 1;
            continue;
        };
        let state = State::from([1.0, 0.5, wild(6.0), 0.0]);
        let mut plan = [Knot::open(0.1); 30];
        let improved = planner.improve(state, 3, &mut plan).is_ok();
        let mut gains = plan.iter().flat_map(|knot| knot.gain);
        assert!(!improved || gains.all(f32::is_finite), "{params:?} {limit}");
        counts[1 + usize::from(improved)] += 1;
    }
    assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
}

/// Where a simulation clamps, a plan may reach a bound.
#[test]
fn no_velocity_of_a_plan_reaches_its_bound() -> Result<(), Box<dyn std::error::Error>> {
    let params = Params { dt: 0.02, max_velocity1: 5.0, max_velocity2: 9.0, ..Params::DEFAULT };
    let fastest = |mut planner: Planner<Fast>| {
        let mut memory = [Knot::EMPTY; 200];
        let plan = planner.plan_into(State::HANGING, 64, &mut Pcg64::new(1), &mut memory)?;
        let states = plan.knots.iter().map(|knot| knot.state);
        Ok::<_, Error>(states.fold([0.0_f32; 2], |[first, second], state| {
            [first.max(state.dtheta1.abs()), second.max(state.dtheta2.abs())]
        }))
    };
    let planner = Planner::new(&Problem::swing_up(params, 12.0)?)?;
    let [first, second] = fastest(planner.clone())?;
    assert!(first < 5.0 && second < 9.0, "{first} {second}");
    let [first, second] = fastest(planner.with_velocity_clamp().with_velocity_clamp())?;
    assert!(first == 5.0 || second == 9.0, "{first} {second}");
    Ok(())
}

/// Gymnasium's links with friction of 0.02 N m s/rad in both joints, ±1 N m and no bounds: a
/// swing-up takes longer than 20 s.
#[test]
fn a_weak_motor_swings_up_against_friction() -> Result<(), Box<dyn std::error::Error>> {
    let [damping1, damping2] = [0.02; 2];
    let [max_velocity1, max_velocity2] = [f32::INFINITY; 2];
    let params =
        Params { dt: 0.02, damping1, damping2, max_velocity1, max_velocity2, ..Params::DEFAULT };
    let mut planner = Planner::<Damped<Fast>>::new(&Problem::swing_up(params, 0.8)?)?;
    let (mut plan, rng) = ([Knot::EMPTY; 1500], &mut Pcg64::new(3));
    let mut ends_upright = || {
        planner.guess(State::HANGING, rng, &mut plan)?;
        planner.improve(State::HANGING, 150, &mut plan)?;
        Ok::<_, Error>(planner.regulator().holds_from(plan[1499].state))
    };
    // docs/control.md says that about one in four does.
    let held = (0..20).filter(|_| ends_upright() == Ok(true)).count();
    assert!((2..=9).contains(&held), "{held}");
    assert!((0..20).any(|_| ends_upright() == Ok(true)));
    let plan = Plan { knots: plan, after: *planner.regulator().feedback() };
    for nearby in [[0.0; 4], [0.05, -0.05, 0.05, 0.05], [-0.1, 0.1, 0.0, -0.1]] {
        let machine = Pendulum::<Damped<Fast>>::new(params, State::from(nearby))?;
        assert!(holds(&plan, machine, 1.0), "{nearby:?}");
    }
    Ok(())
}

#[test]
fn a_plan_that_does_not_fit_into_memory_is_an_error() -> Result<(), Box<dyn std::error::Error>> {
    let mut planner = Planner::<Fast>::new(&Problem::swing_up(Params::DEFAULT, 1.0)?)?;
    for steps in [usize::MAX, 1 << 45] {
        let error = planner.plan(State::HANGING, 1, &mut Pcg64::new(1), steps).unwrap_err();
        assert_eq!(error.to_string(), format!("all knots must fit into memory, got {steps}"));
    }
    Ok(())
}

/// Where `f32` loses a velocity, no regulator holds.
#[test]
fn steps_that_are_too_short_for_a_scalar_are_rejected() {
    let params = Params { dt: 1e-5, ..Params::DEFAULT };
    let error = BoundedRegulator::<Fast>::new(params.cast(), 1.0).unwrap_err();
    let rule = "dt must be longer for this scalar, which loses small velocities upright, in s, got";
    assert!(error.to_string().starts_with(rule), "{error}");
    let planner = Planner::<Portable>::new(&Problem::swing_up(params, 1.0).unwrap()).unwrap();
    assert!(planner.regulator().holds_from(State::UPRIGHT));
}

/// Each weight lowers what it weights.
#[test]
fn a_weight_lowers_what_it_weights() -> Result<(), Box<dyn std::error::Error>> {
    /// Of a knot and the one before.
    type Term = fn(&Knot<f64>, &Knot<f64>) -> f64;
    let params = Params { dt: 0.02, ..Params::DEFAULT };
    let problem = Problem::swing_up(params, 6.0)?;
    let plain = problem.cost;
    let mut guesses = [[Knot::EMPTY; 200]; 4];
    let (mut guesser, rng) = (Planner::<Portable>::new(&problem)?, &mut Pcg64::new(3));
    for guess in &mut guesses {
        guesser.guess(State::HANGING, rng, guess)?;
    }
    // Each guess leads to another plan, so one of them may have more of it.
    let sum = |cost, term: Term| {
        let mut planner = Planner::<Portable>::new(&Problem { cost, ..problem })?;
        let mut sum = 0.0;
        for mut plan in guesses {
            planner.improve(State::HANGING, 100, &mut plan)?;
            sum += plan.windows(2).map(|knots| term(&knots[1], &knots[0])).sum::<f64>();
        }
        Ok::<f64, Box<dyn std::error::Error>>(sum)
    };
    let cases: [(Cost, Term); 8] = [
        (Cost { torque: 1.0, ..plain }, |k, _| k.torque.powi(2)),
        (Cost { torque_change: 1.0, ..plain }, |k, before| (k.torque - before.torque).powi(2)),
        (Cost { power: 1.0, ..plain }, |k, _| (k.torque * k.state.dtheta2).abs()),
        (Cost { q: diagonal([0.0, 0.0, 1.0, 0.0]), ..plain }, |k, _| k.state.dtheta1.powi(2)),
        (Cost { q: diagonal([0.0, 0.0, 0.0, 1.0]), ..plain }, |k, _| k.state.dtheta2.powi(2)),
        (Cost { q: diagonal([100.0, 0.0, 0.0, 0.0]), ..plain }, |k, _| {
            k.state.deviation_from(State::UPRIGHT)[0].powi(2)
        }),
        (Cost { angles: [100.0, 0.0], ..plain }, |k, _| 2.0 + 2.0 * libm::cos(k.state.theta1)),
        (Cost { angles: [0.0, 100.0], ..plain }, |k, _| 2.0 - 2.0 * libm::cos(k.state.theta2)),
    ];
    for (i, (cost, term)) in cases.into_iter().enumerate() {
        let [without, with] = [sum(plain, term)?, sum(cost, term)?];
        assert!(with < 0.9 * without, "{i}: {without} {with}");
    }
    Ok(())
}

#[test]
fn weights_out_of_range_are_rejected() {
    let problem = Problem::swing_up(Params::DEFAULT, 1.0).unwrap();
    let plain = problem.cost;
    for (cost, rule) in [
        (Cost { power: -1.0, ..plain }, "power must be finite and at least 0 per J, got -1"),
        (Cost { margin: 0.0, ..plain }, "margin must be finite and above 0 m, got 0"),
        (Cost { height: f32::NAN, ..plain }, "height must be a finite number of m, got NaN"),
    ] {
        let error = Planner::<Fast>::new(&Problem { cost, ..problem }).unwrap_err();
        assert_eq!(error.to_string(), rule);
    }
}
