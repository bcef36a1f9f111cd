//! What the regulator takes over, it holds: each accepted state, and the end of each plan.

use acrobot::arithmetic::{Arithmetic, Damped, Real};
use acrobot::control::{Knot, Planner, difference};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::{Joints, Pendulum, saturate};
use acrobot::{Fast, Params, Portable, State};

use crate::cast;

const REST: f64 = 20.0; // s after a plan

/// Whether the machine that follows a plan is upright in the last second, within 0.01 rad.
pub fn holds<A: Arithmetic>(
    planner: &Planner<A>,
    mut machine: Pendulum<A>,
    plan: &[Knot<A::Scalar>],
    limit: A::Scalar,
) -> bool {
    let rate = 1.0 / machine.params().dt.to_f64();
    let steps = plan.len() + (REST * rate) as usize;
    let mut upright = 0;
    for i in 0..steps {
        machine.step(saturate(planner.follow(plan, i, machine.state()), limit)).unwrap();
        let [x1, x2, ..] = difference(machine.state(), State::UPRIGHT).map(Real::to_f64);
        if x1.abs().max(x2.abs()) > 0.01 {
            upright = i + 1;
        }
    }
    upright + rate as usize <= steps
}

/// How many states near the border of what the motor can hold are accepted, how many of these fall,
/// and how many others would be held.
fn count<A: Arithmetic>(params: Params<f64>, limit: f64, rng: &mut Pcg64) -> [u32; 3] {
    let (params, [limit]) = (params.cast(), cast([limit]));
    let planner = Planner::<A>::new(params, limit).unwrap();
    let [mut accepted, mut fallen, mut missed] = [0; 3];
    for _ in 0..850 {
        let size = uniform(rng, -6.0, 0.0).exp();
        let [x1, x2, x3, x4] = [0.7, 1.4, 2.0, 4.0].map(|most| size * uniform(rng, -most, most));
        let state = State::from(cast([core::f64::consts::PI + x1, x2, x3, x4]));
        let held = || holds(&planner, Pendulum::new(params, state).unwrap(), &[], limit);
        match planner.catches(state) {
            true => {
                accepted += 1;
                fallen += u32::from(!held());
            }
            false => missed += u32::from(held()),
        }
    }
    [accepted, fallen, missed]
}

#[test]
fn accepted_states_are_held_and_few_others_would_be() {
    let mut counts = [0; 3];
    let mut add = |more: [u32; 3]| counts = core::array::from_fn(|i| counts[i] + more[i]);
    let rng = &mut Pcg64::new(3);
    for limit in [1.0, 2.0, 5.0, 10.0] {
        for dt in [0.01, 0.02, 0.05] {
            add(count::<Fast>(Params { dt, ..Params::DEFAULT }, limit, rng));
            add(count::<Damped<Portable>>(Params { dt, ..Params::SWINGUP }, limit, rng));
        }
    }
    let [accepted, fallen, missed] = counts;
    assert!(accepted > 10_000 && fallen == 0 && missed < accepted / 50, "{counts:?}");
}

/// Links and masses between those of a small machine and twice those of Gymnasium's.
fn machine(rng: &mut Pcg64) -> (Params<f64>, f64) {
    let mut log = |low: f64, high: f64| uniform(rng, low.ln(), high.ln()).exp();
    let [length1, length2] = [0; 2].map(|_| log(0.2, 2.0));
    let [mass1, mass2] = [0; 2].map(|_| log(0.2, 3.0));
    let (dt, limit) = (log(0.005, 0.05), log(0.5, 10.0));
    let mut part = |low, high| uniform(rng, low, high);
    let params = Params {
        mass1,
        mass2,
        length1,
        length2,
        center_of_mass1: length1 * part(0.3, 0.7),
        center_of_mass2: length2 * part(0.3, 0.7),
        inertia1: mass1 * length1 * length1 / 12.0,
        inertia2: mass2 * length2 * length2 / 12.0,
        friction: Joints { joint1: part(0.0, 0.1), joint2: part(0.0, 0.1) },
        dt,
        max_velocity1: 1e30,
        max_velocity2: 1e30,
        ..Params::DEFAULT
    };
    (params, limit)
}

/// How many plans are found for random machines, and how many of them fall.
fn plans<A: Arithmetic>(machines: u64) -> [u32; 2] {
    let [mut found, mut fallen] = [0; 2];
    for seed in 0..machines {
        let rng = &mut Pcg64::new(seed);
        let (params, limit) = machine(rng);
        let (params, [limit]) = (params.cast(), cast([limit]));
        let [theta1, theta2] = cast([0; 2].map(|_| uniform(rng, -3.1, 3.1)));
        let start = State { theta1, theta2, ..State::HANGING };
        let mut planner = Planner::<A>::new(params, limit).unwrap();
        if let Ok(plan) = planner.plan(start, 10, rng, &mut [Knot::EMPTY; 400]) {
            found += 1;
            let machine = Pendulum::new(params, start).unwrap();
            fallen += u32::from(!holds(&planner, machine, plan, limit));
        }
    }
    [found, fallen]
}

#[test]
fn plans_for_random_machines_hold() {
    let machines = if cfg!(debug_assertions) { 10 } else { 500 };
    let counts = [plans::<Damped<Fast>>(machines), plans::<Damped<Portable>>(machines / 2)];
    let [[found, fallen], [found64, fallen64]] = counts;
    assert!(found + found64 > 5 && fallen + fallen64 == 0, "{counts:?}");
}
