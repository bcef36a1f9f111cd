//! Motions to other equilibria than upright, and quadratic costs.

use acrobot::arithmetic::{Arithmetic, Damped, Real};
use acrobot::control::plan::{Cost, Knot, Planner, Problem};
use acrobot::control::regulator::Lqr;
use acrobot::numpy::Pcg64;
use acrobot::physics::{Pendulum, saturate};
use acrobot::{Fast, Params, Portable, State};

use crate::regulators::diagonal;

/// From upright to a bent elbow, and back, with what is left of the motor for corrections.
fn bends_and_straightens<A: Arithmetic>(params: Params, elbow: f64) {
    let (params, limit) = (params.cast::<A::Scalar>(), A::Scalar::from_f64(8.0));
    let problem = |elbow| Problem::balance::<A>(params, limit, A::Scalar::from_f64(elbow)).unwrap();
    let mut machine = Pendulum::<A>::new(params, State::UPRIGHT).unwrap();
    for problem in [problem(elbow), problem(0.0)] {
        let mut planner = Planner::<A>::new(&problem).unwrap();
        let plan = planner.plan(machine.state(), 64, &mut Pcg64::new(1), 300).unwrap();
        assert_eq!(plan.after.target, problem.target);
        for step in 0..800 {
            let torque = plan.torque(step, machine.state());
            machine.step(saturate(torque, A::Scalar::from_f64(10.0))).unwrap();
        }
        let x = machine.state().deviation_from(problem.target).map(Real::to_f64);
        assert!(x.iter().all(|x| x.abs() < 0.01), "{elbow} rad: {x:?}");
        assert!(planner.regulator().holds_from(machine.state()));
    }
}

#[test]
fn a_motion_to_a_bent_equilibrium_and_back() {
    let params = Params { dt: 0.02, ..Params::DEFAULT };
    bends_and_straightens::<Fast>(params, 1.0);
    bends_and_straightens::<Portable>(params, -1.5);
    bends_and_straightens::<Damped<Portable>>(Params { dt: 0.02, ..Params::SWINGUP }, 2.0);
}

/// The target is an equilibrium, and a wrong one is rejected.
#[test]
fn a_target_is_an_equilibrium() {
    let params = Params { dt: 0.02, ..Params::DEFAULT };
    for elbow in [-3.0, -1.0, 0.0, 0.3, 2.5] {
        let problem = Problem::balance::<Portable>(params, 10.0, elbow).unwrap();
        let pendulum = Pendulum::<Portable>::new(params, problem.target).unwrap();
        let rates = pendulum.derivative(problem.torque);
        assert!(rates.iter().all(|rate| rate.abs() < 1e-14), "{elbow} rad: {rates:?}");
        assert!((pendulum.tip_height() - problem.cost.height).abs() < 1e-12, "{elbow} rad");
    }
    assert_eq!(
        Problem::balance::<Portable>(params, 10.0, 0.0).unwrap(),
        Problem::swing_up(params, 10.0).unwrap()
    );
    let error = |problem: Problem| Planner::<Portable>::new(&problem).unwrap_err().to_string();
    let bent = Problem::balance::<Portable>(params, 3.0, 1.5).unwrap();
    let rule = "the largest torque minus the target's must be finite and above 0 N m, got";
    assert!(error(bent).starts_with(rule), "{}", error(bent));
    let moving = Problem { torque: 0.0, limit: 10.0, ..bent };
    assert!(error(moving).starts_with("the state must be in equilibrium"));
}

/// With a quadratic cost, whose end costs what the regulator does, a plan has the torques of the
/// linear-quadratic regulator, however short it is.
#[test]
fn a_quadratic_cost_has_the_torques_of_a_regulator() {
    let params = Params { dt: 0.01, ..Params::DEFAULT };
    for elbow in [0.0, 1.0] {
        let problem = Problem::balance::<Portable>(params, 50.0, elbow).unwrap();
        let pendulum = Pendulum::<Portable>::new(params, problem.target).unwrap();
        let (mut q, r) = (diagonal([1.0, 2.0, 3.0, 4.0]), 0.5);
        (q[0][1], q[1][0]) = (0.7, 0.7);
        let Lqr { gain, cost_to_go } = pendulum.regulator(problem.torque, &q, r).unwrap();
        let cost = Cost {
            q: q.map(|row| row.map(|x| x / params.dt)),
            qf: cost_to_go,
            torque: r / params.dt,
            below: 0.0,
            arrival: 0.0,
            ..problem.cost
        };
        let mut planner = Planner::<Portable>::new(&Problem { cost, ..problem }).unwrap();
        for len in [1, 30] {
            let x = [1e-4, -2e-4, 3e-4, 1e-4];
            let target: [f64; 4] = problem.target.into();
            let start = State::from(std::array::from_fn(|i| target[i] + x[i]));
            let mut plan = vec![Knot::open(problem.torque); len];
            let cost = planner.improve(start, 50, &mut plan).unwrap();
            let wanted = problem.torque - gain.iter().zip(x).map(|(k, x)| k * x).sum::<f64>();
            let error = (plan[0].torque - wanted).abs() / (wanted - problem.torque).abs();
            assert!(error < 1e-3, "{elbow} rad, {len} steps: {} {wanted}", plan[0].torque);
            let least: f64 =
                (0..4).flat_map(|i| (0..4).map(move |j| x[i] * cost_to_go[i][j] * x[j])).sum();
            assert!((cost / least - 1.0).abs() < 1e-3, "{elbow} rad, {len} steps: {cost} {least}");
        }
    }
}
