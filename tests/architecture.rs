//! The architecture: a module imports only from modules above it in ARCHITECTURE.md's table, each
//! import names the file that defines the item, and no files import each other.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::{fs, io};

fn files(path: PathBuf) -> Vec<PathBuf> {
    let inside = |entry: io::Result<fs::DirEntry>| files(entry.unwrap().path());
    match fs::read_dir(&path) {
        Ok(folder) => folder.flat_map(inside).collect(),
        Err(_) => vec![path],
    }
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
    words.filter(|word| !word.is_empty())
}

/// The name of the public item that this line defines.
fn defined(line: &str) -> Option<&str> {
    let kinds = ["fn", "struct", "enum", "trait", "type", "const", "static"];
    let mut words = words(line.strip_prefix("pub")?).skip_while(|word| !kinds.contains(word));
    // `const fn` is two of these words.
    words.find(|word| !kinds.contains(word))
}

/// All paths in the code, such as `crate/physics/Model`, with groups in braces taken apart.
fn paths(code: &str) -> Vec<PathBuf> {
    let is_other = |c: char| !c.is_alphanumeric() && !"_/".contains(c);
    let (mut paths, mut group) = (Vec::new(), "");
    for token in code.split_inclusive(is_other) {
        let path = token.trim_end_matches(is_other);
        if token.ends_with("/{") {
            group = path;
        } else if !path.is_empty() {
            paths.push(Path::new(group).join(path));
        }
        if token.ends_with('}') {
            group = "";
        }
    }
    paths
}

/// The module that a path in `file` names, and the file that defines the item, otherwise that of
/// the module.
fn target(sources: &BTreeMap<PathBuf, String>, file: &Path, path: &Path) -> Option<[PathBuf; 2]> {
    path.iter().nth(1)?; // not the path in `pub(super)`
    let path = match path.iter().next()?.to_str()? {
        "crate" => path.strip_prefix("crate").ok()?.to_owned(),
        "super" => file.parent()?.join(path.strip_prefix("super").ok()?),
        child => Some(file.join(path)).filter(|_| sources.contains_key(&file.join(child)))?,
    };
    let mut modules = path.ancestors().filter(|path| sources.contains_key(*path));
    let module = modules.next().unwrap_or(Path::new(""));
    let item = path.strip_prefix(module).ok()?.to_str()?.split('/').next();
    let defines = |code: &str| code.lines().any(|line| defined(line) == item);
    let files = sources.iter().filter(|(_, code)| defines(code));
    let homes = files.filter(|(home, _)| home.starts_with(module));
    let home = homes.min_by_key(|(home, _)| home.iter().count());
    let home = home.map_or(module, |(home, _)| home);
    Some([module, home].map(Path::to_owned))
}

#[test]
fn imports_go_one_way() {
    let text = include_str!("../ARCHITECTURE.md");
    let (_, table) = text.split_once("| modules in `src/` |").unwrap();
    let rows = table.lines().skip(2).take_while(|line| !line.is_empty());
    let order: Vec<&str> = rows.map(|row| row.split('`').nth(1).unwrap()).collect();
    let row = |file: &Path| order.iter().position(|module| file.starts_with(module));

    let mut sources = BTreeMap::new();
    for path in files("src".into()) {
        let file = path.strip_prefix("src").unwrap().with_extension("");
        let text = fs::read_to_string(path).unwrap().replace("::", "/");
        let lines = text.lines().map(|line| line.split("//").next().unwrap());
        let code = lines.filter(|line| !line.ends_with(';') || !line.contains("mod "));
        sources.insert(file, code.collect::<Vec<_>>().join("\n"));
    }
    // These only re-export and document.
    sources.retain(|file, _| !["lib", "guide"].map(Path::new).contains(&&**file));

    let mut imports = BTreeMap::new();
    for (file, code) in &sources {
        let (mut own, mut exported) = (String::new(), Vec::new());
        for item in code.split_inclusive(';') {
            let (before, last) = item.split_at(item.rfind("\npub").unwrap_or(item.len()));
            own += before;
            match last.split_whitespace().nth(1) {
                Some("use") => exported.extend(paths(last)),
                _ => own += last,
            }
        }
        // A re-export is an import if the file uses the name itself.
        exported.retain(|path| words(&own).any(|word| path.ends_with(word)));
        let all = paths(&own).into_iter().chain(exported);
        let found = all.filter_map(|path| target(&sources, file, &path));
        let found: Vec<_> = found.filter(|[_, home]| home != file).collect();
        // Through a parent or the root, which only re-export, one does not see where an import
        // leads.
        let is_hidden = |[module, home]: &&[PathBuf; 2]| module != home && file.starts_with(module);
        let hidden = found.iter().find(is_hidden);
        assert_eq!(hidden, None, "{file:?} imports through a parent");
        let found = found.into_iter().map(|[_, home]| home);
        let found: BTreeSet<_> = found.filter(|to| row(to).is_some()).collect();
        assert!(row(file).is_some(), "ARCHITECTURE.md has no {file:?}");
        let below = found.iter().find(|import| row(import) > row(file));
        assert_eq!(below, None, "{file:?} imports from below");
        imports.insert(file, found);
    }
    assert!(imports.values().flatten().count() > 200, "{imports:#?}");
    while !imports.is_empty() {
        let rest: Vec<_> = imports.keys().copied().collect();
        let used: Vec<_> = imports.values().flatten().cloned().collect();
        let imports_one = |found: &BTreeSet<_>| found.iter().any(|file| rest.contains(&file));
        imports.retain(|file, found| used.contains(file) && imports_one(found));
        assert!(imports.len() < rest.len(), "a circle: {imports:#?}");
    }
}
