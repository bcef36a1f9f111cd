//! Torques that tell what a machine is like.

use core::f64::consts::TAU;
use core::iter;

use acrobot::control::identify::Sample;
use acrobot::numpy::{Pcg64, uniform};

use crate::{Hardware, Machine};

/// Random torques, each held for 0.05 to 0.4 s.
#[derive(Clone, Debug)]
pub struct Shaker {
    rng: Pcg64,
    most: f64,
    dt: f64,
    torque: f32,
    /// How long the torque still holds, s.
    left: f64,
}

impl Shaker {
    /// Torques of up to `most`, N m. A tick takes `dt`, s.
    #[must_use]
    pub fn new(seed: u64, most: f64, dt: f64) -> Self {
        Self { rng: Pcg64::new(seed), most, dt, torque: 0.0, left: 0.0 }
    }

    /// The torque of the next tick, N m.
    pub fn torque(&mut self) -> f32 {
        if self.left <= 0.0 {
            self.torque = uniform(&mut self.rng, -self.most, self.most) as f32;
            self.left = uniform(&mut self.rng, 0.05, 0.4);
        }
        self.left -= self.dt;
        self.torque
    }
}

impl Machine {
    /// Shakes the machine with up to 0.3 of its motor's torque: what the encoders count in each
    /// tick.
    pub fn shake(mut self, seed: u64) -> impl Iterator<Item = Sample> {
        let &Hardware { params, limit, counts: turns, .. } = self.hardware();
        let mut shaker = Shaker::new(seed, 0.3 * limit, params.dt);
        iter::repeat_with(move || {
            let counts = self.counts();
            let torque = shaker.torque();
            self.step(torque);
            let angle = |i: usize| (f64::from(counts[i]) + 0.5) / f64::from(turns[i]) * TAU;
            Sample { angles: [angle(0), angle(1)], torques: [0.0, torque.into()] }
        })
    }
}
