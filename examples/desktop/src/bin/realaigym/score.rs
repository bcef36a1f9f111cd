//! RealAIGym's scores, as its `analysis/leaderboard.py` computes them.

use std::f64::consts::PI;

use acrobot::physics::Pendulum;
use acrobot::task::{Seen, Task};
use acrobot::{Params, Portable};

use crate::robot::Row;
use crate::task::RealAiGym;

/// Time of the swing-up, s, infinite without success; energy, J; largest torque, N m; integrals of
/// the torque and of its square; standard deviation of its change in a step; integral of the
/// squared velocities.
pub type Costs = [f64; 7];

/// Of the score of a swing-up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Version {
    V1,
    V2,
}

impl Version {
    pub fn score(self, costs: Costs) -> f64 {
        const V1: Costs = [0.02, 1e-3, 0.1 / 6.0, 0.1 / 60.0, 0.1 / 360.0, 0.2 / 12.0, 2e-4];
        const V2: Costs = [PI / 20.0, PI / 60.0, 0.0, 0.0, PI / 20.0, PI / 0.1, PI / 400.0];
        let sum = |weights: Costs, shape: fn(f64) -> f64| -> f64 {
            costs.iter().zip(weights).map(|(cost, weight)| shape(cost * weight)).sum()
        };
        match self {
            _ if costs[0].is_infinite() => 0.0,
            Self::V1 => 1.0 - sum(V1, |x| x),
            Self::V2 => 1.0 - sum(V2, f64::tanh) / 5.0,
        }
    }
}

/// The costs, and the time above the line, s.
pub fn costs(params: Params, rows: &[Row]) -> anyhow::Result<(Costs, f64)> {
    let (mut costs, mut uptime) = ([f64::INFINITY, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], 0.0);
    for pair in rows.windows(2) {
        let (row, next) = (pair[0], pair[1]);
        let dt = next.time - row.time;
        let pendulum = Pendulum::<Portable>::new(params, next.state.into())?;
        let seen = Seen { state: pendulum.state(), sin_cos: pendulum.sin_cos() };
        if RealAiGym.reward::<Portable, f64>(&seen, &params, 0.0, false) > 0.0 {
            uptime += dt;
            costs[0] = costs[0].min(next.time);
        } else {
            costs[0] = f64::INFINITY;
        }
        for (i, torque) in row.torques.into_iter().enumerate() {
            costs[1] += ((next.state[i] - row.state[i]) * torque).abs();
            costs[2] = costs[2].max(torque.abs());
            costs[3] += torque.abs() * dt;
            costs[4] += torque * torque * dt;
            costs[6] += row.state[2 + i].powi(2) * dt;
        }
    }
    for i in 0..2 {
        let changes = rows.windows(2).map(|pair| pair[1].torques[i] - pair[0].torques[i]);
        let mean = |x: &mut dyn Iterator<Item = f64>| x.sum::<f64>() / (rows.len() - 1) as f64;
        let middle = mean(&mut changes.clone());
        costs[5] += mean(&mut changes.map(|x| (x - middle).powi(2))).sqrt();
    }
    Ok((costs, uptime))
}
