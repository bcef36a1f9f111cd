//! The architecture: a file imports only from files in its own row of ARCHITECTURE.md's table or above.

use std::collections::HashMap;
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

/// The names in all paths from `crate::` or `super::`, also those in braces.
fn imported(code: &str) -> impl Iterator<Item = &str> {
    let starts = ["crate::", "super::"].map(|root| code.match_indices(root));
    starts.into_iter().flatten().flat_map(|(start, _)| {
        let is_part = |c: char| c.is_alphanumeric() || "_:{}, \n".contains(c);
        words(code[start..].split(|c| !is_part(c)).next().unwrap())
    })
}

#[test]
fn files_import_only_from_their_own_row_or_above() {
    let (src, text) = (Path::new("src"), include_str!("../ARCHITECTURE.md"));
    let (_, table) = text.split_once("| modules in `src/` |").unwrap();
    let lines = table.lines().skip(2).take_while(|line| !line.is_empty());
    let mut rows = HashMap::new();
    for (row, line) in lines.enumerate() {
        let names = line.split('|').nth(1).unwrap().split('`');
        rows.extend(names.skip(1).step_by(2).map(|name| (name, row)));
    }
    for name in rows.keys() {
        assert!(src.join(format!("{name}.rs")).exists(), "no {name}.rs");
    }

    let (mut sources, mut homes) = (Vec::new(), HashMap::new());
    for path in files(src.into()) {
        let file = path.strip_prefix(src).unwrap().with_extension("");
        // These have no row, because they only re-export, document and define macros.
        if ["lib", "guide", "physics"].map(Path::new).contains(&&*file) {
            continue;
        }
        // A file that the table does not name is in the row of its folder.
        let row = file.ancestors().find_map(|name| rows.get(name.to_str()?));
        let row = *row.unwrap_or_else(|| panic!("ARCHITECTURE.md has no {file:?}"));
        let text = fs::read_to_string(path).unwrap();
        let code = text.lines().map(|line| line.split("//").next().unwrap());
        let code = code.collect::<Vec<_>>().join("\n");
        for name in code.lines().filter_map(defined) {
            // `error` and `env/error` define the same name: the higher row counts.
            let home = homes.entry(name.to_owned()).or_insert(row);
            *home = row.min(*home);
        }
        sources.push((file, row, code));
    }
    let mut imports = 0;
    for (file, row, code) in &sources {
        for name in imported(code).filter(|&name| homes.contains_key(name)) {
            imports += 1;
            assert!(homes[name] <= *row, "{file:?} imports {name} from below");
        }
    }
    assert!(imports > 100, "only {imports} imports were found");
}
