//! What the README and the pages repeat from elsewhere is what stands there.

use std::fs;

use common::{absolute, text_of};

/// Each number of the README's table stands in the page that its row links to.
#[test]
fn the_figures_of_the_readme_are_those_of_the_pages() {
    let readme = text_of("README.md");
    let (_, figures) = readme.split_once("## Key figures").unwrap();
    let lines = figures.lines().skip_while(|line| !line.starts_with('|'));
    // Without the head and its rule.
    for row in lines.take_while(|line| line.starts_with('|')).skip(2) {
        let [_, _, text, link, _] = row.split('|').collect::<Vec<_>>()[..] else {
            panic!("three cells: {row}");
        };
        let (_, path) = link.trim().trim_end_matches(')').split_once("](").unwrap();
        assert_numbers_are_in(text, path.split('#').next().unwrap());
    }
}

#[test]
fn the_figures_of_the_firmware_guide_are_those_of_its_page() {
    let guide = text_of("docs/embedded-topics.md");
    let (_, section) = guide.split_once("## Which arithmetic").unwrap();
    let (section, _) = section.split_once("\n## ").unwrap();
    assert_numbers_are_in(section, "docs/embedded-figures.md");
}

fn assert_numbers_are_in(text: &str, page: &str) {
    let linked = text_of(page);
    let linked: Vec<&str> = words(&linked).collect();
    for number in words(text).filter(|word| word.starts_with(|c: char| c.is_ascii_digit())) {
        assert!(linked.contains(&number), "{number} is not in {page}");
    }
}

/// The words without signs and punctuation.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split([' ', '\n', '|']).map(|word| {
        word.trim_start_matches(['-', '−']).trim_end_matches(['.', ',', ';', ':', ')', '`'])
    })
}

/// The pages name the repository's files by their paths, without links, because rustdoc shows the
/// pages without the files.
#[test]
fn the_files_that_the_pages_name_exist() {
    const FOLDERS: [&str; 8] =
        ["benches/", "bindings/", "crates/", "docs/", "examples/", "fuzz/", "research/", "tests/"];

    let mut count = 0;
    for page in fs::read_dir(absolute("docs")).unwrap() {
        let page = page.unwrap().path();
        if page.extension().is_some_and(|extension| extension == "md") {
            let text = fs::read_to_string(&page).unwrap();
            // Every second piece is code.
            for code in text.split('`').skip(1).step_by(2) {
                if FOLDERS.iter().any(|folder| code.starts_with(folder)) {
                    assert!(absolute(code).exists(), "{}: {code}", page.display());
                    count += 1;
                }
            }
        }
    }
    assert!(count > 40, "{count}");
}

/// A block that is not compiled with the crate names the file that it is from: "```rust,ignore
/// (path)" or "```c (path)".
#[test]
fn excerpts_are_in_their_files() {
    let unindented = |text: &str| text.lines().map(str::trim_start).collect::<Vec<_>>().join("\n");
    for (page, fence, count) in [
        ("docs/control.md", "```rust,ignore (", 1),
        ("docs/embedded.md", "```rust,ignore (", 2),
        ("docs/c.md", "```c (", 7),
    ] {
        let page = text_of(page);
        let blocks: Vec<&str> = page.split(fence).skip(1).collect();
        for block in &blocks {
            let (path, rest) = block.split_once(")\n").unwrap();
            let (excerpt, _) = rest.split_once("```").unwrap();
            let file = unindented(&text_of(path));
            assert!(file.contains(&unindented(excerpt)), "{path} has no such lines:\n{excerpt}");
        }
        assert_eq!(blocks.len(), count);
    }
}
