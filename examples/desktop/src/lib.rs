//! Code that several programs share.

pub mod animation;

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

use acrobot::numpy::SeedSequence;
use acrobot::{Action, State};
use anyhow::Context;
use learners::{Budget, QLambda, evaluation, play, training};

/// The bang-bang policy: torque against θ̇1, in rad/s.
pub fn bang_bang(dtheta1: impl Into<f64>) -> Action {
    if dtheta1.into() > 0.0 { Action::Negative } else { Action::Positive }
}

/// Writes a file. An error names it.
pub fn write(path: &Path, bytes: impl AsRef<[u8]>) -> anyhow::Result<()> {
    fs::write(path, bytes).with_context(|| format!("cannot write {}", path.display()))
}

/// Loads a learner's weights from a file.
pub fn load<const S: usize, const T: usize>(
    learner: &mut QLambda<S, T>,
    path: &Path,
) -> anyhow::Result<()> {
    /// A file can be endless, and no weights have so many bytes.
    const MOST: u64 = 1 << 17;
    let mut load = || -> anyhow::Result<()> {
        let mut bytes = Vec::new();
        File::open(path)?.take(MOST).read_to_end(&mut bytes)?;
        Ok(learner.load(&bytes)?)
    };
    load().with_context(|| path.display().to_string())
}

/// Learns for a budget. Returns the return of each episode.
pub fn train<const S: usize, const T: usize>(
    learner: &mut QLambda<S, T>,
    budget: Budget,
    seed: SeedSequence,
) -> Vec<f32> {
    let mut env = training(seed);
    let (mut returns, mut steps) = (Vec::new(), 0);
    while match budget {
        Budget::Episodes(all) => (returns.len() as u32) < all,
        Budget::Steps(all) => steps < all,
    } {
        returns.push(learner.learn(&mut env));
        steps += env.elapsed_steps();
    }
    returns
}

/// The returns of a policy.
pub struct Returns {
    pub mean: f64,
    /// The standard deviation.
    pub std: f64,
    /// Episodes that were truncated before the goal.
    pub misses: u32,
}

/// Plays a policy from the same initial states as every other policy with this seed.
pub fn evaluate(
    seed: &SeedSequence,
    episodes: u32,
    mut policy: impl FnMut(&State<f32>) -> Action,
) -> Returns {
    let mut env = evaluation(seed);
    let (mut sum, mut squares, mut misses) = (0.0, 0.0, 0);
    for _ in 0..episodes {
        let (gained, reached) = play(&mut env, &mut policy);
        sum += f64::from(gained);
        squares += f64::from(gained * gained);
        misses += u32::from(!reached);
    }
    let n = f64::from(episodes);
    let mean = sum / n;
    Returns { mean, std: (squares / n - mean * mean).max(0.0).sqrt(), misses }
}
