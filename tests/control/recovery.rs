//! What the regulator takes over, it holds, and so the end of each plan: on machines of four
//! decades of length, mass and rate, with and without friction. `SEED=7 MACHINES=1000 cargo test
//! --release --test control machines -- --nocapture` tries others.

use std::env;
use std::f64::consts::PI;

use acrobot::arithmetic::{Arithmetic, Damped, Real};
use acrobot::control::plan::{Knot, Plan, Planner, Problem, SwingUp};
use acrobot::control::regulator::BoundedRegulator;
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::{Pendulum, saturate};
use acrobot::{Fast, Params, Portable, State};

use crate::cast;
use crate::estimator::{real, scaled};

/// The machine's time √(I / F), s, written again.
pub fn time(params: &Params, limit: f64) -> f64 {
    let reach = params.length1 + params.center_of_mass2;
    let inertia = params.mass1 * params.center_of_mass1.powi(2) + params.inertia1;
    let inertia = inertia + params.inertia2 + params.mass2 * reach.powi(2);
    (inertia / (weight(params) + limit)).sqrt()
}

/// The torque of gravity on the straight machine when it is level, N m.
fn weight(params: &Params) -> f64 {
    let reach = params.length1 + params.center_of_mass2;
    (params.mass1 * params.center_of_mass1 + params.mass2 * reach) * params.gravity.abs()
}

/// Whether the machine that follows a plan is upright from 36 to 40 of its times after the plan:
/// both links within 0.01 rad. Dry friction keeps a machine moving for ever, and so does `f32` at
/// more than 100 steps in that time: then it holds if link 1 stays within 0.3 rad.
pub fn holds<A: Arithmetic, K: AsRef<[Knot<A::Scalar>]>>(
    plan: &Plan<A::Scalar, K>,
    mut machine: Pendulum<A>,
    limit: A::Scalar,
) -> bool {
    let steps = plan.knots.as_ref().len();
    let params: Params = machine.params().cast();
    let rate = time(&params, limit.to_f64()) / params.dt;
    let loses_bits = size_of::<A::Scalar>() == 4 && rate > 100.0;
    let is_rough = [params.coulomb1, params.coulomb2] != [0.0; 2] || loses_bits;
    let [first, last] = [36.0, 40.0].map(|times| steps + (times * rate) as usize);
    (0..last).all(|i| {
        machine.step(saturate(plan.torque(i, machine.state()), limit)).unwrap();
        let [x1, x2, ..] = machine.state().deviation_from(State::UPRIGHT).map(Real::to_f64);
        // It falls for good beyond a level link.
        let most = if i > first { if is_rough { 0.3 } else { 0.01 } } else { PI / 2.0 };
        i < steps || x1.abs() < most && (i <= first || is_rough || x2.abs() < most)
    })
}

/// Friction of the joints.
#[derive(Clone, Copy, Debug)]
enum Friction {
    None,
    Viscous,
    /// Up to 3 % of the motor's torque, and viscous.
    Dry,
}

/// A machine, its largest torque, N m, and the random numbers to go on with. Its steps are a tenth
/// to a fortieth of its time.
fn machine(seed: u64, friction: Friction) -> (Params, f64, Pcg64) {
    let mut rng = Pcg64::new(seed);
    let mut log = |low: f64, high: f64| uniform(&mut rng, low.ln(), high.ln()).exp();
    let [length, mass] = [0; 2].map(|_| log(0.01, 100.0));
    let [length1, length2] = [0; 2].map(|_| length * log(0.5, 2.0));
    let [mass1, mass2] = [0; 2].map(|_| mass * log(0.4, 2.5));
    let (strength, rate) = (log(0.05, 1.0), log(10.0, 40.0));
    let [part1, part2] = [0; 2].map(|_| uniform(&mut rng, 0.3, 0.7));
    let params = Params {
        mass1,
        mass2,
        length1,
        length2,
        center_of_mass1: length1 * part1,
        center_of_mass2: length2 * part2,
        inertia1: mass1 * length1 * length1 / 12.0,
        inertia2: mass2 * length2 * length2 / 12.0,
        max_velocity1: f64::INFINITY,
        max_velocity2: f64::INFINITY,
        ..Params::DEFAULT
    };
    let limit = strength * weight(&params);
    let time = time(&params, limit);
    let mut joints = |most: f64| [0; 2].map(|_| uniform(&mut rng, 0.0, most));
    let ([damping1, damping2], [coulomb1, coulomb2]) =
        (joints(0.1 * limit * time), joints(0.03 * limit));
    let params = match friction {
        Friction::None => params,
        Friction::Viscous => Params { damping1, damping2, ..params },
        Friction::Dry => Params { damping1, damping2, coulomb1, coulomb2, ..params },
    };
    (Params { dt: time / rate, ..params }, limit, rng)
}

/// The seeds of machines: as many as the variable `MACHINES` says, from `SEED` on.
fn seeds(machines: u64) -> Vec<u64> {
    let number = |name, default| env::var(name).map_or(default, |text| text.parse().unwrap());
    let (first, machines) = (number("SEED", 0), number("MACHINES", machines));
    println!("SEED={first} MACHINES={machines}");
    (0..machines).map(|i| first.wrapping_mul(1_000_000).wrapping_add(i)).collect()
}

/// How many of some states near the border of what the motor can hold the regulator accepts, how
/// many of these fall, and how many others would be held.
fn caught<A: Arithmetic>(params: &Params, limit: f64, states: u32, rng: &mut Pcg64) -> [u32; 3] {
    let (time, cast_params, [limit]) = (time(params, limit), params.cast(), cast([limit]));
    let regulator = match BoundedRegulator::<A>::new(cast_params, limit) {
        Ok(regulator) => regulator,
        // `f32` cannot hold at each rate.
        Err(error) => {
            let is_too_short = error.to_string().starts_with("dt must be longer");
            assert!(is_too_short && size_of::<A::Scalar>() == 4, "{params:?}: {error}");
            return [0; 3];
        }
    };
    let mut counts = [0; 3];
    for _ in 0..states {
        let size = uniform(rng, -6.0, 0.0).exp();
        let x = [0.7, 1.4, 1.0 / time, 2.0 / time];
        let [x1, x2, x3, x4] = x.map(|most| size * uniform(rng, -most, most));
        let state = State::from(cast([PI + x1, x2, x3, x4]));
        let plan = Plan { knots: [], after: *regulator.feedback() };
        let held = || holds(&plan, Pendulum::<A>::new(cast_params, state).unwrap(), limit);
        match regulator.holds_from(state) {
            true => {
                counts[0] += 1;
                counts[1] += u32::from(!held());
            }
            false => counts[2] += u32::from(held()),
        }
    }
    counts
}

fn sum<const N: usize>(x: [u32; N], y: [u32; N]) -> [u32; N] {
    std::array::from_fn(|i| x[i] + y[i])
}

/// Named machines, and one that fell before constants had the machine's units.
#[test]
fn accepted_states_are_held_and_few_others_would_be() {
    let rng = &mut Pcg64::new(3);
    let mut counts = [0; 3];
    let mut add = |more| counts = sum(counts, more);
    for limit in [1.0, 2.0, 5.0, 10.0] {
        for dt in [0.01, 0.02, 0.05] {
            let params = Params { dt, ..Params::DEFAULT };
            let params = Params { max_velocity1: 1e30, max_velocity2: 1e30, ..params };
            add(caught::<Fast>(&params, limit, 400, rng));
            add(caught::<Damped<Portable>>(&Params { dt, ..Params::SWINGUP }, limit, 400, rng));
        }
    }
    let (small, _, _) = machine(0, Friction::None);
    let small = Params {
        length1: 0.1,
        length2: 0.06,
        mass1: 0.1,
        mass2: 0.1,
        center_of_mass1: 0.05,
        center_of_mass2: 0.03,
        inertia1: 1e-3 / 12.0,
        inertia2: 3.6e-4 / 12.0,
        dt: 0.004,
        ..small
    };
    add(caught::<Portable>(&small, 0.023, 2000, rng));
    let [accepted, fallen, missed] = counts;
    assert!(accepted > 4000 && fallen == 0 && missed < accepted / 100, "{counts:?}");
}

#[test]
fn accepted_states_of_random_machines_are_held() {
    let mut counts = [[0; 3]; 2];
    // The last one fell while the simulation took steps of T/50.
    let seeds = [seeds(120), vec![1_000_155]].concat();
    for &seed in &seeds {
        let friction = [Friction::None, Friction::Viscous, Friction::Dry][seed as usize % 3];
        let (params, limit, mut rng) = machine(seed, friction);
        // Each seventh machine is controlled at up to 10,000 steps of its time.
        let (fast, states) = if seed % 7 == 0 { (1e4, 8) } else { (300.0, 40) };
        let rate = uniform(&mut rng, f64::ln(10.0), f64::ln(fast)).exp();
        let params = Params { dt: time(&params, limit) / rate, ..params };
        let found = match seed % 2 {
            0 => caught::<Damped<Fast>>(&params, limit, states, &mut rng),
            _ => caught::<Damped<Portable>>(&params, limit, states, &mut rng),
        };
        assert!(found[1] == 0, "machine {seed} {friction:?}: {found:?}, {params:?}, {limit} N m");
        let is_dry = usize::from(matches!(friction, Friction::Dry));
        counts[is_dry] = sum(counts[is_dry], found);
    }
    println!("accepted, fallen and refused, without and with dry friction: {counts:?}");
    let [[accepted, _, missed], [with_dry, ..]] = counts;
    let least = 5 * seeds.len() as u32;
    assert!(accepted > least && missed <= accepted / 100 && 5 * with_dry > least, "{counts:?}");
}

/// Whether a random machine has a plan, which holds.
fn is_planned<A: Arithmetic>(seed: u64, friction: Friction, tries: u32) -> bool {
    let (params, limit, mut rng) = machine(seed, friction);
    let mut memory = vec![Knot::EMPTY; (20.0 * time(&params, limit) / params.dt) as usize];
    let (params, [limit]) = (params.cast(), cast([limit]));
    let mut planner = Planner::<A>::new(&Problem::swing_up(params, limit).unwrap()).unwrap();
    let Ok(plan) = planner.plan_into(State::HANGING, tries, &mut rng, &mut memory) else {
        return false;
    };
    let machine = Pendulum::<A>::new(params, State::HANGING).unwrap();
    assert!(holds(&plan, machine, limit), "machine {seed} {friction:?} falls");
    true
}

#[test]
fn plans_for_random_machines_hold() {
    let mut planned = [0; 3];
    let (machines, tries) = if cfg!(debug_assertions) { (8, 16) } else { (100, 32) };
    let seeds = seeds(machines);
    for &seed in &seeds {
        for (i, friction) in [Friction::None, Friction::Viscous, Friction::Dry].iter().enumerate() {
            planned[i] += u64::from(match seed % 2 {
                0 => is_planned::<Damped<Fast>>(seed, *friction, tries),
                _ => is_planned::<Damped<Portable>>(seed, *friction, tries),
            });
        }
    }
    println!("planned without friction, with viscous and with dry friction: {planned:?}");
    // A half have a plan, and a third with dry friction, but there may be few machines.
    let machines = seeds.len() as u64;
    assert!(planned[0] + planned[1] > machines / 3 && 16 * planned[2] > machines, "{planned:?}");
}

/// RealAIGym's machine and Gymnasium's, with friction from which plans fell.
#[test]
fn plans_with_dry_friction_hold() {
    let gymnasium = Params { dt: 0.02, coulomb1: 0.1, coulomb2: 0.1, ..Params::DEFAULT };
    let (mut planned, infinite) = (0, f64::INFINITY);
    for (params, limit) in [(Params { dt: 0.01, ..real() }, 5.4), (gymnasium, 5.0)] {
        let params = Params { max_velocity1: infinite, max_velocity2: infinite, ..params };
        let mut planner =
            Planner::<Damped<Portable>>::new(&Problem::swing_up(params, limit).unwrap()).unwrap();
        for seed in 0..4 {
            let mut memory = [Knot::EMPTY; 400];
            let plan = planner.plan_into(State::HANGING, 20, &mut Pcg64::new(seed), &mut memory);
            if let Ok(plan) = plan {
                planned += 1;
                let machine = Pendulum::<Damped<Portable>>::new(params, State::HANGING).unwrap();
                assert!(holds(&plan, machine, limit), "{limit} N m, {seed}");
            }
        }
    }
    assert!(planned > 2, "{planned}");
}

/// Without a plan a swing-up does not depend on the rate: from hanging at rest, and from a few mrad
/// beside upright.
#[test]
fn decisions_hold_at_any_rate() {
    let free = Params { max_velocity1: 1e9, max_velocity2: 1e9, ..Params::DEFAULT };
    let time = time(&free, 10.0);
    for rate in [10.0, 100.0, 1000.0, 10_000.0] {
        let params = Params { dt: time / rate, ..free };
        let held = [0.1, -0.1, 3.137, -3.13].map(|theta1| {
            let start = State { theta1, ..State::HANGING };
            let mut swing_up = SwingUp::<Portable>::new(params, 10.0).unwrap();
            let mut machine = Pendulum::<Portable>::new(params, start).unwrap();
            for _ in 0..(60.0 * rate) as u32 {
                let torque = swing_up.torque(machine.state()).unwrap();
                machine.step(torque).unwrap();
            }
            let [x1, x2, ..] = machine.state().deviation_from(State::UPRIGHT);
            x1.abs().max(x2.abs()) < 0.05
        });
        let swung_up = held[..2].iter().filter(|held| **held).count();
        assert!(swung_up > 0 && held[2] && held[3], "{rate} steps in T: {held:?}");
    }
}

/// docs/control.md has these numbers.
#[test]
fn a_regulator_keeps_a_machine_with_dry_friction_moving() {
    let swing = |params: Params, limit: f64, part: f64| {
        let [coulomb1, coulomb2] = [part * limit; 2];
        let params =
            Params { coulomb1, coulomb2, max_velocity1: 1e9, max_velocity2: 1e9, ..params };
        let regulator = BoundedRegulator::<Damped<Portable>>::new(params, limit).unwrap();
        let lean = State { theta1: PI - 0.01, ..State::UPRIGHT };
        let mut machine = Pendulum::<Damped<Portable>>::new(params, lean).unwrap();
        let mut most = 0.0_f64;
        for i in 0..8000 {
            machine.step(regulator.torque(machine.state())).unwrap();
            let [x, ..] = machine.state().deviation_from(State::UPRIGHT);
            most = if i < 4000 { 0.0 } else { most.max(x.abs()) };
        }
        assert_eq!(regulator.holds_from(lean), most < 0.3, "{part} of {limit} N m: {most} rad");
        (1000.0 * most).round()
    };
    let gymnasium = Params { dt: 0.01, ..Params::DEFAULT };
    assert_eq!([0.003, 0.01].map(|part| swing(gymnasium, 10.0, part)), [11.0, 48.0]);
    assert!(swing(gymnasium, 10.0, 0.03) > 1000.0);
    let real = Params { dt: 0.005, damping1: 0.0, damping2: 0.0, ..real() };
    assert!([0.003, 0.01, 0.03].iter().all(|part| swing(real, 6.0, *part) > 1000.0));
}

/// A plan, decisions and accepted states of a machine, in numbers that are equal for all scales.
fn results<A: Arithmetic>(params: &Params, limit: f64, [a, b]: [f64; 2], seed: u64) -> Vec<f64> {
    let (root, torque) = (a.sqrt(), a * b);
    let (params, [limit]) = (scaled(params, a, b, root).cast(), cast([torque * limit]));
    let mut planner = Planner::<A>::new(&Problem::swing_up(params, limit).unwrap()).unwrap();
    let rng = &mut Pcg64::new(seed);
    let mut plan = [Knot::EMPTY; 60];
    let mut memory = [Knot::EMPTY; 60];
    let mut swing_up = SwingUp::<A>::new(params, limit).unwrap();
    let found = planner.plan_into(State::HANGING, 20, rng, &mut memory);
    let mut results = vec![found.map_or(0.0, |plan| plan.knots.len() as f64)];
    planner.guess(State::HANGING, rng, &mut plan).unwrap();
    results.push(planner.improve(State::HANGING, 20, &mut plan).unwrap().to_f64());
    for knot in plan {
        let State { theta1, theta2, dtheta1, dtheta2 } = knot.state.cast::<f64>();
        let [k1, k2, k3, k4] = knot.gain.map(|x| x.to_f64() / torque);
        let x = [theta1, theta2, dtheta1 * root, dtheta2 * root, knot.torque.to_f64() / torque];
        results.extend([x, [k1, k2, k3 / root, k4 / root, 0.0]].concat());
    }
    for _ in 0..50 {
        let size = uniform(rng, -6.0, 0.0).exp();
        let [x1, x2, x3, x4] = [0; 4].map(|_| size * uniform(rng, -1.0, 1.0));
        let state = State::from(cast([PI + x1, x2, x3 / root, x4 / root]));
        results.push(f64::from(u8::from(planner.regulator().holds_from(state))));
        results.push(swing_up.torque(state).unwrap().to_f64() / torque);
    }
    results
}

/// For powers of 4 and 2 all bits are equal. Coulomb friction is no part of this law, because the
/// velocity below which it is smooth is the same for all machines.
#[test]
fn plans_and_decisions_scale_with_the_machine() {
    for seed in 0..8 {
        // Rounded, so that scaling to f32 and back is exact.
        let (params, limit, _) =
            machine(seed, [Friction::None, Friction::Viscous][seed as usize % 2]);
        let (params, limit) = (params.cast::<f32>().cast(), f64::from(limit as f32));
        let alone = results::<Damped<Portable>>(&params, limit, [1.0; 2], seed);
        let alone32 = results::<Damped<Fast>>(&params, limit, [1.0; 2], seed);
        for (a, b) in [(-2, 3), (3, -5), (1, 7)] {
            let scales = [libm::pow(4.0, a.into()), libm::pow(2.0, b.into())];
            assert_eq!(results::<Damped<Portable>>(&params, limit, scales, seed), alone, "{seed}");
            assert_eq!(results::<Damped<Fast>>(&params, limit, scales, seed), alone32, "{seed}");
        }
    }
}
