//! How a program ends.

use std::error::Error;
use std::io;
use std::process::ExitCode;

/// With status 0, or with what is wrong on standard error and 2. An [`io::Error`] by itself is
/// of printing: all others come with the name of their file.
pub fn status(result: Result<(), impl Into<Box<dyn Error>>>) -> ExitCode {
    let Err(error) = result.map_err(Into::into) else {
        return ExitCode::SUCCESS;
    };
    match error.downcast_ref::<io::Error>().map(io::Error::kind) {
        // Whoever reads has read enough.
        Some(io::ErrorKind::BrokenPipe) => return ExitCode::SUCCESS,
        Some(_) => eprintln!("error: cannot print: {error}"),
        None => eprintln!("error: {error}"),
    }
    ExitCode::from(2)
}
