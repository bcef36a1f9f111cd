//! Passes the memory, defmt's sections and, with the feature `libgcc`, libgcc to the linker.

use std::process::Command;
use std::{env, error::Error, path::Path};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-changed=memory.x");
    println!(
        "cargo:rustc-link-search={}",
        env::var("CARGO_MANIFEST_DIR")?
    );
    println!("cargo:rustc-link-arg=-Tlink.x");
    println!("cargo:rustc-link-arg-bin=logger=-Tdefmt.x");
    // Its weights alone take 16 KiB.
    println!("cargo:rustc-link-arg-bin=learn=--defsym=RAM_SIZE=32K");
    // Nobody flashes it, and it has batches in all arithmetics.
    println!("cargo:rustc-link-arg-bin=no_panic=--defsym=FLASH_SIZE=1M");
    if env::var_os("CARGO_FEATURE_LIBGCC").is_some() {
        let float = match env::var("TARGET")?.ends_with("hf") {
            true => ["-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"].as_slice(),
            false => &["-mfloat-abi=soft"],
        };
        let libgcc = Command::new("arm-none-eabi-gcc")
            .args(["-mcpu=cortex-m4", "-mthumb", "-print-libgcc-file-name"])
            .args(float)
            .output()
            .map_err(|error| {
                format!("arm-none-eabi-gcc: {error}; this installs it: sudo apt-get install gcc-arm-none-eabi")
            })?;
        let path = String::from_utf8(libgcc.stdout)?;
        let folder = Path::new(path.trim())
            .parent()
            .ok_or("arm-none-eabi-gcc printed no path of a libgcc")?;
        println!("cargo:rustc-link-search={}", folder.display());
        // The linker takes a library named here before Rust's own routines.
        println!("cargo:rustc-link-lib=static:-bundle=gcc");
    }
    Ok(())
}
