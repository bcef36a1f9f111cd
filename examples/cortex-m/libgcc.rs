//! Makes libgcc add, multiply and convert doubles, instead of Rust's own routines. The bits are the
//! same.
//!
//! It is for a Cortex-M3, M4 or M33, which compute doubles in software. Copy this file beside your
//! `build.rs`, and call `libgcc::link()?` there.

use std::process::Command;
use std::{env, error::Error, fs};

/// The parts of libgcc that need fewer instructions than Rust's. Its division needs four times as
/// many, and its comparisons slightly more.
const PARTS: [&str; 3] = ["_arm_addsubdf3.o", "_arm_muldf3.o", "_arm_truncdfsf2.o"];

pub fn link() -> Result<(), Box<dyn Error>> {
    let (core, floats) = match env::var("TARGET")?.as_str() {
        "thumbv7m-none-eabi" => ("armv7-m", "soft"),
        "thumbv7em-none-eabi" => ("armv7e-m", "soft"),
        "thumbv7em-none-eabihf" => ("armv7e-m+fp", "hard"),
        "thumbv8m.main-none-eabi" => ("armv8-m.main", "soft"),
        "thumbv8m.main-none-eabihf" => ("armv8-m.main+fp", "hard"),
        other => return Err(format!("libgcc's doubles are not faster on {other}").into()),
    };
    let core = format!("-march={core}");
    let floats = format!("-mfloat-abi={floats}");
    let folder = env::var("OUT_DIR")?;
    let gcc = ["-mthumb", &core, &floats, "-print-libgcc-file-name"];
    let libgcc = run(&folder, "arm-none-eabi-gcc", &gcc)?;
    let extract = [&["x", libgcc.trim()], &PARTS[..]].concat();
    run(&folder, "arm-none-eabi-ar", &extract)?;
    // An earlier build's archive could have other parts.
    let _ = fs::remove_file(format!("{folder}/libdoubles.a"));
    let pack = [&["rcs", "libdoubles.a"], &PARTS[..]].concat();
    run(&folder, "arm-none-eabi-ar", &pack)?;
    println!("cargo:rustc-link-search={folder}");
    // The linker takes a library named here before Rust's own routines, but an object in its
    // arguments after them.
    println!("cargo:rustc-link-lib=static:-bundle=doubles");
    Ok(())
}

/// Runs a program of the package gcc-arm-none-eabi, and returns what it prints.
fn run(folder: &str, program: &str, arguments: &[&str]) -> Result<String, Box<dyn Error>> {
    let output =
        Command::new(program).args(arguments).current_dir(folder).output().map_err(|error| {
            format!("{program}: {error}; this installs it: sudo apt-get install gcc-arm-none-eabi")
        })?;
    if !output.status.success() {
        return Err(format!("{program}: {}", String::from_utf8_lossy(&output.stderr)).into());
    }
    Ok(String::from_utf8(output.stdout)?)
}
