//! The examples do what their docs say, run as a user runs them.

mod exit;
#[cfg(target_os = "linux")]
mod files;
mod pictures;
mod plan;
mod policies;
mod sutton1996;
mod sweep;
mod swing_up;
mod trace;

use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

fn command(example: &str, arguments: &[&str]) -> Command {
    let mut cargo = cargo(example);
    cargo.arg("--").args(arguments);
    cargo
}

/// As `command`, in a shell with these limits.
#[cfg(target_os = "linux")]
fn limited(limits: &str, example: &str, arguments: &[&str]) -> Command {
    let mut cargo = cargo(example);
    let script = format!(r#"{limits}; exec "$0" "$@""#);
    let runner = format!("target.'cfg(unix)'.runner = ['sh', '-c', {script:?}]");
    cargo.args(["--config", &runner, "--"]).args(arguments);
    cargo
}

fn cargo(example: &str) -> Command {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["run", "--quiet", "--example", example]);
    if !cfg!(debug_assertions) {
        cargo.arg("--release");
    }
    cargo.current_dir(env!("CARGO_MANIFEST_DIR"));
    cargo
}

fn run(example: &str, arguments: &[&str], input: &str) -> Output {
    let mut cargo = command(example, arguments);
    let pipes = cargo
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let mut child = pipes.spawn().unwrap();
    // An example that rejects its arguments does not read.
    let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
    child.wait_with_output().unwrap()
}

fn printed(output: Output) -> String {
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}: {errors}", output.status);
    String::from_utf8(output.stdout).unwrap()
}

fn rejected(example: &str, arguments: &[&str], input: &str) -> String {
    let output = run(example, arguments, input);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    assert!(
        output.stdout.is_empty(),
        "an example that rejects its input prints nothing"
    );
    String::from_utf8(output.stderr).unwrap()
}

/// An empty folder for one test, removed when the test ends.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("acrobot-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    fn file(&self, name: &str) -> String {
        self.0.join(name).to_str().unwrap().to_owned()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn gif_frames(path: &str) -> usize {
    let mut frames = gif::DecodeOptions::new()
        .read_info(fs::File::open(path).unwrap())
        .unwrap();
    let mut count = 0;
    while frames.read_next_frame().unwrap().is_some() {
        count += 1;
    }
    count
}

/// A picture's text, which is a whole SVG.
fn svg(path: &str) -> String {
    let text = fs::read_to_string(path).unwrap();
    assert!(
        text.starts_with("<svg") && text.ends_with("</svg>\n"),
        "{path}"
    );
    text
}

fn png(path: &str) -> (u32, u32, Vec<u8>) {
    let file = std::io::Cursor::new(fs::read(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    (info.width, info.height, bytes)
}
