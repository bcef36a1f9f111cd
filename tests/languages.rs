//! `docs/languages.md` says what each language has: each name exists, and no export is missing.

use std::fs;
use std::path::Path;

use common::{absolute, text_of};

/// The files of a folder with one of these extensions, one after the other.
fn texts(folder: &Path, extension: &str) -> String {
    let mut found = String::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found += &texts(&path, extension);
        } else if path.extension().is_some_and(|found| found == extension) {
            found += &fs::read_to_string(&path).unwrap();
        }
    }
    found
}

/// The words after each of these keywords.
fn after<'a>(text: &'a str, keywords: &[&str]) -> Vec<&'a str> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let pieces = keywords.iter().flat_map(|keyword| text.split(keyword).skip(1));
    pieces.map(|piece| piece.split(|c| !is_name(c)).next().unwrap()).collect()
}

/// The names of a column of the page.
fn column(page: &str, place: usize) -> Vec<&str> {
    let rows = page.lines().filter(|line| line.starts_with("| ") && !line.starts_with("| |"));
    let cells = rows.map(|row| row.split('|').nth(place).unwrap());
    cells.flat_map(|cell| cell.split('`').skip(1).step_by(2)).collect()
}

fn last(name: &str) -> &str {
    name.rsplit(['.', ':']).next().unwrap()
}

#[test]
fn the_names_of_the_page_are_the_exports() {
    let page = text_of("docs/languages.md");
    let [rust, c, npm, python] = [2, 3, 4, 5].map(|place| column(&page, place));

    let source = texts(&absolute("src"), "rs");
    let defined = after(&source, &["fn ", "struct ", "enum ", "trait ", "type ", "mod "]);
    let crates = ["learners", "policy"];
    for name in rust {
        assert!(defined.contains(&last(name)) || crates.contains(&name), "Rust has no {name}");
    }

    let header = text_of("bindings/c/include/acrobot.h");
    let lines = header.lines().filter(|line| !line.starts_with(['/', ' ', '#', 't']));
    let functions: Vec<&str> = lines
        .filter_map(|line| line.split_once('('))
        .map(|(start, _)| start.rsplit([' ', '*']).next().unwrap())
        .collect();
    let is = |name: &str, function: &str| match name.strip_suffix('…') {
        Some(start) => function.starts_with(start),
        None => function == name,
    };
    for name in &c {
        assert!(functions.iter().any(|function| is(name, function)), "C has no {name}");
    }
    for function in functions {
        assert!(c.iter().any(|name| is(name, function)), "docs/languages.md: {function}");
    }

    let types = texts(&absolute("bindings/npm/package"), "ts");
    let members = after(&types, &["\n  ", " get ", " static "]);
    let exports = after(&types, &["export class ", "export function "]);
    for name in &npm {
        let is_there = match name.split_once('.') {
            Some((class, member)) => types.contains(class) && members.contains(&member),
            None => exports.contains(name) || types.contains(&format!("export {{ {name}")),
        };
        assert!(is_there, "npm has no {name}");
    }
    for name in exports {
        assert!(
            npm.iter().any(|of| of.split('.').next() == Some(name)),
            "docs/languages.md: {name}"
        );
    }

    let folder = absolute("bindings/python/python");
    let source = texts(&folder, "py");
    let defined = after(&source, &["def ", "class ", "    \"", "\n"]);
    for name in &python {
        assert!(defined.contains(&last(name)), "Python has no {name}");
    }
    let lists = source.split("__all__ = [").skip(1).map(|rest| rest.split(']').next().unwrap());
    let exports: Vec<&str> = lists.flat_map(|list| list.split('"').skip(1).step_by(2)).collect();
    for name in exports {
        assert!(python.contains(&name), "docs/languages.md: {name}");
    }
}
