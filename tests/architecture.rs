//! The architecture: files import only from files above them, and what the texts name exists.

use std::collections::{BTreeSet, HashMap};
use std::fs;
use std::path::{Path, PathBuf};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn read(path: impl AsRef<Path>) -> String {
    fs::read_to_string(Path::new(ROOT).join(path)).unwrap()
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric() && c != '_')
        .filter(|word| !word.is_empty())
}

/// The rows of the table, each with the files that it names.
fn rows() -> Vec<Vec<String>> {
    let text = read("ARCHITECTURE.md");
    let table = text.split("| files in `src/` |").nth(1).unwrap();
    let rows = table
        .lines()
        .skip(2)
        .map_while(|row| row.strip_prefix("| "));
    rows.map(|row| {
        let files = row.split(" | ").next().unwrap().split(", ");
        files
            .map(|file| file.trim_matches('`').to_owned())
            .collect()
    })
    .collect()
}

/// All source files, as `physics/step`.
fn files(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let inside = path.strip_prefix(Path::new(ROOT).join("src")).unwrap();
            found.push(inside.with_extension("").to_str().unwrap().to_owned());
        }
    }
    found
}

/// The name that a line defines, if it is an item that other files can import.
fn defined(line: &str) -> Option<&str> {
    let (visibility, item) = line.split_once(' ')?;
    if !visibility.starts_with("pub") {
        return None;
    }
    let kinds = ["fn", "struct", "enum", "trait", "type", "const"];
    let mut after = words(item).skip_while(|word| !kinds.contains(word));
    after.find(|word| !kinds.contains(word))
}

/// The names that follow `crate::` or `super::` outside of comments, in braces or not.
fn imported(text: &str) -> impl Iterator<Item = &str> {
    let after = |mark| text.match_indices(mark).map(move |(start, _)| start);
    let starts = after("crate::").chain(after("super::"));
    let code = starts.filter(|&start| {
        let line = text[..start].rsplit('\n').next().unwrap();
        !line.trim_start().starts_with("//")
    });
    code.flat_map(|start| {
        let path = &text[start..];
        let end = path.find(|c: char| !c.is_alphanumeric() && !"_:".contains(c));
        let end = end.unwrap_or(path.len());
        match path[end..].starts_with('{') {
            true => words(path.split('}').next().unwrap()),
            false => words(&path[..end]),
        }
    })
}

#[test]
fn files_import_only_from_their_own_row_or_above() {
    let rows = rows();
    // A file is in the row that names it, or its folder.
    let row = |file: &str| {
        let exact = rows
            .iter()
            .position(|row| row.iter().any(|name| name == file));
        let folder = file.rsplit_once('/').map_or(file, |(folder, _)| folder);
        let by_folder = rows
            .iter()
            .position(|row| row.iter().any(|name| name == folder));
        exact.or(by_folder)
    };
    let sources = files(&Path::new(ROOT).join("src"));
    let sources: Vec<&String> = sources
        .iter()
        // They have no code.
        .filter(|file| !["lib", "guide", "physics"].contains(&file.as_str()))
        .collect();
    let texts: Vec<String> = sources
        .iter()
        .map(|file| read(format!("src/{file}.rs")))
        .collect();
    let mut home = HashMap::new();
    for (file, text) in sources.iter().zip(&texts) {
        for name in text.lines().filter_map(defined) {
            home.insert(name, file.as_str());
        }
    }

    let mut named: BTreeSet<&str> = rows.iter().flatten().map(String::as_str).collect();
    let mut imports = 0;
    for (file, text) in sources.iter().zip(&texts) {
        let place = row(file).unwrap_or_else(|| panic!("ARCHITECTURE.md has no {file}"));
        named.remove(file.as_str());
        for name in imported(text) {
            if let Some(from) = home.get(name) {
                imports += 1;
                let above = row(from).is_some_and(|from| from <= place);
                assert!(above, "{file} imports {name} from {from}");
            }
        }
    }
    assert!(imports > 100, "{imports} were found");
    assert!(named.is_empty(), "ARCHITECTURE.md names {named:?}");
}

/// Files and folders in backquotes; a `*` stands for any name.
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
                let there: PathBuf = if whole == path { path } else { folder }.into();
                assert!(Path::new(ROOT).join(&there).exists(), "{path}");
            }
        }
    }
    assert!(named > 30, "{named} were found");
}
