//! The program ends with a status and a message for any arguments.

#![cfg(target_os = "linux")]

use std::ffi::OsStr;
use std::fs::File;
use std::os::unix::ffi::OsStrExt;
use std::process::Command;

fn compare(arguments: [&[u8]; 2]) -> Command {
    let mut compare = Command::new(env!("CARGO_BIN_EXE_acrobot-compare"));
    compare.args(arguments.map(OsStr::from_bytes));
    compare
}

#[test]
fn errors_have_status_2() {
    let full = || File::options().write(true).open("/dev/full").unwrap();
    let output = compare([b"fast", b"0.01"]).stdout(full()).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stderr.starts_with(b"error: cannot print: "));

    let status = compare([b"slow", b"1"]).stderr(full()).status().unwrap();
    assert_eq!(status.code(), Some(2));

    let output = compare([b"\xff", b"1"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stderr.starts_with(b"usage: "));
}
