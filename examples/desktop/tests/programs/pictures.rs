//! Programs draw the pictures of the README and of docs/embedded.md.

use super::Folder;

#[test]
fn pictures_are_those_of_the_pages() {
    let folder = Folder::new();
    folder.printed("episode");
    folder.printed("balance --definition balance.txt");
    for name in ["episode.svg", "balance.svg", "balance.txt"] {
        let recorded = common::text_of(&format!("docs/{name}"));
        let drawn = String::from_utf8(folder.read(name)).unwrap();
        assert!(drawn == recorded, "docs/{name} differs");
    }
}
