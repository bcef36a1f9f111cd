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
    let (flash, ram) = match env::var("TARGET")?.split('-').next() {
        // mps2-an505
        Some("thumbv8m.main") => (0x1000_0000, 0x3800_0000),
        // virt, which runs from RAM
        Some(target) if target.starts_with("riscv32") => (0x8000_0000_u32, 0x8010_0000_u32),
        // microbit, mps2-an385 and mps2-an386
        _ => (0, 0x2000_0000),
    };
    println!("cargo:rustc-link-arg=--defsym=FLASH_ORIGIN={flash}");
    println!("cargo:rustc-link-arg=--defsym=RAM_ORIGIN={ram}");
    println!("cargo:rustc-link-arg-bin=logger=-Tdefmt.x");
    // Its weights alone take 16 KiB.
    println!("cargo:rustc-link-arg-bin=learn=--defsym=RAM_SIZE=32K");
    // It has batches in all arithmetics and is never flashed.
    println!("cargo:rustc-link-arg-bin=no_panic=--defsym=FLASH_SIZE=1M");
    if env::var_os("CARGO_FEATURE_LIBGCC").is_some() {
        libgcc::link()?;
    }
    Ok(())
}
