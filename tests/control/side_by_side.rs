//! Plans side by side are those of one alone.

use std::cell::Cell;

use acrobot::arithmetic::{Arithmetic, Damped, Real};
use acrobot::control::plan::{Knot, Planner, Problem};
use acrobot::numpy::Pcg64;
use acrobot::{Error, Fast, Params, Portable, State};
use common::twins::LEVELS;

/// At each level of SIMD, whatever lengths the plans have.
#[test]
fn plans_side_by_side_have_the_bits_of_one_alone() -> Result<(), Box<dyn std::error::Error>> {
    alone_or_in_a_lane::<Fast>(Params { dt: 0.02, ..Params::DEFAULT })?;
    alone_or_in_a_lane::<Damped<Portable>>(Params::SWINGUP)
}

/// One order of tries, one result: in memory of the caller and over lanes, which leave the
/// generator alike.
#[test]
fn a_seed_has_one_plan() -> Result<(), Box<dyn std::error::Error>> {
    let params = Params { dt: 0.04, ..Params::DEFAULT };
    let mut planner = Planner::<Fast>::new(&Problem::swing_up(params, 5.0)?)?;
    let (mut memory, mut late) = ([Knot::EMPTY; 80], 0);
    for seed in 0..8 {
        let [mut alone, mut lanes] = [0; 2].map(|_| Pcg64::new(seed));
        let found = planner.plan_into(State::HANGING, 50, &mut alone, &mut memory);
        let others = planner.plan(State::HANGING, 50, &mut lanes, 80);
        assert_eq!(alone, lanes, "{seed}");
        match (found, others) {
            (Ok(found), Ok(other)) => {
                assert_eq!((found.knots, found.after), (&mut other.knots.clone()[..], other.after));
                let early = planner.plan(State::HANGING, 10, &mut Pcg64::new(seed), 80);
                late += u32::from(early.is_err());
            }
            (found, other) => assert_eq!(found.map(drop), other.map(drop), "{seed}"),
        }
    }
    assert!(late > 2, "{late} plans over lanes");
    Ok(())
}

fn alone_or_in_a_lane<A: Arithmetic>(
    params: Params<A::Scalar>,
) -> Result<(), Box<dyn std::error::Error>> {
    let weight = A::Scalar::from_f64(0.5);
    let limit = A::Scalar::from_f64(3.0);
    let mut problem = Problem::swing_up(params, limit)?;
    (problem.cost.torque_change, problem.cost.power) = (weight, weight);
    let mut planner = Planner::<A>::new(&problem)?;
    let (start, rng) =
        (State::from([0.1, 0.2, -0.3, 0.4].map(A::Scalar::from_f64)), &mut Pcg64::new(1));
    let mut guesses = vec![vec![]];
    for len in (1..20).map(|i| i * 37 % 101) {
        let mut plan = vec![Knot::EMPTY; len];
        planner.guess(start, rng, &mut plan)?;
        guesses.push(plan);
    }
    let mut alone = guesses.clone();
    // Each plan begins in another state.
    let starts: Vec<_> = (0..guesses.len())
        .map(|i| State { theta2: A::Scalar::from_f64(0.2 + 0.01 * i as f64), ..start })
        .collect();
    let plans = alone.iter_mut().zip(&starts);
    let costs = plans.map(|(plan, start)| planner.improve(*start, 20, plan));
    let costs: Vec<_> = costs.collect::<Result<_, _>>()?;
    for level in LEVELS {
        planner.set_simd_level(level);
        let mut side = guesses.clone();
        assert_eq!(planner.improve_each(&starts, 20, &mut side)?, costs, "{level:?}");
        assert_eq!(side, alone, "{level:?}");
    }
    Ok(())
}

/// Some states get a plan by the first tries, some later, and some none.
#[test]
fn plans_from_many_states_are_those_from_each() -> Result<(), Error> {
    let params = Params { dt: 0.04, ..Params::DEFAULT };
    let mut planner = Planner::<Fast>::new(&Problem::swing_up(params, 5.0)?)?;
    let state = |i: u8| State { theta1: 0.25 * f32::from(i), ..State::HANGING };
    let starts: Vec<_> = (0..24).map(state).collect();
    let (rng, most) = (Pcg64::new(3), Cell::new(0));
    let count = |found| most.replace(found) <= found;
    let plans = planner.plan_each(&starts, 15, &rng, 50, count)?;
    for (start, plan) in starts.iter().zip(&plans) {
        assert_eq!(planner.plan(*start, 15, &mut rng.clone(), 50).ok(), *plan, "{start:?}");
    }
    let found = plans.iter().flatten().count();
    assert!((5..22).contains(&found) && most.get() <= found, "{found}");
    let few = planner.plan_each(&starts, 15, &rng, 50, |found| found < 3)?;
    assert!((3..found).contains(&few.iter().flatten().count()));
    let error = planner.plan_each(&[State { theta1: f32::NAN, ..starts[0] }], 1, &rng, 9, |_| true);
    assert_eq!(error.unwrap_err().to_string(), "theta1 must be a finite number of rad, got NaN");
    Ok(())
}
