//! Passes the memory, defmt's sections and, with the feature `libgcc`, libgcc's doubles to the linker.

mod libgcc;

use std::{env, error::Error};

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
        libgcc::link()?;
    }
    Ok(())
}
