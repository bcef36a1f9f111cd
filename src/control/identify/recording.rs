//! Recordings, and how the motion of a machine follows from them.

use crate::math::Real;

/// A sample of a recording.
///
/// ```
/// use acrobot::control::identify::Sample;
///
/// let counts = [10, -512]; // of encoders with 4,096 for a turn
/// let angles = counts.map(|count| f64::from(count) / 4096.0 * std::f64::consts::TAU);
/// let sample = Sample { angles, torques: [0.0, 1.5] }; // N m
/// assert!((sample.angles[1] + 0.785).abs() < 1e-3); // rad
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)] // for bindings/abi
pub struct Sample {
    /// θ1 and θ2, rad, without jumps by whole turns.
    pub angles: [f64; 2],
    /// The torques on θ1 and θ2 from this sample to the next, N m. An acrobot's first is 0.
    pub torques: [f64; 2],
}

/// The standard deviation of the noise of both angles, rad: encoders count whole numbers. From the
/// fourth differences, in which a smooth motion vanishes.
pub(super) fn angle_noise(samples: &[Sample]) -> f64 {
    let (mut squares, mut count) = (0.0, 0.0);
    for window in samples.windows(5) {
        let mut differences = [0.0; 2];
        for (sample, weight) in window.iter().zip([1.0, -4.0, 6.0, -4.0, 1.0]) {
            let [angle1, angle2] = sample.angles;
            differences[0] += weight * angle1;
            differences[1] += weight * angle2;
        }
        let [x, y] = differences;
        squares += (x * x + y * y) / 70.0; // the sum of the weights' squares
        count += 2.0;
    }
    if count > 0.0 { Real::sqrt(squares / count) } else { 0.0 }
}

/// What is wrong with a recording.
#[derive(Clone, Copy, Debug)]
pub(super) struct Correction {
    /// The recorded angles where those of the machine are 0, rad.
    pub(super) zeros: [f64; 2],
    /// θ2 is the sum of these parts of the recorded angles.
    pub(super) theta2: [f64; 2],
    /// A torque begins to act so many samples after it was recorded: from -`early` to `longest`.
    pub(super) delay: f64,
    pub(super) early: usize,
    pub(super) longest: usize,
}

impl Correction {
    pub(super) const NONE: Self =
        Self { zeros: [0.0; 2], theta2: [0.0, 1.0], delay: 0.0, early: 0, longest: 0 };

    /// The mean of the torques that act from a part of a sample before this one, for a sample.
    pub(super) fn torques(&self, samples: &[Sample], at: usize, before: f64) -> [f64; 2] {
        // Before the last sample that may act here.
        let ago = self.early as f64 + self.delay + before;
        let part = ago - ago as usize as f64;
        let sent = |ago: usize| {
            let sample = (at + self.early).checked_sub(ago).and_then(|at| samples.get(at));
            sample.map_or([0.0; 2], |sample| sample.torques)
        };
        let ([later1, later2], [earlier1, earlier2]) = (sent(ago as usize), sent(ago as usize + 1));
        [later1 + part * (earlier1 - later1), later2 + part * (earlier2 - later2)]
    }

    /// Angles and velocities of the machine in the middle of an odd number of samples.
    pub(super) fn motion(&self, samples: &[Sample], dt: f64) -> [[f64; 2]; 2] {
        let [[angle1, angle2], [v1, v2]] = motion(samples, dt);
        let [angle1, angle2] = [angle1 - self.zeros[0], angle2 - self.zeros[1]];
        let [part1, part2] = self.theta2;
        [[angle1, part1 * angle1 + part2 * angle2], [v1, part1 * v1 + part2 * v2]]
    }
}

/// Angles and velocities, rad and rad/s, in the middle of an odd number of samples.
fn motion(samples: &[Sample], dt: f64) -> [[f64; 2]; 2] {
    let half = (samples.len() / 2) as f64;
    let count = 2.0 * half + 1.0;
    // The sums of t² and t⁴.
    let squares = half * (half + 1.0) * count / 3.0;
    let fourths = squares * (3.0 * half * (half + 1.0) - 1.0) / 5.0;
    let determinant = count * fourths - squares * squares;
    let mut motion = [[0.0; 2]; 2];
    for (i, sample) in samples.iter().enumerate() {
        let t = i as f64 - half;
        let weights = [(fourths - squares * t * t) / determinant, t / (squares * dt)];
        for (numbers, weight) in motion.iter_mut().zip(weights) {
            for (number, angle) in numbers.iter_mut().zip(sample.angles) {
                *number += weight * angle;
            }
        }
    }
    motion
}
