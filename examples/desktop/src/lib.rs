//! Code that several programs share.

pub mod animation;
pub mod search;

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

use acrobot::Action;
use anyhow::Context;
use learners::task::Values;

/// The bang-bang policy: torque against θ̇1, in rad/s.
pub fn bang_bang(dtheta1: impl Into<f64>) -> Action {
    if dtheta1.into() > 0.0 {
        Action::Negative
    } else {
        Action::Positive
    }
}

/// Writes a file. An error names it.
pub fn write(path: &Path, bytes: impl AsRef<[u8]>) -> anyhow::Result<()> {
    fs::write(path, bytes).with_context(|| format!("cannot write {}", path.display()))
}

/// Loads a learner's weights from a file.
pub fn load<const S: usize, const T: usize>(
    values: &mut Values<S, T>,
    path: &Path,
) -> anyhow::Result<()> {
    /// A file can be endless, and no weights have so many bytes.
    const MOST: u64 = 1 << 17;
    let named = || path.display().to_string();
    let mut bytes = Vec::new();
    let file = File::open(path).with_context(named)?;
    let read = file.take(MOST).read_to_end(&mut bytes);
    read.with_context(named)?;
    values.load(&bytes).with_context(named)
}
