//! Promise 2 in other languages: calls with their results, which Rust writes into
//! `data/results.jsonl` and the tests of the packages for C, Python and JavaScript replay.
//! `UPDATE_SNAPSHOTS` writes it again. All numbers are in flat arrays, so that `awk` can read them.

use std::f32::consts::TAU;
use std::fmt::Write as _;
use std::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Damped, Portable, Real};
use acrobot::batch::{Autoreset, VecBatch};
use acrobot::control::estimate::{Noise, ParameterEstimator, ParameterStd};
use acrobot::control::identify::{Calibration, Fit, Regression, Sample, calibrate, identify};
use acrobot::control::model::{Forces, LinearModel, StepModel};
use acrobot::control::mpc::{Controller, Replanner, Report, Settings};
use acrobot::control::plan::{Knot, Planner, Problem, SwingUp};
use acrobot::control::regulator::{Lqe, Lqr, dlqe, dlqr, lqr, tvlqr};
use acrobot::numpy::Pcg64;
use acrobot::physics::Pendulum;
use acrobot::task::{AnyTask, Draw, Draws, Instruments, Measured};
use acrobot::{Acrobot, Fast, Params, State, TimeLimit};
use serde_json::{Value, json};

/// A machine of another size and with everything that can differ.
const MACHINE: Params = Params {
    length1: 0.2,
    length2: 0.3,
    mass1: 0.5,
    mass2: 0.6,
    center_of_mass1: 0.2,
    center_of_mass2: 0.25,
    inertia1: 0.01,
    inertia2: 0.02,
    dt: 0.005,
    max_velocity1: 50.0,
    max_velocity2: 50.0,
    damping1: 0.001,
    damping2: 0.002,
    coulomb1: 0.01,
    coulomb2: 0.02,
    rotor: 0.003,
    ..Params::DEFAULT
};
const MOVING: State = State { theta1: 0.1, theta2: -0.2, dtheta1: 0.3, dtheta2: -0.4 };
const Q: [[f64; 4]; 4] =
    [[2.0, 0.5, 0.0, 0.0], [0.5, 1.0, 0.0, 0.0], [0.0, 0.0, 0.125, 0.0], [0.0, 0.0, 0.0, 0.125]];
const R: f64 = 0.5;
/// The largest torque of the motor, N m.
const LIMIT: f32 = 6.0;

#[derive(Default)]
struct Table(String);

impl Table {
    /// Adds a call.
    fn add(&mut self, call: &str, given: Value, result: impl IntoIterator<Item = impl Into<f64>>) {
        let mut row = given;
        row["call"] = json!(call);
        let result: Vec<f64> = result.into_iter().map(Into::into).collect();
        assert!(result.iter().all(|number| number.is_finite()), "{call}");
        row["result"] = json!(result);
        writeln!(self.0, "{row}").unwrap();
    }
}

fn numbers<S: Real>(params: &Params<S>) -> Vec<f64> {
    params.numbers().map(|(_, number)| number.to_f64()).to_vec()
}

/// Kind, low, high, mean and standard deviation of each number.
fn rows<const N: usize>(draws: [(&str, Draw<f32>); N]) -> Vec<f64> {
    let row = |(_, draw)| match draw {
        Draw::Uniform { low, high } => [1.0, low, high, 0.0, 0.0],
        Draw::LogUniform { low, high } => [2.0, low, high, 0.0, 0.0],
        Draw::Normal { mean, std, low, high } => [3.0, low, high, mean, std],
        _ => [0.0; 5],
    };
    draws.into_iter().flat_map(row).map(f64::from).collect()
}

/// N m.
fn torque(step: usize) -> f32 {
    if step % 7 < 3 { 1.5 } else { -2.0 }
}

fn draws() -> Draws<f32> {
    Draws::new(Params {
        mass2: Draw::Uniform { low: 0.8, high: 1.2 },
        inertia1: Draw::LogUniform { low: 0.5, high: 2.0 },
        gravity: Draw::Normal { mean: 9.8, std: 0.1, low: 9.5, high: 10.1 },
        coulomb2: Draw::Uniform { low: 0.1, high: 0.2 },
        ..Draws::FIXED
    })
    .unwrap()
}

/// Episodes of one acrobot, and of a batch whose resets draw parameters.
fn episodes(table: &mut Table) {
    for (number, task) in AnyTask::ALL.into_iter().enumerate() {
        let mut one = TimeLimit::with_task_limit(
            Acrobot::<Damped<Fast>, AnyTask>::with_task(u64::MAX, task).unwrap(),
        );
        one.inner_mut().draw_params(&draws()).unwrap();
        let torques: Vec<f32> = (0..20).map(torque).collect();
        let mut result = numbers(one.params());
        for torque in &torques {
            let step = one.step_torque(*torque).unwrap();
            result.extend(step.observation.map(f64::from));
            result.push(step.reward.into());
        }
        let given = json!({
            "task": number, "seed": [u32::MAX, u32::MAX], "draws": rows(draws().params().numbers()),
            "torques": torques, "snapshot": snapshot(&one),
        });
        table.add("episode", given, result);

        let (count, limit) = (5, 8);
        let mut batch =
            VecBatch::<Damped<Fast>, AnyTask>::with_task(u64::MAX, task, count).unwrap();
        batch.own_params().unwrap();
        batch.set_draws(draws()).unwrap();
        batch.set_max_steps(NonZeroU32::new(limit).unwrap());
        batch.set_autoreset(Autoreset::SameStep);
        batch.reset_with_seed(u64::MAX);
        let torques: Vec<f32> = (0..12 * count).map(torque).collect();
        let mut result = Vec::new();
        for torques in torques.chunks(count) {
            let results = batch.step(torques).unwrap();
            result.extend(results.rewards.iter().copied().map(f64::from));
            result.extend(results.observations.as_flattened().iter().copied().map(f64::from));
        }
        let given = json!({
            "task": number, "seed": [u32::MAX, u32::MAX],
            "draws": rows(draws().params().numbers()), "count": count, "max_steps": limit,
            "torques": torques, "snapshot": snapshot(&batch),
        });
        table.add("batch", given, result);
    }
}

/// A batch with each instrument: one is set, and the others are drawn.
fn instruments(table: &mut Table) {
    let instruments = Instruments {
        action_delay: Some(Draw::Uniform { low: 0.0, high: 8.0 }),
        observation_delay: Some(Draw::Uniform { low: 2.0, high: 2.0 }),
        motor_lag: Some(Draw::LogUniform { low: 0.01, high: 0.1 }),
        torque_error: Some(Draw::Normal { mean: 0.0, std: 0.1, low: -0.5, high: 0.5 }),
        angle_noise: Some(Draw::Uniform { low: 0.0, high: 0.01 }),
        encoder_zero1: Some(Draw::Uniform { low: -0.1, high: 0.1 }),
        encoder_zero2: Some(Draw::Fixed),
        encoder_counts: Some(Draw::Uniform { low: 4096.0, high: 4096.0 }),
        velocity_filter: Some(Draw::Uniform { low: 0.0, high: 0.05 }),
    };
    type Task = Measured<AnyTask, 8>;
    let count = 5;
    let task = Task::new(AnyTask::Balance, instruments).unwrap();
    let mut batch = VecBatch::<Damped<Fast>, Task>::with_task(u64::MAX, task, count).unwrap();
    let zeros: Vec<f32> = (0..count).map(|index| index as f32 / 8.0).collect();
    for (index, encoder_zero2) in zeros.iter().copied().enumerate() {
        let mut memory = batch.memory(index).unwrap();
        let drawn = Task::drawn(&memory);
        Task::set_drawn(&mut memory, Instruments { encoder_zero2, ..drawn }).unwrap();
        batch.set_memory(index, memory).unwrap();
    }
    batch.reset_with_seed(u64::MAX);
    let torques: Vec<f32> = (0..20 * count).map(torque).collect();
    let mut result = Vec::new();
    for torques in torques.chunks(count) {
        let results = batch.step(torques).unwrap();
        result.extend(results.rewards.iter().copied());
        result.extend(results.observations.as_flattened());
    }
    for index in 0..count {
        let drawn = Task::drawn(&batch.memory(index).unwrap());
        result.extend(drawn.numbers().map(|(_, number)| number));
    }
    let draws = instruments.numbers().map(|(name, draw)| (name, draw.unwrap()));
    let given = json!({
        "seed": [u32::MAX, u32::MAX], "draws": rows(draws), "zeros": zeros, "count": count,
        "torques": torques, "snapshot": snapshot(&batch),
    });
    table.add("instruments", given, result);
}

fn snapshot(value: &impl serde::Serialize) -> Vec<u8> {
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
    postcard::to_stdvec_crc32(value, crc.digest()).unwrap()
}

fn flat<S: Real>(vectors: &[&[S]]) -> Vec<f64> {
    vectors.concat().into_iter().map(Real::to_f64).collect()
}

/// Models and regulators, in the arithmetic of C and npm and in that of Python.
fn models<A: Arithmetic>(table: &mut Table) {
    let cast = |x: f64| A::Scalar::from_f64(x);
    let (params, r) = (MACHINE.cast::<A::Scalar>(), cast(R));
    let q = Q.map(|row| row.map(cast));
    let base = |state: State<A::Scalar>, torque: A::Scalar| {
        json!({
            "arithmetic": A::NAME, "params": numbers(&params),
            "state": flat(&[&<[A::Scalar; 4]>::from(state)]), "torque": torque.to_f64(),
        })
    };
    let with = |mut given: Value, name: &str, numbers: Vec<f64>| {
        given[name] = json!(numbers);
        given
    };
    let (state, torque) = (MOVING.cast(), cast(0.5));
    let machine = Pendulum::<A>::new(params, state).unwrap();
    let given = base(state, torque);
    table.add("derivative", given.clone(), flat(&[&machine.derivative(torque)]));
    table.add("mass_matrix", given.clone(), flat(&[machine.mass_matrix().as_flattened()]));
    table.add("energy", given.clone(), [machine.energy().to_f64()]);
    let accelerations = [1.0, -2.0];
    let Forces { torques, .. } = machine.inverse_dynamics(accelerations.map(cast)).unwrap();
    let inverse = with(given.clone(), "accelerations", accelerations.to_vec());
    table.add("inverse_dynamics", inverse, flat(&[&torques]));
    let LinearModel { a, b } = machine.linearize(torque).unwrap();
    table.add("linearize", given.clone(), flat(&[a.as_flattened(), &b]));
    let StepModel { a, b } = machine.linearize_step(torque).unwrap();
    table.add("linearize_step", given.clone(), flat(&[a.as_flattened(), &b]));
    let target = State::UPRIGHT;
    let deviation = with(given, "target", flat(&[&<[A::Scalar; 4]>::from(target)]));
    table.add("deviation", deviation, flat(&[&state.deviation_from(target)]));

    // The elbow is bent.
    let problem = Problem::balance::<A>(params, cast(LIMIT.into()), cast(1.0)).unwrap();
    let (target, torque) = (problem.target, problem.torque);
    let bent = Pendulum::<A>::new(params, target).unwrap();
    let model = bent.linearize_step(torque).unwrap();
    let variances = [0.25, 2.0];
    let Lqe { gain, prior_covariance } = dlqe(&model, &q, variances.map(cast)).unwrap();
    let noise = with(base(target, torque), "w", flat(&[q.as_flattened()]));
    let noise = with(noise, "s", variances.to_vec());
    table.add("dlqe", noise, flat(&[gain.as_flattened(), prior_covariance.as_flattened()]));
    let weights = with(base(target, torque), "q", flat(&[q.as_flattened()]));
    let weights = with(weights, "r", vec![R]);
    let result = |Lqr { gain, cost_to_go }| flat(&[&gain, cost_to_go.as_flattened()]);
    table.add("regulator", weights.clone(), result(bent.regulator(torque, &q, r).unwrap()));
    let continuous = bent.linearize(torque).unwrap();
    table.add("lqr", weights.clone(), result(lqr(&continuous, &q, r).unwrap()));
    table.add("dlqr", weights.clone(), result(dlqr(&model, &q, r).unwrap()));
    let mut gains = [[cast(0.0); 4]; 3];
    let cost_to_go = tvlqr(&[model; 3], &q, r, &q, &mut gains).unwrap();
    let result = flat(&[gains.as_flattened(), cost_to_go.as_flattened()]);
    table.add("tvlqr", weights, result);
}

/// A plan, improved from another state, and swinging up without one.
fn plans(table: &mut Table) {
    let params = Params::<f32> { dt: 0.05, ..Params::DEFAULT };
    let (limit, elbow, steps, seed) = (8.0, 0.25, 80, 3);
    let problem = Problem::balance::<Damped<Fast>>(params, limit, elbow).unwrap();
    let mut planner = Planner::<Damped<Fast>>::new(&problem).unwrap();
    let mut plan = planner.plan(State::HANGING, 64, &mut Pcg64::new(seed), steps).unwrap();
    let knots = |knots: &[Knot<f32>]| -> Vec<f64> {
        let row = |Knot { state, torque, gain, .. }: &Knot<f32>| {
            flat(&[&<[f32; 4]>::from(*state), &[*torque], gain])
        };
        knots.iter().flat_map(row).collect()
    };
    let mut result = knots(&plan.knots);
    let start = State { theta1: 0.05, ..State::HANGING };
    let cost = planner.improve(start, 3, &mut plan.knots).unwrap();
    result.push(cost.into());
    result.extend(knots(&plan.knots));
    for (step, state) in [(0, start), (2, State::UPRIGHT), (steps, State::UPRIGHT)] {
        result.push(plan.torque(step, state).into());
    }
    let given = json!({
        "params": numbers(&params), "limit": limit, "elbow": elbow, "steps": steps, "tries": 64,
        "seed": [seed], "start": flat(&[&<[f32; 4]>::from(start)]), "iterations": 3,
        "length": plan.knots.len(),
    });
    table.add("plan", given, result);

    let mut swing_up = SwingUp::<Damped<Fast>>::new(params, limit).unwrap();
    let states: Vec<[f32; 4]> = (0..20).map(|i| [0.17 * i as f32, 0.1, 0.5, -0.25]).collect();
    let torques = states.iter().map(|state| swing_up.torque((*state).into()).unwrap());
    let given = json!({
        "params": numbers(&params), "limit": limit, "states": flat(&[states.as_flattened()]),
    });
    table.add("swing_up", given, torques.collect::<Vec<_>>());
}

/// What a machine does that nobody holds, with torques of up to 2 N m times `scale`.
fn motion(steps: usize, scale: f32) -> (Vec<[f32; 2]>, Vec<f32>) {
    let mut machine = Pendulum::<Damped<Fast>>::new(MACHINE.cast(), MOVING.cast()).unwrap();
    let torques: Vec<f32> = (0..steps).map(|step| torque(step / 3) * scale).collect();
    let angles = torques.iter().map(|torque| {
        let State { theta1, theta2, .. } = machine.state();
        machine.step(*torque).unwrap();
        [theta1, theta2]
    });
    (angles.collect(), torques)
}

/// The state and parameters of a machine, from its motion.
fn estimates<A: Arithmetic>(table: &mut Table) {
    let cast = |x: f32| A::Scalar::from_f64(x.into());
    let noise = Noise { angle_std: cast(0.001), torque_std: cast(0.05) };
    let std = ParameterStd {
        mass2: cast(0.125),
        coulomb2: cast(0.03),
        zero1: cast(0.25),
        torque_factor: cast(0.0625),
        ..ParameterStd::default()
    };
    let mut estimator = ParameterEstimator::<A>::new(MACHINE.cast(), std, noise).unwrap();
    let (angles, torques) = motion(60, 0.25);
    for (angles, torque) in angles.iter().zip(&torques) {
        estimator.correct(angles.map(cast)).unwrap();
        estimator.predict(cast(*torque)).unwrap();
    }
    let mut result = flat(&[&<[A::Scalar; 4]>::from(estimator.state())]);
    result.extend(flat(&[&estimator.state_std().unwrap()]));
    result.extend(numbers(estimator.params()));
    result.extend(flat(&[&estimator.zeros(), &[estimator.torque_factor()]]));
    let given = json!({
        "arithmetic": A::NAME, "params": numbers(&MACHINE.cast::<A::Scalar>()),
        "angle_std": noise.angle_std.to_f64(), "torque_std": noise.torque_std.to_f64(),
        "mass2_std": std.mass2.to_f64(), "coulomb2_std": std.coulomb2.to_f64(),
        "zero1_std": std.zero1.to_f64(), "torque_factor_std": std.torque_factor.to_f64(),
        "angles": flat(&[angles.as_flattened()]), "torques": torques,
    });
    table.add("estimate", given, result);
}

/// Parameters of one recording, and by a regression of two. Python identifies those of the two.
fn identification(table: &mut Table) {
    let (angles, torques) = motion(500, 1.0);
    let samples = angles.iter().zip(&torques).map(|(angles, torque)| Sample {
        angles: angles.map(f64::from),
        torques: [0.0, f64::from(*torque)],
    });
    let samples: Vec<Sample> = samples.collect();
    let (one, two) = samples.split_at(250);
    let drawn: Params = MACHINE.cast::<f32>().cast(); // C has no others
    let [half, window] = [3, 50];
    let mut regression = Regression::EMPTY;
    for samples in [one, two] {
        regression.add(samples, drawn.dt, drawn.gravity, half, window).unwrap();
    }
    let (of_one, _) = identify(&[&samples], drawn).unwrap();
    let (of_both, found) = identify(&[one, two], drawn).unwrap();
    let fit = regression.fit();
    let all = |fit: &Fit| [fit.values, fit.std_errors, fit.weakest].concat();
    let identified = [all(&found), numbers(&of_both)].concat();
    let calibration = calibrate(&samples, drawn).unwrap();
    let Calibration { zeros: [zero1, zero2], delay, prediction_error, angle_noise, .. } =
        calibration;
    let calibrated = vec![zero1, zero2, delay, prediction_error, angle_noise];
    let calibrated = [calibrated, all(&calibration.fit)].concat();
    let given = json!({
        "params": numbers(&drawn), "angles": flat(&[angles.as_flattened()]), "torques": torques,
        "first": one.len(), "half": half, "window": window, "fit": all(&fit),
        "identified": identified, "calibrated": calibrated,
    });
    let results = [of_one, fit.params(drawn).unwrap(), calibration.params];
    let results = results.map(|params| numbers(&params.cast::<f32>()));
    table.add("identify", given, results.concat());
}

/// From encoder counts to torques.
fn mpc(table: &mut Table) {
    let settings = Settings {
        params: MACHINE.cast(),
        limit: LIMIT,
        counts: [4096, 1024],
        delay: 0.0625,
        plan_timeout: 1.5,
    };
    let mut controller = Controller::<100>::new(settings).unwrap();
    let mut replanner = Replanner::new(settings).unwrap();
    let mut machine = Pendulum::<Damped<Fast>>::new(MACHINE.cast(), MOVING.cast()).unwrap();
    let (mut counts, mut torques) = (Vec::new(), Vec::new());
    for tick in 0..60 {
        let State { theta1, theta2, .. } = machine.state();
        let now = [(theta1 / TAU * 4096.0) as i32, (theta2 / TAU * 1024.0) as i32];
        let torque = controller.tick(now).unwrap();
        machine.step(torque).unwrap();
        counts.extend(now);
        torques.push(torque);
        if tick % 20 == 0 {
            replanner.exchange(&mut controller);
            replanner.work();
        }
    }
    let Report { zeros: [zero1, zero2], torque_factor, misses, plan_age } = controller.report();
    torques.extend([zero1, zero2, torque_factor, misses, plan_age]);
    let given = json!({
        "params": numbers(&settings.params), "limit": LIMIT, "per_turn": settings.counts,
        "delay": settings.delay, "plan_timeout": settings.plan_timeout, "every": 20,
        "counts": counts,
    });
    table.add("control", given, torques);
}

#[test]
fn other_languages_get_these_results() {
    let mut table = Table::default();
    episodes(&mut table);
    instruments(&mut table);
    models::<Damped<Fast>>(&mut table);
    models::<Damped<Portable>>(&mut table);
    plans(&mut table);
    estimates::<Damped<Fast>>(&mut table);
    estimates::<Damped<Portable>>(&mut table);
    identification(&mut table);
    mpc(&mut table);
    common::assert_snapshot("results.jsonl", &table.0);
}
