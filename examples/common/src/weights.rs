//! Loads files of weights.

use std::fmt::Display;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use learners::task::Values;

/// The most bytes that are read, because a file can be endless. The largest weights have 65,556 bytes. An error names
/// the size of a file up to this limit.
const MOST: usize = 1 << 17;

pub fn load<const S: usize, const T: usize>(
    values: &mut Values<S, T>,
    path: &Path,
) -> Result<(), String> {
    let named = |reason: &dyn Display| format!("{}: {reason}", path.display());
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(|error| named(&error))?;
    let read = file.take(MOST as u64 + 1).read_to_end(&mut bytes);
    read.map_err(|error| named(&error))?;
    if bytes.len() > MOST {
        return Err(named(&format_args!(
            "weights must have at most {MOST} bytes, got more"
        )));
    }
    values.load(&bytes).map_err(|error| named(&error))
}
