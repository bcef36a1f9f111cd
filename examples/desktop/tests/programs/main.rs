//! The programs do what their documentation says.

mod swing_up;

use std::env::consts::EXE_EXTENSION;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicU32, Ordering};
use std::{env, fs};

/// An empty folder in which programs run, removed when the test ends.
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

    /// A program and its arguments, separated by spaces.
    fn command(&self, line: &str) -> Command {
        let mut words = line.split(' ');
        // All programs are in one folder.
        let program = Path::new(env!("CARGO_BIN_EXE_swing_up"))
            .with_file_name(words.next().unwrap())
            .with_extension(EXE_EXTENSION);
        let mut command = Command::new(program);
        command.args(words).current_dir(&self.0);
        command
    }

    /// What a program prints.
    fn printed(&self, line: &str) -> String {
        let output = self.command(line).output().unwrap();
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{line}: {errors}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// The error message of a program that must fail, and print nothing else.
    fn rejected(&self, line: &str) -> String {
        let output = self.command(line).output().unwrap();
        assert!(
            !output.status.success() && output.stdout.is_empty(),
            "{line}"
        );
        String::from_utf8(output.stderr).unwrap()
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
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The pictures of the README and of docs/embedded.md.
#[test]
fn pictures_are_those_of_the_pages() {
    let folder = Folder::new();
    folder.printed("episode");
    folder.printed("episode --balance --out balance.svg --definition balance.txt");
    for name in ["episode.svg", "balance.svg", "balance.txt"] {
        let recorded = common::text_of(&format!("docs/{name}"));
        let drawn = String::from_utf8(folder.read(name)).unwrap();
        assert!(drawn == recorded, "docs/{name} differs");
    }
}

/// Commands, and a part of the error message of each.
const REJECTED: [(&str, &str); 10] = [
    ("optimum search --width 0", "0 is not in 1.."),
    ("optimum table --file none.txt", "Error: none.txt"),
    ("swing_up --plan 129", "129 is not in 1..=128"),
    ("swing_up --load none.bin", "Error: none.bin"),
    ("episode --seed 4x2", "got 'x' as character 2"),
    ("episode --out no/a.svg", "Error: cannot write no/a.svg"),
    ("stay_up --episodes 0", "0 is not in 1.."),
    ("trace 013", "an action must be 0, 1 or 2"),
    ("swing_up --load /dev/zero", "weights must"),
    ("swing_up --steps 1 --episodes 1", "cannot be used with"),
];

#[test]
fn bad_arguments_are_rejected_with_a_reason() {
    let folder = Folder::new();
    for (line, reason) in REJECTED {
        let errors = folder.rejected(line);
        assert!(errors.contains(reason), "{line}: {errors}");
    }
}
