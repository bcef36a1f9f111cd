//! The examples, run as programs, do what their docs say.

mod exit;
#[cfg(target_os = "linux")]
mod files;
mod pictures;
mod plan;
mod policies;
mod rejections;
mod sutton1996;
mod sweep;
mod swing_up;
mod trace;

use std::path::PathBuf;
use std::process::Command;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU32, Ordering};
use std::{env, fs};

/// The folder with the examples' programs, which Cargo builds once. `cargo run` would look for changes before each run,
/// which takes 0.1 s, longer than most runs.
static EXAMPLES: LazyLock<PathBuf> = LazyLock::new(|| {
    let test = env::current_exe().unwrap();
    // The test is `target/debug/deps/examples-…`.
    let profile = test.ancestors().nth(2).unwrap();
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--quiet", "--examples", "--target-dir"]);
    cargo.arg(profile.parent().unwrap());
    if !cfg!(debug_assertions) {
        cargo.arg("--release");
    }
    let built = cargo.current_dir(env!("CARGO_MANIFEST_DIR")).status();
    assert!(built.unwrap().success());
    profile.join("examples")
});

/// An empty folder in which examples run, removed when the test ends.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let folder = env::temp_dir().join(format!("acrobot-{}-{number}", std::process::id()));
        // A killed test with the same process id may have left one.
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir(&folder).unwrap();
        Self(folder)
    }

    /// An example and its arguments, separated by spaces.
    fn command(&self, line: &str) -> Command {
        let mut words = line.split(' ');
        let mut command = Command::new(EXAMPLES.join(words.next().unwrap()));
        command.args(words).current_dir(&self.0);
        command
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    /// The text of a picture, which must be a complete SVG.
    fn svg(&self, name: &str) -> String {
        let text = String::from_utf8(self.read(name)).unwrap();
        assert!(text.starts_with("<svg") && text.ends_with("</svg>\n"));
        text
    }

    fn gif_frames(&self, name: &str) -> usize {
        let bytes = self.read(name);
        let gif = gif::DecodeOptions::new().read_info(&bytes[..]).unwrap();
        gif.into_iter().map(Result::unwrap).count()
    }

    /// All files, in alphabetical order.
    fn names(&self) -> Vec<String> {
        let files = fs::read_dir(&self.0).unwrap();
        let name = |file: fs::DirEntry| file.file_name().into_string().unwrap();
        let mut names: Vec<_> = files.map(|file| name(file.unwrap())).collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn printed(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

/// Returns the error message. A rejected command prints nothing on standard output.
fn rejected(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let errors = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{command:?}: {errors}");
    assert!(output.stdout.is_empty(), "{command:?}");
    errors
}
