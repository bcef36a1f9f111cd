//! Control of a machine, without a plan that is long, and digests of all results.

use core::f32::consts::TAU;

use acrobot::arithmetic::Damped;
use acrobot::control::estimate::{Estimator, Noise, ParameterEstimator, ParameterStd};
use acrobot::control::identify::{Fit, Regression, Sample, identify, prediction_error};
use acrobot::control::model::{Forces, LinearModel, StepModel};
use acrobot::control::mpc::{Controller, Replanner, Settings};
use acrobot::control::plan::Problem;
use acrobot::control::regulator::{Lqr, dlqr, lqr, tvlqr};
use acrobot::physics::Pendulum;
use acrobot::{Error, Fast, Params, State};

use crate::Digest;

type Machine = Pendulum<Damped<Fast>>;

const PARAMS: Params<f32> = Params {
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
    ..Params::<f32>::DEFAULT
};
const MOVING: State<f32> = State { theta1: 0.1, theta2: -0.2, dtheta1: 0.3, dtheta2: -0.4 };
const Q: [[f32; 4]; 4] =
    [[2.0, 0.5, 0.0, 0.0], [0.5, 1.0, 0.0, 0.0], [0.0, 0.0, 0.1, 0.0], [0.0, 0.0, 0.0, 0.1]];
const R: f32 = 0.5;
/// The largest torque, N m, and the samples of a recording.
const LIMIT: f32 = 6.0;
const SAMPLES: usize = 800;

impl Digest {
    fn add_singles(&mut self, numbers: &[f32]) {
        numbers.iter().for_each(|x| self.add(x.to_bits().into()));
    }

    fn add_doubles(&mut self, numbers: &[f64]) {
        numbers.iter().for_each(|x| self.add(x.to_bits()));
    }

    fn add_state(&mut self, state: State<f32>) {
        self.add_singles(&<[f32; 4]>::from(state));
    }

    fn add_params(&mut self, params: &Params<f32>) {
        self.add_singles(&params.numbers().map(|(_, number)| number));
    }

    fn add_lqr(&mut self, Lqr { gain, cost_to_go }: Lqr<f32>) {
        self.add_singles(&gain);
        self.add_singles(cost_to_go.as_flattened());
    }
}

/// N m.
fn torque(tick: usize) -> f32 {
    if tick % 50 < 25 { 0.5 } else { -0.4 }
}

fn models() -> Result<u64, Error> {
    let mut digest = Digest::default();
    let machine = Machine::new(PARAMS, MOVING)?;
    digest.add_singles(&machine.derivative(0.5));
    digest.add_singles(machine.mass_matrix().as_flattened());
    let Forces { torques, reaction, elbow } = machine.inverse_dynamics([1.0, -2.0])?;
    digest.add_singles([torques, reaction, elbow].as_flattened());
    let LinearModel { a, b } = machine.linearize(0.5)?;
    digest.add_singles(a.as_flattened());
    digest.add_singles(&b);
    let StepModel { a, b } = machine.linearize_step(0.5)?;
    digest.add_singles(a.as_flattened());
    digest.add_singles(&b);

    let Problem { target, torque, .. } = Problem::balance::<Damped<Fast>>(PARAMS, LIMIT, 1.0)?;
    let bent = Machine::new(PARAMS, target)?;
    digest.add_lqr(bent.regulator(torque, &Q, R)?);
    digest.add_lqr(lqr(&bent.linearize(torque)?, &Q, R)?);
    let model = bent.linearize_step(torque)?;
    digest.add_lqr(dlqr(&model, &Q, R)?);
    let mut gains = [[0.0; 4]; 3];
    digest.add_singles(tvlqr(&[model; 3], &Q, R, &Q, &mut gains)?.as_flattened());
    digest.add_singles(gains.as_flattened());
    Ok(digest.0)
}

fn estimates() -> Result<u64, Error> {
    let mut digest = Digest::default();
    let noise = Noise { angle_std: 1e-3, torque_std: 0.05 };
    let std = ParameterStd { mass2: 0.1, coulomb2: 0.02, ..ParameterStd::default() };
    let mut machine = Machine::new(PARAMS, MOVING)?;
    let mut state = Estimator::<Damped<Fast>>::new(PARAMS, noise)?;
    let mut both = ParameterEstimator::<Damped<Fast>>::new(PARAMS, std, noise)?;
    for tick in 0..200 {
        let State { theta1, theta2, .. } = machine.state();
        machine.step(torque(tick))?;
        state.correct([theta1, theta2])?;
        state.predict(torque(tick))?;
        both.correct([theta1, theta2])?;
        both.predict(torque(tick) + 0.1)?;
    }
    digest.add_state(state.state());
    digest.add_singles(&state.state_std().unwrap_or_default());
    digest.add_state(both.state());
    digest.add_singles(&both.state_std().unwrap_or_default());
    digest.add_params(both.params());
    Ok(digest.0)
}

fn identification() -> Result<u64, Error> {
    let mut digest = Digest::default();
    let mut machine = Machine::new(PARAMS, MOVING)?;
    let mut samples = [Sample::default(); SAMPLES];
    for (tick, sample) in samples.iter_mut().enumerate() {
        let State { theta1, theta2, .. } = machine.state();
        *sample = Sample {
            angles: [theta1.into(), theta2.into()],
            torques: [0.0, torque(tick / 3).into()],
        };
        machine.step(torque(tick / 3))?;
    }
    let given = PARAMS.cast();
    let mut regression = Regression::EMPTY;
    regression.add(&samples, 0.005, 9.8, 2, 100)?;
    let fit = regression.fit();
    let Fit { values, std_errors, rank_deficiency, weakest } = fit;
    digest.add_doubles([values, std_errors, weakest].as_flattened());
    digest.add(rank_deficiency as u64);
    digest.add_params(&fit.params(given)?.cast());
    digest.add_params(&identify(&[&samples], given)?.0.cast());
    digest.add_doubles(&[prediction_error(given, &samples, 200)?]);
    Ok(digest.0)
}

fn mpc() -> Result<u64, Error> {
    let mut digest = Digest::default();
    let settings = Settings { params: PARAMS, limit: LIMIT, counts: [4096, 4096], ticks: 5 };
    let mut controller = Controller::<100>::new(settings)?;
    let mut replanner = Replanner::new(settings)?;
    let mut machine = Machine::new(PARAMS, MOVING)?;
    for tick in 0..200 {
        let State { theta1, theta2, .. } = machine.state();
        let counts = [theta1, theta2].map(|angle| (angle / TAU * 4096.0) as i32);
        let torque = controller.tick(counts)?;
        digest.add_singles(&[torque]);
        machine.step(torque)?;
        if tick % 20 == 0 {
            replanner.exchange(&mut controller);
            replanner.work();
        }
    }
    digest.add_state(controller.state());
    digest.add_params(controller.params());
    Ok(digest.0)
}

/// Models and regulators, estimates, identification, and model-predictive control; 0 for an error.
pub fn digests() -> [u64; 4] {
    [models(), estimates(), identification(), mpc()].map(|digest| digest.unwrap_or_default())
}

pub const CONTROL: [u64; 4] =
    [0x10e5_9b3f_0c44_b049, 0xc759_cd5e_a100_19c7, 0xd4d4_b914_7a72_2d51, 0xe830_0a7e_90be_4113];
