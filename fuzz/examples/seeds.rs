//! Writes a snapshot of every type in every format into a folder, as a corpus.

use std::fs;
use std::path::PathBuf;

fn main() -> std::io::Result<()> {
    let folder = PathBuf::from(std::env::args_os().nth(1).expect("a folder"));
    fs::create_dir_all(&folder)?;
    for (number, bytes) in acrobot_fuzz::snapshots::samples().enumerate() {
        fs::write(folder.join(number.to_string()), bytes)?;
    }
    Ok(())
}
