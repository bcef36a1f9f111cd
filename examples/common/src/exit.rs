//! The exit status of an example.

use std::error::Error;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::Parser;

/// Parses the arguments, runs an example, and returns its status.
pub fn run<O: Parser, E: Into<Box<dyn Error>>>(
    example: impl FnOnce(&O) -> Result<(), E>,
) -> ExitCode {
    match O::try_parse() {
        Ok(options) => status(example(&options)),
        Err(error) => match (error.print(), error.use_stderr()) {
            (help, false) => status(help),
            // clap's status for an invalid argument is 2, as for every other error.
            (_, true) => ExitCode::from(2),
        },
    }
}

/// Status 0, or an error message on standard error and status 2. A bare [`io::Error`] comes from standard output,
/// because the messages of files carry a path.
pub fn status(result: Result<(), impl Into<Box<dyn Error>>>) -> ExitCode {
    let Err(error) = result.map_err(Into::into) else {
        return ExitCode::SUCCESS;
    };
    let from = match error.downcast_ref::<io::Error>().map(io::Error::kind) {
        // The reader closed the pipe, which is not an error.
        Some(io::ErrorKind::BrokenPipe) => return ExitCode::SUCCESS,
        Some(_) => "cannot print: ",
        None => "",
    };
    // The status must be right even if the message cannot be printed.
    let _ = writeln!(io::stderr(), "error: {from}{error}");
    ExitCode::from(2)
}
