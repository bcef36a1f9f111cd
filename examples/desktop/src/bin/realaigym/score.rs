//! RealAIGym's scores, as its `analysis/leaderboard.py` computes them.

use std::array::from_fn;
use std::f64::consts::PI;

use acrobot::task::{Seen, Task};
use acrobot::{Params, Portable};

use crate::robot::Row;
use crate::task::RealAiGym;

/// Time of the swing-up, s, infinite without success; energy, J; largest torque, N m; integrals of
/// the torque, N m s, and of its square, N² m² s; standard deviation of its change in a step, N m;
/// integral of the squared velocities, rad²/s.
pub type Costs = [f64; 7];

/// How a performance is scored: by costs times these weights.
#[derive(Clone, Copy, PartialEq)]
pub enum Version {
    V1,
    V2,
}

impl Version {
    pub fn score(self, costs: &Costs) -> f64 {
        let weights = match self {
            Self::V1 => [0.02, 1e-3, 0.1 / 6.0, 0.1 / 60.0, 0.1 / 360.0, 0.2 / 12.0, 2e-4],
            Self::V2 => [PI / 20.0, PI / 60.0, 0.0, 0.0, PI / 20.0, PI / 0.1, PI / 400.0],
        };
        let weighed: Costs = from_fn(|i| weights[i] * costs[i]);
        match self {
            _ if costs[0].is_infinite() => 0.0,
            Self::V1 => 1.0 - weighed.iter().sum::<f64>(),
            Self::V2 => 1.0 - weighed.map(f64::tanh).iter().sum::<f64>() / 5.0,
        }
    }
}

/// The costs, and the time above the line, s.
pub fn costs(params: &Params, rows: &[Row]) -> (Costs, f64) {
    let [mut energy, mut sum, mut square, mut velocity, mut uptime] = [0.0; 5];
    let mut since = f64::INFINITY;
    for pair in rows.windows(2) {
        let (row, next) = (pair[0], pair[1]);
        let dt = next.time - row.time;
        let seen = Seen { state: next.state.into(), sin_cos: next.sin_cos };
        if RealAiGym.reward::<Portable, f64>(&seen, params, 0.0, false) > 0.0 {
            uptime += dt;
            since = since.min(next.time);
        } else {
            since = f64::INFINITY;
        }
        for j in 0..2 {
            let (torque, rate) = (row.torques[j], row.state[2 + j]);
            energy += ((next.state[j] - row.state[j]) * torque).abs();
            sum += torque.abs() * dt;
            square += torque * torque * dt;
            velocity += rate * rate * dt;
        }
    }
    let torques = rows.iter().flat_map(|row| row.torques);
    let largest = torques.fold(0.0, |most, torque| f64::max(most, torque.abs()));
    let smoothness = deviation(rows, 0) + deviation(rows, 1);
    ([since, energy, largest, sum, square, smoothness, velocity], uptime)
}

/// The standard deviation of a torque's changes.
fn deviation(rows: &[Row], joint: usize) -> f64 {
    let changes = rows.windows(2).map(|pair| pair[1].torques[joint] - pair[0].torques[joint]);
    let count = (rows.len() - 1) as f64;
    let mean = changes.clone().sum::<f64>() / count;
    (changes.map(|x| (x - mean) * (x - mean)).sum::<f64>() / count).sqrt()
}
