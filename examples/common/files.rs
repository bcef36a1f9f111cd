//! Files that examples write.

use std::fmt::Display;
use std::path::{Path, PathBuf};

/// Parses the argument that names one. A bad name is rejected before the work, not after it.
#[allow(dead_code, reason = "each example uses a part")]
pub fn file(path: &str, extension: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(path);
    let is_named = path.extension().is_some_and(|found| found == extension);
    if is_named && path.with_file_name(".").is_dir() {
        return Ok(path);
    }
    Err(format!(
        "must be a name that ends in .{extension}, in an existing folder"
    ))
}

pub fn cannot_write(path: &Path, error: impl Display) -> String {
    format!("cannot write {}: {error}", path.display())
}
