//! What the README and the pages repeat from elsewhere is what stands there.

use std::fs;

use acrobot::{Error, Params};
use common::{absolute, text_of};

/// A phrase with a blank for a figure, what stands before this figure on the page, and how many
/// cells of a row are between.
type Figure = (&'static str, &'static str, usize);

/// Of each row of the README's table, on the page that the row links to.
const IN_THE_README: [&[Figure]; 8] = [
    &[
        ("{} times Gymnasium", "| acrobot, `Fast` |", 2),
        ("{} times in a batch of 1,024", "| acrobot, batch of 1,024 `Fast` |", 2),
    ],
    &[
        ("{} times Gymnasium with `make`", "| acrobot_rs for Python, `make` |", 2),
        ("{} times with `make_vec` of 1,024", "Python, `make_vec` of 1,024 |", 2),
    ],
    &[("{} episodes recorded from Gymnasium 1.4.0", "from Gymnasium 1.4.0 with NumPy 2.4.6:", 0)],
    &[
        ("{} instructions per step of `Fast`", STEP, 0),
        ("{} bytes of flash", "| flash of the crate with seeding, bytes |", 0),
        ("{} bytes of RAM", "| RAM of an `Acrobot`, bytes |", 0),
    ],
    &[
        ("{} times dm_control in a vector environment", "| `acrobot_rs`, vector |", 1),
        ("a planner returns {}", "| the planner `stay_up`, 100 initial states |", 3),
    ],
    &[
        ("1 N m, planned: all {} of", "-- --gymnasium` plans with 1 N m: all", 0),
        ("{} initial states stay upright", "From each of", 0),
    ],
    &[("64 KiB | a mean return of {} after 100,000 steps", "| 64 KiB | 100,000 |", 1)],
    &[("best known mean return {}", "| best known |", 0), ("policy is above {}", "| bound |", 0)],
];

const STEP: &str = "| instructions per step, with observation, end test and resets |";

#[test]
fn the_figures_of_the_readme_are_those_of_the_pages() {
    let readme = text_of("README.md");
    let (_, table) = readme.split_once("## Key figures\n\n").unwrap();
    // Without the head and its rule.
    let rows: Vec<_> = table.lines().take_while(|line| line.starts_with('|')).skip(2).collect();
    assert_eq!(
        rows.len(),
        IN_THE_README.len(),
        "README.md has {} key figures: name each one's place in IN_THE_README of tests/docs.rs",
        rows.len()
    );
    for (row, figures) in rows.into_iter().zip(IN_THE_README) {
        let (text, link) = row.rsplit_once(" | [").unwrap();
        let (_, page) = link.split_once("](").unwrap();
        assert_figures("README.md", text, page.split(['#', ')']).next().unwrap(), figures);
    }
}

#[test]
fn the_figures_of_the_firmware_guide_are_those_of_its_page() {
    let figures = [
        ("{} bytes with `error.message()`", "and `message` of its error |", 0),
        ("but {} with `Display`", "and `Display` of its error |", 0),
        ("a step needs {} instructions in `Fast`", STEP, 0),
        ("and {} in `Reference`", STEP, 2),
    ];
    let guide = text_of("docs/embedded-topics.md");
    let (_, section) = guide.split_once("## Which arithmetic").unwrap();
    let (section, _) = section.split_once("\n## ").unwrap();
    assert_figures("docs/embedded-topics.md", section, "docs/embedded-figures.md", &figures);
}

/// The text has these phrases, in this order, and no other numbers.
fn assert_figures(name: &str, text: &str, page: &str, figures: &[Figure]) {
    let one_line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let (text, linked) = (one_line(text), one_line(&text_of(page)));
    let mut rest = &text[..];
    for &(phrase, before, cells) in figures {
        let [_, after] = linked.split(before).collect::<Vec<_>>()[..] else {
            panic!("{page} must have {before:?} once, or tests/docs.rs must name another place");
        };
        let cell = after.split('|').nth(cells).unwrap_or_default();
        let figure = cell.split_whitespace().next().unwrap_or_default();
        let phrase = phrase.replace("{}", figure.trim_end_matches(','));
        let found = rest.split_once(&phrase).filter(|(between, _)| number(between).is_none());
        let why = || panic!("{name} must say {phrase:?}, as {page} does after {before:?}: {rest}");
        (_, rest) = found.unwrap_or_else(why);
    }
    assert_eq!(number(rest), None, "{name}: tests/docs.rs must name its place on {page}: {rest}");
}

fn number(text: &str) -> Option<&str> {
    let mut words = text.split(' ').map(|word| word.trim_start_matches(['-', '−', '(']));
    words.find(|word| word.starts_with(|c: char| c.is_ascii_digit()))
}

/// The comment of a parameter, which other languages repeat, has the unit and range of its error.
#[test]
fn parameters_are_described_with_their_units_and_ranges() {
    let mut params = Params::<f64>::DEFAULT;
    for (place, (name, value)) in params.numbers().into_iter().enumerate() {
        *params.numbers_mut()[place] = f64::NAN;
        let Err(Error::OutOfRange { unit, rule, .. }) = params.validate() else {
            panic!("{name} may be NaN");
        };
        *params.numbers_mut()[place] = value;
        let range = match rule {
            "finite and above 0" => "above 0",
            "finite and at least 0" => "0 or more",
            "a finite number of" => "finite",
            _ => rule,
        };
        check(name.split('[').next().unwrap(), unit, range);
    }
}

/// The comment has the unit and the range, or says that they are those of another parameter, as in
/// "as `mass1`".
fn check(field: &str, unit: &str, range: &str) {
    let text = text_of("src/physics/params.rs");
    let (before, _) = text.split_once(&format!("    pub {field}: ")).unwrap();
    let lines = before.lines().rev().map_while(|line| line.trim().strip_prefix("///"));
    let found = lines.collect::<Vec<_>>().into_iter().rev().collect::<String>();
    if let Some((_, other)) = found.split_once("as `") {
        return check(other.split('`').next().unwrap(), unit, range);
    }
    let says = |text: String| found.contains(&text);
    let has_unit = says(format!(" {unit};")) || says(format!(" {unit},"));
    assert!(has_unit && says(format!("; {range}")), "{field}: {found:?}: {unit}; {range}");
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
    assert!(count > 38, "docs/ names only {count} files: does the test still find `folder/file`?");
}

/// A block that is not compiled with the crate names the file that it is from: "```rust,ignore
/// (path)", "```c (path)" or "```cmake (path)".
#[test]
fn excerpts_are_in_their_files() {
    let unindented = |text: &str| text.lines().map(str::trim_start).collect::<Vec<_>>().join("\n");
    for (page, fence) in [
        ("docs/control.md", "```rust,ignore ("),
        ("docs/real.md", "```rust,ignore ("),
        ("docs/embedded.md", "```rust,ignore ("),
        ("docs/python-firmware.md", "```rust,ignore ("),
        ("docs/python-firmware.md", "```c ("),
        ("docs/c.md", "```c ("),
        ("docs/c.md", "```cmake ("),
    ] {
        let text = text_of(page);
        let blocks: Vec<&str> = text.split(fence).skip(1).collect();
        assert!(!blocks.is_empty(), "{page} has no block {fence}path): drop it from tests/docs.rs");
        for block in blocks {
            let (path, rest) = block.split_once(")\n").unwrap();
            let (excerpt, _) = rest.split_once("```").unwrap();
            let file = unindented(&text_of(path));
            let is_there = file.contains(&unindented(excerpt));
            assert!(is_there, "{page}: copy this block from {path} again:\n{excerpt}");
        }
    }
}
