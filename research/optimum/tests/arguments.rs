//! Bad arguments, and a folder without the sequences, are rejected with a reason.

use std::process::Command;

#[test]
fn bad_arguments_are_rejected_with_a_reason() {
    for (line, reason) in [
        ("search --width 0", "0 is not in 1.."),
        ("table", "Error: research/optimum/sequences.txt"),
    ] {
        let mut program = Command::new(env!("CARGO_BIN_EXE_optimum"));
        let folder = env!("CARGO_TARGET_TMPDIR");
        let output = program.args(line.split(' ')).current_dir(folder).output().unwrap();
        assert!(!output.status.success() && output.stdout.is_empty());
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(errors.contains(reason), "{line}: {errors}");
    }
}
