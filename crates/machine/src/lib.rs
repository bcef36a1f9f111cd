//! Simulated machines with encoders and a motor, to rehearse with: what the real ones would count.
//!
//! The equations are not those of the crate. Each tick is integrated in steps of at most 0.1 ms,
//! and dry friction is an impulse that can stop a joint, so that a link sticks.
#![no_std]
#![forbid(unsafe_code)]

mod random;
mod rehearsal;
mod shaker;

use core::f64::consts::TAU;

use acrobot::numpy::{Pcg64, uniform};
use acrobot::{Error, Params, State};

pub use random::{Random, least_torque};
pub use rehearsal::Rehearsal;
pub use shaker::Shaker;

/// The longest step of the integration, s.
const STEP: f64 = 1e-4;
/// Dry friction at rest is larger than in motion by this part, which falls off within a velocity,
/// rad/s.
const STICTION: f64 = 0.2;
const STRIBECK: f64 = 0.05;
/// Torques that wait for their time.
const WAITING: usize = 64;

/// A machine as it is, with what its builder does not know.
#[derive(Clone, Copy, Debug)]
pub struct Hardware {
    /// The true parameters, whose `dt` is the time of a tick.
    pub params: Params,
    /// The motor's largest torque, N m.
    pub limit: f64,
    /// The counts of each encoder for a turn.
    pub counts: [i32; 2],
    /// What the encoders say where the angles are 0, rad.
    pub zeros: [f64; 2],
    /// From a torque that is sent until the motor begins to follow it, s.
    pub delay: f64,
    /// The time constant with which the motor follows, s.
    pub lag: f64,
    /// The torque that acts, divided by the one that is sent.
    pub torque_factor: f64,
    /// The standard deviation of the torque from tick to tick, N m.
    pub torque_std: f64,
}

impl Hardware {
    /// RealAIGym's acrobot, design_C.1, with ticks of 2 ms: a motor of 6 N m, dry friction and a
    /// rotor. Encoders of 4,096 counts for a turn; no delay.
    #[must_use]
    pub fn realaigym() -> Self {
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
        Self {
            params: params
                .with_inertias_about_joints([0.031887199591513114, 0.05086984812807257])
                .with_rotor(6.287203962819607e-5, 6.0),
            limit: 6.0,
            counts: [4096, 4096],
            zeros: [0.0; 2],
            delay: 0.0,
            lag: 0.0,
            torque_factor: 1.0,
            torque_std: 0.02,
        }
    }
}

/// A machine that moves.
#[derive(Clone, Debug)]
pub struct Machine {
    hardware: Hardware,
    /// θ1, θ2, rad, and their velocities, rad/s.
    state: [f64; 4],
    /// The torque that acts, N m.
    torque: f64,
    /// The last torques that were sent, from the latest.
    sent: [f64; WAITING],
    rng: Pcg64,
}

impl Machine {
    /// A machine that hangs at rest. The seed draws the errors of the torque and the first angles,
    /// of up to 0.05 rad.
    ///
    /// # Errors
    ///
    /// A parameter is out of range, or the delay is longer than 63 ticks.
    pub fn new(hardware: Hardware, seed: u64) -> Result<Self, Error> {
        hardware.params.validate()?;
        let (value, rule) = (hardware.delay / hardware.params.dt, "at least 0 and at most 63");
        if !(0.0..=(WAITING - 1) as f64).contains(&value) {
            return Err(Error::OutOfRange { name: "delay", value, unit: "ticks", rule });
        }
        let mut rng = Pcg64::new(seed);
        let [theta1, theta2] = [(); 2].map(|()| uniform(&mut rng, -0.05, 0.05));
        let (state, sent) = ([theta1, theta2, 0.0, 0.0], [0.0; WAITING]);
        Ok(Self { hardware, state, torque: 0.0, sent, rng })
    }

    /// The machine as it is.
    #[must_use]
    pub fn hardware(&self) -> &Hardware {
        &self.hardware
    }

    /// What both encoders count: the floor of the angle.
    #[must_use]
    pub fn counts(&self) -> [i32; 2] {
        let Hardware { counts, zeros, .. } = self.hardware;
        let [theta1, theta2, ..] = self.state;
        [(theta1 + zeros[0], counts[0]), (theta2 + zeros[1], counts[1])]
            .map(|(angle, counts)| libm::floor(angle / TAU * f64::from(counts)) as i32)
    }

    /// The true state.
    #[must_use]
    pub fn state(&self) -> State {
        State::from(self.state)
    }

    /// Puts the machine into a state.
    pub fn set_state(&mut self, state: State) {
        self.state = state.into();
    }

    /// The larger deviation of both true angles from upright, rad.
    #[must_use]
    pub fn lean(&self) -> f64 {
        let [theta1, theta2, ..] = self.state().deviation_from(State::UPRIGHT);
        theta1.abs().max(theta2.abs())
    }

    /// Changes both velocities, rad/s.
    pub fn push(&mut self, by: [f64; 2]) {
        let [.., v1, v2] = &mut self.state;
        *v1 += by[0];
        *v2 += by[1];
    }

    /// Sends a torque, N m, and takes a tick.
    pub fn step(&mut self, torque: f32) {
        let Hardware { params, limit, delay, lag, torque_factor, torque_std, .. } = self.hardware;
        self.sent.rotate_right(1);
        self.sent[0] = f64::from(torque).clamp(-limit, limit);
        // A uniform error with this standard deviation.
        let most = libm::sqrt(3.0) * torque_std;
        let error = uniform(&mut self.rng, -most, most);
        let steps = libm::ceil(params.dt / STEP);
        let dt = params.dt / steps;
        let keeps = if lag > 0.0 { libm::exp(-dt / lag) } else { 0.0 };
        for step in 0..steps as u32 {
            // How long ago the torque was sent that begins to act now, in ticks, rounded up.
            let ago = (delay - f64::from(step) * dt) / params.dt;
            let asked = self.sent[libm::ceil(ago - 1e-9).max(0.0) as usize] * torque_factor + error;
            self.torque = asked + (self.torque - asked) * keeps;
            self.advance(dt);
        }
    }

    /// The elements of the mass matrix, M11, M12 and M22, kg m².
    fn mass(&self, cos2: f64) -> [f64; 3] {
        let p = &self.hardware.params;
        let link1 = p.inertia1 + p.mass1 * p.center_of_mass1 * p.center_of_mass1;
        let link2 = p.inertia2 + p.mass2 * p.center_of_mass2 * p.center_of_mass2;
        let tip = p.mass2 * p.length1 * p.length1;
        let both = p.mass2 * p.length1 * p.center_of_mass2 * cos2;
        // The rotor is part of both inertias, and of their coupling once.
        let upper = link1 + tip + link2 + 2.0 * both - 2.0 * p.rotor;
        [upper, link2 + both - p.rotor, link2]
    }

    /// The velocities, and the accelerations by Lagrange's equations without dry friction.
    fn rates(&self, [theta1, theta2, v1, v2]: [f64; 4]) -> [f64; 4] {
        let p = &self.hardware.params;
        let (sin2, cos2) = libm::sincos(theta2);
        let [m11, m12, m22] = self.mass(cos2);
        let h = p.mass2 * p.length1 * p.center_of_mass2 * sin2;
        let moment1 = p.mass1 * p.center_of_mass1 + p.mass2 * p.length1;
        let weight2 = p.gravity * p.mass2 * p.center_of_mass2 * libm::sin(theta1 + theta2);
        let weight1 = p.gravity * moment1 * libm::sin(theta1) + weight2;
        let force1 = h * (2.0 * v1 * v2 + v2 * v2) - weight1 - p.damping1 * v1;
        let force2 = self.torque - h * v1 * v1 - weight2 - p.damping2 * v2;
        let determinant = m11 * m22 - m12 * m12;
        [
            v1,
            v2,
            (m22 * force1 - m12 * force2) / determinant,
            (m11 * force2 - m12 * force1) / determinant,
        ]
    }

    /// A step of Runge and Kutta's, and then the impulse of dry friction.
    fn advance(&mut self, dt: f64) {
        let plus = |slopes: [f64; 4], part: f64| {
            let mut state = self.state;
            state.iter_mut().zip(slopes).for_each(|(x, slope)| *x += part * slope);
            state
        };
        let k1 = self.rates(self.state);
        let k2 = self.rates(plus(k1, dt / 2.0));
        let k3 = self.rates(plus(k2, dt / 2.0));
        let k4 = self.rates(plus(k3, dt));
        let mut slopes = k1;
        for (i, slope) in slopes.iter_mut().enumerate() {
            *slope = (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0;
        }
        let [theta1, theta2, v1, v2] = plus(slopes, dt);
        let [m11, m12, m22] = self.mass(libm::cos(theta2));
        let determinant = m11 * m22 - m12 * m12;
        let most = |coulomb: f64, velocity: f64| {
            let slowness = velocity / STRIBECK;
            coulomb * dt * (1.0 + STICTION * libm::exp(-slowness * slowness))
        };
        let Params { coulomb1, coulomb2, .. } = self.hardware.params;
        let [most1, most2] = [most(coulomb1, v1), most(coulomb2, v2)];
        // Each impulse stops its joint, or is the largest: by the projected Gauss-Seidel method.
        let (mut impulse1, mut impulse2) = (0.0, 0.0);
        for _ in 0..6 {
            let free = v1 - m12 / determinant * impulse2;
            impulse1 = (-free * determinant / m22).clamp(-most1, most1);
            let free = v2 - m12 / determinant * impulse1;
            impulse2 = (-free * determinant / m11).clamp(-most2, most2);
        }
        let v1 = v1 + (m22 * impulse1 - m12 * impulse2) / determinant;
        let v2 = v2 + (m11 * impulse2 - m12 * impulse1) / determinant;
        self.state = [theta1, theta2, v1, v2];
    }
}
