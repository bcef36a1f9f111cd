//! The exit status of an example.

use std::error::Error;
use std::io;
use std::process::ExitCode;

/// Status 0, or an error message on standard error and status 2. A bare [`io::Error`] comes from standard output,
/// because the messages of files carry a path.
pub fn status(result: Result<(), impl Into<Box<dyn Error>>>) -> ExitCode {
    let Err(error) = result.map_err(Into::into) else {
        return ExitCode::SUCCESS;
    };
    match error.downcast_ref::<io::Error>().map(io::Error::kind) {
        // The reader closed the pipe: that is no error.
        Some(io::ErrorKind::BrokenPipe) => return ExitCode::SUCCESS,
        Some(_) => eprintln!("error: cannot print: {error}"),
        None => eprintln!("error: {error}"),
    }
    ExitCode::from(2)
}
