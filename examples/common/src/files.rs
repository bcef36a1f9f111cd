//! Files that examples write.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process;

use clap::builder::{PathBufValueParser, TypedValueParser};

/// Parses the name of a file to write. A bad name is rejected before the work, not after it.
pub fn named(extension: &'static str) -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(move |path| {
        let is_named = path.extension().is_some_and(|found| found == extension);
        if is_named && path.with_file_name(".").is_dir() {
            return Ok(path);
        }
        Err(format!(
            "must be a name that ends in .{extension}, in an existing folder"
        ))
    })
}

/// Fails if the file cannot be written, and changes nothing. Only [`write()`] tries a link, a device or a pipe.
pub fn check(path: &Path) -> Result<(), String> {
    let tried = match fs::symlink_metadata(path) {
        Ok(old) if old.is_file() || old.is_dir() => open(path),
        Ok(_) => Ok(()),
        Err(_) => File::create_new(path).and_then(|_| fs::remove_file(path)),
    };
    tried.map_err(|error| cannot_write(path, error))
}

/// Fails if an existing file cannot be written.
fn open(path: &Path) -> io::Result<()> {
    File::options().append(true).open(path).map(drop)
}

fn cannot_write(path: &Path, error: io::Error) -> String {
    format!("cannot write {}: {error}", path.display())
}

/// Writes a whole file, or leaves the old one. A program that is killed leaves no part of a file under this path.
pub fn write(path: &Path, bytes: impl AsRef<[u8]>) -> Result<(), String> {
    replace(path, bytes.as_ref()).map_err(|error| cannot_write(path, error))
}

fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let old = fs::symlink_metadata(path).ok();
    if old.as_ref().is_some_and(|old| !old.is_file()) {
        // A link, a device or a pipe must stay one.
        return fs::write(path, bytes);
    }
    if old.is_some() {
        // A write-protected file must not be replaced.
        open(path)?;
    }
    let temporary = path.with_file_name(format!(".acrobot-{}.tmp", process::id()));
    let Ok(mut file) = File::create_new(&temporary) else {
        // A protected folder can contain a writable file. Any other error occurs again here.
        return fs::write(path, bytes);
    };
    let replaced = file.write_all(bytes).and_then(|()| {
        if let Some(old) = &old {
            file.set_permissions(old.permissions())?;
        }
        // Some file systems report only here that they are full.
        file.sync_all()?;
        // A mount point can be written but not replaced.
        fs::rename(&temporary, path).or_else(|_| fs::write(path, bytes))
    });
    // After a rename there is no file of this name.
    let _ = fs::remove_file(&temporary);
    replaced
}
