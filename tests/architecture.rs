//! The architecture: a module imports only from modules above it in ARCHITECTURE.md's table, each
//! import names the file that defines the item, and no files import each other.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The code of each file of a folder, by its module, such as `physics::state`.
fn read(folder: &Path, sources: &mut BTreeMap<String, String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            read(&path, sources);
        } else {
            let text = fs::read_to_string(&path).unwrap();
            let lines = text.lines().map(|line| line.split("//").next().unwrap());
            let module = path.strip_prefix("src").unwrap().with_extension("");
            let module = module.to_str().unwrap().replace('/', "::");
            sources.insert(module, lines.collect::<Vec<_>>().join("\n"));
        }
    }
}

/// The paths that begin with a keyword, from the crate's root, with groups in braces taken apart.
fn paths(code: &str, keyword: &str, module: &str) -> Vec<String> {
    let mut paths = Vec::new();
    for (at, _) in code.match_indices(keyword) {
        let path = &code[at + keyword.len()..];
        let end = path.find(|c: char| !c.is_alphanumeric() && !"_:".contains(c)).unwrap();
        let (path, rest) = path.split_at(end);
        let group = rest.strip_prefix('{').and_then(|rest| rest.split_once('}'));
        for name in group.map_or("", |(names, _)| names).split(',') {
            let path = format!("{module}::{path}{}", name.trim());
            paths.push(path.trim_matches(':').to_owned());
        }
    }
    paths
}

fn defines(code: &str, item: &str) -> bool {
    let kinds = ["fn", "struct", "enum", "trait", "type", "const", "static"];
    let words: Vec<_> = code.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
    words.windows(2).any(|pair| kinds.contains(&pair[0]) && pair[1] == item && !item.is_empty())
}

#[test]
fn imports_go_one_way() {
    let text = include_str!("../ARCHITECTURE.md");
    let (_, table) = text.split_once("| modules in `src/` |").unwrap();
    let rows = table.lines().skip(2).take_while(|line| !line.is_empty());
    let order: Vec<&str> = rows.map(|row| row.split('`').nth(1).unwrap()).collect();
    // The last row that has the module: `control::plan` comes after `control`.
    let row = |module: &str| {
        order.iter().rposition(|name| format!("{module}::").starts_with(&format!("{name}::")))
    };

    let mut sources = BTreeMap::new();
    read("src".as_ref(), &mut sources);
    // These only re-export and document.
    sources.retain(|module, _| !["lib", "guide"].contains(&&**module));
    let mut imports = BTreeMap::new();
    for (file, code) in &sources {
        assert!(row(file).is_some(), "ARCHITECTURE.md: add {file} to the table of modules");
        let parent = file.rsplit_once("::").map_or("", |(parent, _)| parent);
        let mut found = Vec::new();
        let own = paths(code, "\nuse ", file).into_iter();
        let own = own.filter(|path| sources.keys().any(|child| path.starts_with(child)));
        let others = [paths(code, "crate::", ""), paths(code, "super::", parent)].concat();
        for path in own.chain(others) {
            // The module that the path names, and the file that defines the item.
            let is_in =
                |path: &str, module: &str| format!("{path}::").starts_with(&format!("{module}::"));
            let named = sources.keys().filter(|module| is_in(&path, module));
            let module = named.max_by_key(|module| module.len()).map_or("", |module| module);
            let item = path[module.len()..].trim_start_matches(':').split("::").next().unwrap();
            let inside =
                sources.iter().filter(|(home, _)| module.is_empty() || is_in(home, module));
            let mut homes = inside.filter(|(_, code)| defines(code, item));
            let home = homes.next().map_or(module, |(home, _)| home);
            if home == file {
                continue;
            }
            let is_hidden = home != module && (module.is_empty() || is_in(file, module));
            assert!(!is_hidden, "{file} imports {path} through a parent");
            assert!(
                row(home) <= row(file),
                "{file} imports {path} from below: see ARCHITECTURE.md"
            );
            found.push(home);
        }
        imports.insert(file, found);
    }
    let count = imports.values().flatten().count();
    assert!(count > 200, "only {count} imports: does `paths` still find them?\n{imports:#?}");
    while !imports.is_empty() {
        let rest: Vec<_> = imports.keys().map(|file| &***file).collect();
        imports.retain(|_, found| found.iter().any(|file| rest.contains(file)));
        assert!(imports.len() < rest.len(), "a circle: {imports:#?}");
    }
}
