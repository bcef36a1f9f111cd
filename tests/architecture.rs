//! The house in order: modules import one way, as ARCHITECTURE.md says, and what it names is there.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn read(path: impl AsRef<Path>) -> String {
    fs::read_to_string(Path::new(ROOT).join(path)).unwrap()
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric() && c != '_')
}

/// The first cells of the table of modules.
fn stated_order() -> Vec<String> {
    let text = read("ARCHITECTURE.md");
    let rows = text.split("| module |").nth(1).unwrap().lines().skip(2);
    rows.map_while(|row| row.strip_prefix("| `"))
        .map(|row| words(row).next().unwrap().to_owned())
        .collect()
}

/// What follows `crate::` in a line of code, in braces or not.
fn imported(line: &str) -> impl Iterator<Item = &str> {
    line.split("crate::")
        .skip(1)
        .flat_map(|path| match path.strip_prefix('{') {
            Some(list) => list.split('}').next().unwrap().split(", ").collect(),
            None => vec![path],
        })
        .map(|path| words(path).next().unwrap())
}

/// `name.rs`, and the files in `name/`.
fn files(module: &str) -> Vec<PathBuf> {
    let path = Path::new(ROOT).join("src").join(module);
    let parts = fs::read_dir(&path).into_iter().flatten();
    let parts = parts.map(|entry| entry.unwrap().path());
    parts.chain([path.with_extension("rs")]).collect()
}

#[test]
fn modules_import_only_what_stands_above_them() {
    let order = stated_order();
    let lib = read("src/lib.rs");
    let modules = lib
        .lines()
        .filter_map(|line| line.trim_start_matches("pub ").strip_prefix("mod "))
        .map(|line| words(line).next().unwrap())
        .filter(|&module| module != "guide");
    let stated = order.iter().map(String::as_str);
    assert_eq!(
        modules.collect::<BTreeSet<_>>(),
        stated.collect::<BTreeSet<_>>()
    );

    // `crate::Action` is from the module that lib.rs exports it from.
    let position = |name: &str| {
        let exports = lib.lines().filter_map(|line| line.strip_prefix("pub use "));
        let mut from = exports.filter(|line| words(line).any(|word| word == name));
        let module = words(from.next().unwrap_or(name)).next();
        let found = order.iter().position(|stated| Some(&**stated) == module);
        found.unwrap_or_else(|| panic!("{name:?} is from no module"))
    };
    let mut imports = 0;
    for (i, module) in order.iter().enumerate() {
        for file in files(module) {
            let text = read(&file);
            let code = text
                .lines()
                .filter(|line| !line.trim_start().starts_with("//"));
            for (line, name) in code.flat_map(|line| imported(line).map(move |name| (line, name))) {
                imports += 1;
                assert!(position(name) <= i, "{}: {line}", file.display());
            }
        }
    }
    assert!(imports > 80, "{imports} were found");
}

/// Files and folders in backquotes, of which a `*` stands for any name.
#[test]
fn what_the_texts_name_is_there() {
    let mut named = 0;
    for text in ["ARCHITECTURE.md", "CONTRIBUTING.md", "README.md"].map(read) {
        for path in text.split('`').flat_map(|quoted| quoted.split(' ')) {
            let folders = ["src/", "tests/", "examples/", "docs/", "benches/", ".ci/"];
            if folders.iter().any(|folder| path.starts_with(folder)) {
                named += 1;
                let whole = path.split('*').next().unwrap();
                let folder = whole.rsplit_once('/').unwrap().0;
                let there = if whole == path { path } else { folder };
                assert!(Path::new(ROOT).join(there).exists(), "{path}");
            }
        }
    }
    assert!(named > 30, "{named} were found");
}
