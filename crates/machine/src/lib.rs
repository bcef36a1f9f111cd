//! A simulated machine with encoders and a motor, to rehearse with: what the real one would count.
#![no_std]
#![forbid(unsafe_code)]

use core::f64::consts::TAU;

use acrobot::arithmetic::{Arithmetic, Real as _};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::Pendulum;
use acrobot::{Error, Params, State};

/// The most ticks of a delay.
pub const MOST_DELAY: usize = 64;

/// A machine that hangs at rest.
#[derive(Clone, Debug)]
pub struct Machine<A: Arithmetic> {
    pendulum: Pendulum<A>,
    counts: [i32; 2],
    /// The last torques, N m, from the one that acts next, and how many of them wait.
    waiting: [f32; MOST_DELAY],
    delay: usize,
    noise: f64,
    rng: Pcg64,
}

impl<A: Arithmetic> Machine<A> {
    /// A machine with these parameters, whose `dt` is the time of a tick, and encoders with so many
    /// counts a turn. A torque acts `delay` ticks late, and errs by a standard deviation of
    /// `noise`, N m. The seed draws the errors and the first angles, of up to 0.05 rad.
    ///
    /// # Errors
    ///
    /// A parameter is out of range, or the delay is longer than [`MOST_DELAY`].
    pub fn new(
        params: Params,
        counts: [i32; 2],
        delay: usize,
        noise: f64,
        seed: u64,
    ) -> Result<Self, Error> {
        if delay > MOST_DELAY {
            let (value, rule) = (delay as f64, "at most 64");
            return Err(Error::OutOfRange { name: "delay", value, unit: "ticks", rule });
        }
        let mut rng = Pcg64::new(seed);
        let [theta1, theta2] = [(); 2].map(|()| uniform(&mut rng, -0.05, 0.05));
        let start = State { theta1, theta2, ..State::HANGING };
        let pendulum = Pendulum::new(params.cast(), start.cast())?;
        Ok(Self { pendulum, counts, waiting: [0.0; MOST_DELAY], delay, noise, rng })
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
        let [count1, count2] = self.counts;
        [(theta1, count1), (theta2, count2)].map(|(angle, counts)| {
            let count = angle.to_f64() / TAU * f64::from(counts);
            (count + 0.5_f64.copysign(count)) as i32
        })
    }

    /// The larger deviation of both true angles from upright, rad.
    #[must_use]
    pub fn lean(&self) -> f64 {
        let state = self.pendulum.state().cast::<f64>();
        let [theta1, theta2, ..] = state.deviation_from(State::UPRIGHT);
        theta1.abs().max(theta2.abs())
    }

    /// Takes a tick with a torque, N m.
    ///
    /// # Errors
    ///
    /// The torque that acts is not finite.
    pub fn step(&mut self, torque: f32) -> Result<(), Error> {
        let mut acting = torque;
        for waiting in self.waiting.iter_mut().take(self.delay).rev() {
            core::mem::swap(waiting, &mut acting);
        }
        // Uniform, with this standard deviation.
        let most = 1.73 * self.noise;
        let error = uniform(&mut self.rng, -most, most);
        self.pendulum.step(A::Scalar::from_f64(f64::from(acting) + error))
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

/// RealAIGym's acrobot, design_C.1, with ticks of 2 ms: a motor of 6 N m, Coulomb friction and a
/// rotor.
#[must_use]
pub fn realaigym() -> Params {
    Params {
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
    }
    .with_inertias_about_joints([0.031887199591513114, 0.05086984812807257])
    .with_rotor(6.287203962819607e-5, 6.0)
}
