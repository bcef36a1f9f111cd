//! The simulated machine. Its angles are not wrapped, and it has a motor in each joint.

use std::array::from_fn;
use std::path::Path;

use acrobot::physics::{Pendulum, saturate};
use acrobot::{Params, Portable, State};

use crate::task::LIMIT;

/// A state, and the torques of both joints in the step from there.
pub type Row = ([f64; 4], [f64; 2]);

#[derive(Clone)]
pub struct Robot {
    pub pendulum: Pendulum<Portable>,
    pub rows: Vec<Row>,
}

impl Robot {
    pub fn hanging(params: Params) -> anyhow::Result<Self> {
        Ok(Self { pendulum: Pendulum::new(params, State::HANGING)?, rows: Vec::new() })
    }

    /// A Runge-Kutta step.
    pub fn step(&mut self, torques: [f64; 2]) -> anyhow::Result<()> {
        let torques = torques.map(|torque| saturate(torque, LIMIT));
        let (state, dt) = (self.pendulum.state().into(), self.pendulum.params().dt);
        self.rows.push((state, torques));
        let (mut next, mut rates) = (state, [0.0; 4]);
        for (ahead, weight) in [(0.0, 6.0), (0.5, 3.0), (0.5, 3.0), (1.0, 6.0)] {
            self.pendulum.set_state(from_fn(|i| state[i] + ahead * dt * rates[i]).into())?;
            rates = self.pendulum.derivative(torques[1]);
            let [[m11, m12], [_, m22]] = self.pendulum.mass_matrix();
            let scaled = torques[0] / (m11 * m22 - m12 * m12);
            rates[2] += m22 * scaled;
            rates[3] -= m12 * scaled;
            next = from_fn(|i| next[i] + dt / weight * rates[i]);
        }
        Ok(self.pendulum.set_state(next.into())?)
    }

    /// Writes what RealAIGym's scorer reads.
    pub fn save(&self, path: &Path) -> anyhow::Result<()> {
        let mut text =
            String::from("time,pos_meas1,pos_meas2,vel_meas1,vel_meas2,tau_con1,tau_con2\n");
        for (i, ([a, b, c, d], [e, f])) in self.rows.iter().enumerate() {
            let time = i as f64 * self.pendulum.params().dt;
            text += &format!("{time},{a},{b},{c},{d},{e},{f}\n");
        }
        desktop::write(path, text)
    }
}
