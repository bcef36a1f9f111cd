//! A simulated machine with encoders, for rehearsals.

use core::f64::consts::TAU;

use acrobot::arithmetic::{Arithmetic, Real as _};
use acrobot::control::difference;
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::Pendulum;
use acrobot::{Error, Params, State};

/// RealAIGym's acrobot, design_C.1, with a motor of 6 N m: encoders of 4,096 counts, Coulomb
/// friction of 0.16 and 0.12 N m, a rotor, and a motor whose torque errs by 0.02 N m.
#[derive(Clone, Debug)]
pub struct Machine<A: Arithmetic> {
    pendulum: Pendulum<A>,
    rng: Pcg64,
}

impl<A: Arithmetic> Machine<A> {
    /// A machine that hangs at rest, with angles of up to 0.05 rad, and takes steps of 2 ms.
    ///
    /// # Errors
    ///
    /// The arithmetic has no friction.
    pub fn new(seed: u64) -> Result<Self, Error> {
        let mut rng = Pcg64::new(seed);
        let [theta1, theta2] = [(); 2].map(|()| uniform(&mut rng, -0.05, 0.05));
        let start = State { theta1, theta2, ..State::HANGING };
        let params = Params {
            length1: 0.2,
            length2: 0.3,
            mass1: 0.5234602302310271,
            mass2: 0.6255677234174437,
            center_of_mass1: 0.2,
            center_of_mass2: 0.25569305436052964,
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
        let params = params
            .with_inertias_about_joints([0.031887199591513114, 0.05086984812807257])
            .with_rotor(6.287203962819607e-5, 6.0);
        Ok(Self { pendulum: Pendulum::new(params.cast(), start.cast())?, rng })
    }

    /// The true parameters.
    #[must_use]
    pub fn params(&self) -> Params {
        self.pendulum.params().cast()
    }

    /// What both encoders count.
    #[must_use]
    pub fn counts(&self) -> [i32; 2] {
        let State { theta1, theta2, .. } = self.pendulum.state();
        [theta1, theta2].map(|angle| {
            let count = angle.to_f64() / TAU * 4096.0;
            (count + 0.5_f64.copysign(count)) as i32
        })
    }

    /// The larger deviation of both true angles from upright, rad.
    #[must_use]
    pub fn lean(&self) -> f64 {
        let [theta1, theta2, ..] = difference(self.pendulum.state().cast::<f64>(), State::UPRIGHT);
        theta1.abs().max(theta2.abs())
    }

    /// Takes a step with a torque, N m.
    ///
    /// # Errors
    ///
    /// The torque is not finite.
    pub fn step(&mut self, torque: f32) -> Result<(), Error> {
        // Uniform, with a standard deviation of 0.02 N m.
        let error = uniform(&mut self.rng, -0.0346, 0.0346);
        self.pendulum.step(A::Scalar::from_f64(f64::from(torque) + error))
    }

    /// Changes both velocities at random, by up to so many rad/s.
    ///
    /// # Errors
    ///
    /// A velocity is not finite.
    pub fn push(&mut self, most: f64) -> Result<(), Error> {
        let mut state = self.pendulum.state().cast::<f64>();
        state.dtheta1 += uniform(&mut self.rng, -most, most);
        state.dtheta2 += uniform(&mut self.rng, -most, most);
        self.pendulum.set_state(state.cast())
    }
}
