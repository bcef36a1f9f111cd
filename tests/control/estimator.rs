//! A filter finds velocities and parameters from angles alone.

use std::f64::consts::TAU;

use acrobot::arithmetic::{Arithmetic, Damped, Real};
use acrobot::control::estimate::{
    Estimator, KalmanFilter, Noise, ParameterEstimator, ParameterStd,
};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::Pendulum;
use acrobot::{Fast, Params, Portable, State};

/// RealAIGym's machine, with its motor's friction.
pub fn real() -> Params {
    let params = Params {
        length1: 0.2,
        length2: 0.3,
        mass1: 0.523,
        mass2: 0.626,
        center_of_mass1: 0.2,
        center_of_mass2: 0.256,
        gravity: 9.81,
        dt: 0.002,
        max_velocity1: f64::INFINITY,
        max_velocity2: f64::INFINITY,
        damping1: 0.001,
        damping2: 0.001,
        coulomb1: 0.16,
        coulomb2: 0.12,
        ..Params::DEFAULT
    };
    params.with_inertias_about_joints([0.0319, 0.0509]).with_rotor(6.29e-5, 6.0)
}

const COUNTS: f64 = 4096.0;

fn noise<S: Real>() -> Noise<S> {
    Noise { angle_std: S::from_f64(1.8 / COUNTS), torque_std: S::from_f64(0.05) }
}

/// A simulated machine with encoders, whose motor errs.
pub struct Machine {
    pub pendulum: Pendulum<Damped<Portable>>,
    rng: Pcg64,
}

impl Machine {
    pub fn new(params: Params, seed: u64) -> Self {
        Self { pendulum: Pendulum::new(params, State::HANGING).unwrap(), rng: Pcg64::new(seed) }
    }

    /// The angles to the next count.
    pub fn angles(&self) -> [f64; 2] {
        let State { theta1, theta2, .. } = self.pendulum.state();
        [theta1, theta2].map(|x| (x / TAU * COUNTS).round() / COUNTS * TAU)
    }

    pub fn step(&mut self, torque: f64) {
        let noise = uniform(&mut self.rng, -0.035, 0.035); // 0.02 N m
        self.pendulum.step(torque + noise).unwrap();
    }
}

/// Follows a machine for ten seconds, under random torques of up to 3 N m, each for a quarter of a
/// second. Calls `check` after each measurement.
fn follow<A: Arithmetic, const K: usize>(
    estimator: &mut KalmanFilter<A, K>,
    mut machine: Machine,
    rng: &mut Pcg64,
    mut check: impl FnMut(u32, &KalmanFilter<A, K>, State),
) {
    let mut torque = 0.0;
    for tick in 0..5000_u32 {
        if tick.is_multiple_of(125) {
            torque = uniform(rng, -3.0, 3.0);
        }
        estimator.correct(machine.angles().map(A::Scalar::from_f64)).unwrap();
        check(tick, estimator, machine.pendulum.state());
        estimator.predict(A::Scalar::from_f64(torque)).unwrap();
        machine.step(torque);
    }
}

/// The root of the mean square of the errors of both velocities, rad/s, and the part of the errors
/// that are within two standard deviations.
fn errors<A: Arithmetic>() -> (f64, f64) {
    let mut estimator = Estimator::<A>::new(real().cast(), noise()).unwrap();
    let (mut squares, mut within, mut count) = (0.0, 0.0, 0.0);
    let machine = Machine::new(real(), 1);
    follow(&mut estimator, machine, &mut Pcg64::new(2), |tick, estimator, truth| {
        if tick > 100 {
            let errors = estimator.state().cast::<f64>().deviation_from(truth);
            for (error, deviation) in errors.iter().zip(estimator.state_std().unwrap()).skip(2) {
                squares += error * error;
                within += f64::from(u8::from(error.abs() < 2.0 * deviation.to_f64()));
                count += 1.0;
            }
        }
    });
    (f64::sqrt(squares / count), within / count)
}

#[test]
fn velocities_follow_from_angles() {
    for (error, within) in [errors::<Damped<Portable>>(), errors::<Damped<Fast>>()] {
        assert!(error < 0.05 && within > 0.9, "{error} rad/s, {within}");
    }
}

/// A push changes both velocities at once.
#[test]
fn a_push_is_noticed_within_a_fiftieth_of_a_second() {
    let mut estimator = Estimator::<Damped<Portable>>::new(real(), noise()).unwrap();
    let mut machine = Machine::new(real(), 1);
    for tick in 0..520 {
        if tick == 500 {
            let state = machine.pendulum.state();
            let pushed =
                State { dtheta1: state.dtheta1 + 3.0, dtheta2: state.dtheta2 - 5.0, ..state };
            machine.pendulum.set_state(pushed).unwrap();
        }
        estimator.correct(machine.angles()).unwrap();
        if tick == 510 || tick == 499 {
            let [_, _, error1, error2] = estimator.state().deviation_from(machine.pendulum.state());
            assert!(error1.abs().max(error2.abs()) < 0.3, "{tick}: {error1} {error2} rad/s");
        }
        estimator.predict(0.0).unwrap();
        machine.step(0.0);
    }
}

/// The inertias of the whole arm, of link 2 and what couples them, and both moments of gravity.
pub fn base(params: &Params) -> [f64; 5] {
    let Params { mass1, mass2, length1, center_of_mass1: lc1, center_of_mass2: lc2, .. } = *params;
    let upper = params.inertia1 + mass1 * lc1 * lc1 + mass2 * length1 * length1;
    let link2 = params.inertia2 + mass2 * lc2 * lc2;
    [upper, link2, mass2 * length1 * lc2, mass1 * lc1 + mass2 * length1, mass2 * lc2]
}

#[test]
fn ten_seconds_of_motion_tell_the_parameters() {
    fn check<A: Arithmetic>() -> f64 {
        let mut worst = 0.0_f64;
        for seed in 0..5 {
            let mut rng = Pcg64::new(10 + seed);
            let mut wrong = |x: f64| x * (1.0 + uniform(&mut rng, -0.1, 0.1));
            let truth = real();
            let given = Params {
                mass1: wrong(truth.mass1),
                mass2: wrong(truth.mass2),
                inertia1: wrong(truth.inertia1),
                inertia2: wrong(truth.inertia2),
                rotor: 0.0,
                damping1: 0.0,
                damping2: 0.0,
                coulomb1: wrong(0.16),
                coulomb2: wrong(0.12),
                ..truth
            };
            let number = A::Scalar::from_f64;
            let std = ParameterStd {
                mass1: number(0.05),
                mass2: number(0.05),
                inertia1: number(0.002),
                inertia2: number(0.002),
                rotor: number(0.003),
                damping1: number(0.01),
                damping2: number(0.01),
                coulomb1: number(0.02),
                coulomb2: number(0.02),
                ..ParameterStd::default()
            };
            let mut estimator = ParameterEstimator::<A>::new(given.cast(), std, noise()).unwrap();
            follow(&mut estimator, Machine::new(truth, seed), &mut rng, |_, _, _| {});
            let found = estimator.params().cast::<f64>();
            for (found, truth) in base(&found).into_iter().zip(base(&truth)) {
                worst = worst.max((found / truth - 1.0).abs());
            }
        }
        worst
    }
    let errors = [check::<Damped<Portable>>(), check::<Damped<Fast>>()];
    assert!(errors.iter().all(|error| *error < 0.001), "{errors:?}");
}

/// 10 to a power between these.
fn decades(rng: &mut Pcg64, low: f64, high: f64) -> f64 {
    (uniform(rng, low, high) * f64::ln(10.0)).exp()
}

/// A machine like RealAIGym's of another size, mass and rate.
fn random(rng: &mut Pcg64) -> Params {
    let mut decades = |low, high| decades(rng, low, high);
    let (length, mass) = (decades(-1.5, 1.5), decades(-2.0, 2.0));
    let time = f64::sqrt(length);
    scaled(&Params { dt: 0.002 * decades(-1.0, 1.5), ..real() }, length, mass, time)
}

/// Lengths × a, masses × b and times × √a: in its own units the machine is the same.
pub fn scaled(params: &Params, a: f64, b: f64, time: f64) -> Params {
    let (inertia, torque) = (a * a * b, a * b);
    Params {
        length1: params.length1 * a,
        length2: params.length2 * a,
        mass1: params.mass1 * b,
        mass2: params.mass2 * b,
        center_of_mass1: params.center_of_mass1 * a,
        center_of_mass2: params.center_of_mass2 * a,
        inertia1: params.inertia1 * inertia,
        inertia2: params.inertia2 * inertia,
        dt: params.dt * time,
        damping1: params.damping1 * (torque * time),
        damping2: params.damping2 * (torque * time),
        coulomb1: params.coulomb1 * torque,
        coulomb2: params.coulomb2 * torque,
        rotor: params.rotor * inertia,
        ..*params
    }
}

/// Whatever an estimator was told, it follows the machine after good measurements.
fn lives_on<A: Arithmetic>() {
    let mut rng = Pcg64::new(7);
    for i in 0..400 {
        let mut params = random(&mut rng);
        (params.coulomb1, params.coulomb2) = (0.0, 0.0);
        let limit = 9.81 * params.mass2 * params.length2;
        let angle = decades(&mut rng, -5.0, -2.5);
        let torque = limit * decades(&mut rng, -4.0, -1.0);
        let [of_angle, of_torque] = [angle, torque].map(A::Scalar::from_f64);
        let noise = Noise { angle_std: of_angle, torque_std: of_torque };
        let mut estimator = Estimator::<A>::new(params.cast(), noise).unwrap();
        for _ in 0..i % 20 {
            let size = decades(&mut rng, -3.0, if i % 2 == 0 { 1.0 } else { 25.0 });
            let mut any = || A::Scalar::from_f64(uniform(&mut rng, -size, size));
            let (angles, torque) = ([any(), any()], any());
            estimator.correct(angles).unwrap();
            if size < 1.0 {
                estimator.correct(angles).unwrap();
            }
            let _ = estimator.predict(torque);
        }
        let mut machine = Machine::new(params, i);
        let mut worst = 0.0_f64;
        let start = State::from([0.0; 4].map(|_: f64| uniform(&mut rng, -2.0, 2.0)));
        machine.pendulum.set_state(State { dtheta1: 0.0, dtheta2: 0.0, ..start }).unwrap();
        for tick in 0..1000 {
            let State { theta1, theta2, .. } = machine.pendulum.state();
            let angles = [theta1, theta2].map(|x| x + angle * uniform(&mut rng, -1.7, 1.7));
            estimator.correct(angles.map(A::Scalar::from_f64)).unwrap();
            if tick > 800 {
                let [error1, error2, ..] =
                    estimator.state().cast().deviation_from(machine.pendulum.state());
                worst = worst.max(error1.abs()).max(error2.abs());
            }
            let step = estimator.predict(A::Scalar::ZERO);
            assert!(tick < 100 || step.is_ok(), "{i}: {step:?}");
            machine.pendulum.step(0.0).unwrap();
        }
        assert!(worst < 5.0 * angle + 1e-4, "{i}: {worst} rad, {angle} {params:?}");
    }
}

#[test]
fn an_estimator_lives_on_after_any_measurements_and_torques() {
    lives_on::<Damped<Fast>>();
    lives_on::<Damped<Portable>>();
}

/// The law of scale, bit for bit: lengths × 1/4 and 16, masses × 1/2 and 8.
#[test]
fn a_machine_of_another_size_is_estimated_alike() {
    // The width of Coulomb friction has a unit.
    let given = Params { coulomb1: 0.0, coulomb2: 0.0, ..real() };
    let found = |a: f64, b: f64| {
        let time = a.sqrt();
        let noise = Noise { angle_std: 4e-4, torque_std: 0.05 * a * b };
        let (machine, inertia) = (scaled(&given, a, b, time), a * a * b);
        let std = ParameterStd {
            mass1: 0.05 * b,
            mass2: 0.05 * b,
            length1: 0.01 * a,
            inertia1: 0.002 * inertia,
            inertia2: 0.002 * inertia,
            rotor: 0.003 * inertia,
            damping1: 0.01 * (a * b * time),
            damping2: 0.01 * (a * b * time),
            ..ParameterStd::default()
        };
        let wrong = Params { mass2: 1.1 * machine.mass2, ..machine };
        let mut estimator = ParameterEstimator::<Damped<Portable>>::new(wrong, std, noise).unwrap();
        let mut machine = Machine::new(machine, 1);
        for tick in 0..500 {
            let torque = if tick / 100 % 2 == 0 { 2.0 } else { -1.0 } * a * b;
            estimator.correct(machine.angles()).unwrap();
            estimator.predict(torque).unwrap();
            machine.pendulum.step(torque).unwrap();
        }
        let State { theta1, theta2, dtheta1, dtheta2 } = estimator.state();
        let units = [1.0, 1.0, time.recip(), time.recip()];
        let deviations = estimator.state_std().unwrap().into_iter().zip(units);
        let state = [theta1, theta2, dtheta1 * time, dtheta2 * time];
        (
            state,
            deviations.map(|(x, unit)| x / unit).collect::<Vec<_>>(),
            estimator.params().mass2 / b,
        )
    };
    let first = found(1.0, 1.0);
    for (a, b) in [(0.25, 8.0), (16.0, 0.5), (1.0 / 1024.0, 1.0 / 64.0)] {
        assert_eq!(found(a, b), first);
    }
}

#[test]
fn bad_noise_and_angles_are_rejected() {
    let error = |noise| Estimator::<Fast>::new(Params::DEFAULT, noise).unwrap_err().to_string();
    let angle = error(Noise { angle_std: 0.0, torque_std: 1.0 });
    assert_eq!(angle, "angle_std must be above 0 and at most 2 rad, got 0");
    let torque = error(Noise { angle_std: 1e-3, torque_std: f32::NAN });
    assert_eq!(torque, "torque_std must be finite and above 0 N m, got NaN");
    let torque = error(Noise { angle_std: 1e-3, torque_std: 1e7 });
    let rule =
        "torque_std must be so small that a step changes dtheta2 by at most 1 / dt, in N m, got ";
    assert_eq!(torque, format!("{rule}10000000"));
    // A circle tells no more than 2 rad. With the default parameters 14.2 N m are 25 rad/s², and a
    // step has 0.2 s.
    assert!(error(Noise { angle_std: 2.5, torque_std: 1.0 }).ends_with("at most 2 rad, got 2.5"));
    let of = |angle_std, torque_std| {
        Estimator::<Fast>::new(Params::DEFAULT, Noise { angle_std, torque_std })
    };
    assert!(of(2.0, 14.2).is_ok() && of(2.0, 14.3).is_err() && of(1e-30, 1e-30).is_ok());

    let noise = Noise { angle_std: 1e-3, torque_std: 0.1 };
    let mut estimator = Estimator::<Fast>::new(Params::DEFAULT, noise).unwrap();
    let error = estimator.correct([f32::NAN, 0.0]).unwrap_err().to_string();
    assert_eq!(error, "theta1 must be a finite number of rad, got NaN");
    assert!(estimator.predict(f32::INFINITY).is_err());
}

/// An overflow is an error, and the next measurement begins again.
#[test]
fn an_estimate_that_overflows_is_an_error() {
    let noise = Noise { angle_std: 1e-3, torque_std: 0.1 };
    let std = ParameterStd { mass2: 1e30, length1: 1.0, ..ParameterStd::default() };
    let mut estimator = ParameterEstimator::<Fast>::new(Params::DEFAULT, std, noise).unwrap();
    estimator.correct([0.1, 0.2]).unwrap();
    let error = estimator.predict(0.0).unwrap_err().to_string();
    assert_eq!(error, "covariances must be finite in each element, got inf");
    assert_eq!(estimator.state_std(), None);
    estimator.correct([0.3, 0.4]).unwrap();
    assert_eq!(estimator.state(), State::from([0.3, 0.4, 0.0, 0.0]));

    let mut estimator = Estimator::<Fast>::new(Params::DEFAULT, noise).unwrap();
    estimator.correct([0.1, 0.2]).unwrap();
    let error = estimator.predict(1e6).unwrap_err().to_string();
    assert!(error.starts_with("dtheta2 must be at most half a turn in a step, in rad/s, got "));
    assert_eq!(estimator.state_std(), None);
}
