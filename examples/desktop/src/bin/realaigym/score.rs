//! RealAIGym's scores, as its `analysis/leaderboard.py` computes them.

use std::f64::consts::PI;

use acrobot::physics::Pendulum;
use acrobot::task::{Pose, Task};
use acrobot::{Params, Portable};

use crate::robot::Row;
use crate::task::RealAiGym;

/// Time of the swing-up, s, infinite without success; energy, J; largest torque, N m; integrals of
/// the torque and of its square; standard deviation of its change in a step; integral of the
/// squared velocities; and the time above the line, s.
pub type Costs = [f64; 8];

/// Version 3 is that of ICRA 2025.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Version {
    V1,
    V2,
    V3,
}

impl Version {
    pub fn score(self, costs: Costs) -> f64 {
        const V1: Costs = [0.02, 1e-3, 0.1 / 6.0, 0.1 / 60.0, 0.1 / 360.0, 0.2 / 12.0, 2e-4, 0.0];
        const V2: Costs = [PI / 20.0, PI / 60.0, 0.0, 0.0, PI / 20.0, PI / 0.1, PI / 400.0, 0.0];
        let sum = |weights: Costs, shape: fn(f64) -> f64| -> f64 {
            costs.iter().zip(weights).map(|(cost, weight)| shape(cost * weight)).sum()
        };
        match self {
            Self::V3 => costs[7] / 60.0,
            _ if costs[0].is_infinite() => 0.0,
            Self::V1 => 1.0 - sum(V1, |x| x),
            Self::V2 => 1.0 - sum(V2, f64::tanh) / 5.0,
        }
    }
}

pub fn costs(params: Params, rows: &[Row]) -> anyhow::Result<Costs> {
    let (mut costs, dt) = ([0.0; 8], params.dt);
    costs[0] = f64::INFINITY;
    for (i, pair) in rows.windows(2).enumerate() {
        let ((state, torques), (next, _)) = (pair[0], pair[1]);
        let pendulum = Pendulum::<Portable>::new(params, next.into())?;
        let pose = Pose::new(pendulum.state(), pendulum.sin_cos());
        if RealAiGym.reward::<Portable, f64>(&pose, &params, 0.0, false) > 0.0 {
            costs[7] += dt;
            costs[0] = costs[0].min((i + 1) as f64 * dt);
        } else {
            costs[0] = f64::INFINITY;
        }
        for (j, torque) in torques.into_iter().enumerate() {
            costs[1] += ((next[j] - state[j]) * torque).abs();
            costs[2] = costs[2].max(torque.abs());
            costs[3] += torque.abs() * dt;
            costs[4] += torque * torque * dt;
            costs[6] += state[2 + j] * state[2 + j] * dt;
        }
    }
    for j in 0..2 {
        let changes = rows.windows(2).map(|pair| pair[1].1[j] - pair[0].1[j]);
        let count = (rows.len() - 1) as f64;
        let mean = changes.clone().sum::<f64>() / count;
        costs[5] += (changes.map(|x| (x - mean) * (x - mean)).sum::<f64>() / count).sqrt();
    }
    Ok(costs)
}

#[cfg(test)]
mod tests {
    use std::array::from_fn;

    use super::*;
    use crate::task::{C1, HISTORY_SAC, MC_PILCO};

    /// Of `tests/data/by_hand/realaigym_scores.py`, which has the same trajectory.
    #[test]
    fn costs_and_scores_are_realaigyms() {
        let rows: [Row; 41] = from_fn(|i| {
            let [x, y, z, a, b, c] =
                [i * 7 % 13, i * 5 % 7, i * 11 % 9, i * 3 % 8, i % 3, i * 5 % 11].map(|n| n as f64);
            let theta1 = if i < 24 { x / 4.0 } else { 3.125 };
            ([theta1, (y - 3.0) / 16.0, z - 4.0, a - 3.5], [b / 8.0, (c - 5.0) / 4.0])
        });
        let found = costs(Params { dt: 0.25, ..C1 }, &rows).unwrap();
        let theirs = [6.0, 9.9375, 1.25, 8.09375, 6.66015625, 1.5437482947265575, 118.5, 5.0];
        assert!(found.iter().zip(theirs).all(|(x, y)| (x - y).abs() < 1e-12), "{found:?}");
        assert!((Version::V2.score(HISTORY_SAC) - 0.65527).abs() < 1e-5);
        assert!((Version::V1.score(MC_PILCO) - 0.86906).abs() < 1e-5);
    }
}
