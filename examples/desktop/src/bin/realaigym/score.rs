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

/// Of the best published trajectories of version 2 and 1.
pub const HISTORY_SAC: Costs = [
    1.0000000000000007,
    8.077749161960673,
    1.9757194519042969,
    2.067291440963739,
    1.8037118196867141,
    0.009546752841345449,
    88.4965605525382,
];
pub const MC_PILCO: Costs = [
    1.0980000000000008,
    9.808203401899997,
    2.8199985516469153,
    1.2688701255573542,
    2.268946930905162,
    0.0566728078006337,
    242.4359914232601,
];

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

#[cfg(test)]
mod tests {
    use std::array::from_fn;

    use super::*;
    use crate::task::C1;

    /// Of `tests/data/by_hand/realaigym_scores.py`, which has the same trajectory.
    #[test]
    fn costs_and_scores_are_realaigyms() {
        let row = |i: usize| {
            let [x, y, z, a, b, c] =
                [i * 7 % 13, i * 5 % 7, i * 11 % 9, i * 3 % 8, i % 3, i * 5 % 11].map(|n| n as f64);
            let theta1 = if i < 24 { x / 4.0 } else { 3.125 };
            let state = [theta1, (y - 3.0) / 16.0, z - 4.0, a - 3.5];
            Row { time: i as f64 / 4.0, state, torques: [b / 8.0, (c - 5.0) / 4.0] }
        };
        let (found, uptime) = costs(C1, &from_fn::<_, 41, _>(row)).unwrap();
        let theirs = [6.0, 9.9375, 1.25, 8.09375, 6.66015625, 1.5437482947265575, 118.5, 5.0];
        for (x, y) in found.into_iter().chain([uptime]).zip(theirs) {
            assert!((x - y).abs() < 1e-12, "{found:?} {uptime}");
        }
        for (version, costs, score) in [
            (Version::V2, HISTORY_SAC, 0.6552699844147534),
            (Version::V1, MC_PILCO, 0.8690550290770307),
        ] {
            assert!((version.score(costs) - score).abs() < 1e-14, "{version:?}");
        }
    }
}
