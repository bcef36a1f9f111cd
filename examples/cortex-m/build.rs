//! Gives the linker the memory and defmt's sections.

use std::{env, error::Error};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-changed=memory.x");
    println!("cargo:rustc-link-search={}", env::var("CARGO_MANIFEST_DIR")?);
    println!("cargo:rustc-link-arg=-Tlink.x");
    // The memory of QEMU's machines that differ from `memory.x`: mps2-an505, and virt, which runs
    // from RAM.
    let target = env::var("TARGET")?;
    if target.starts_with("thumbv8m.main") {
        println!("cargo:rustc-link-arg=--defsym=FLASH_ORIGIN=0x10000000");
        println!("cargo:rustc-link-arg=--defsym=RAM_ORIGIN=0x38000000");
    } else if target.starts_with("riscv32") {
        println!("cargo:rustc-link-arg=--defsym=FLASH_ORIGIN=0x80000000");
        println!("cargo:rustc-link-arg=--defsym=RAM_ORIGIN=0x80100000");
    }
    if env::var_os("CARGO_FEATURE_NUCLEO").is_some() {
        println!("cargo:rustc-link-arg=--defsym=FLASH_ORIGIN=0x08000000");
        println!("cargo:rustc-link-arg=--defsym=FLASH_SIZE=512K");
    }
    println!("cargo:rustc-link-arg-bin=logger=-Tdefmt.x");
    // The learner alone needs 16 KiB.
    println!("cargo:rustc-link-arg-bin=learn=--defsym=RAM_SIZE=32K");
    println!("cargo:rustc-link-arg-bin=real=--defsym=RAM_SIZE=48K");
    // A plan needs 50 kB.
    println!("cargo:rustc-link-arg-bin=balance=--defsym=RAM_SIZE=64K");
    // It has batches in all arithmetics and is never flashed.
    println!("cargo:rustc-link-arg-bin=no_panic=--defsym=FLASH_SIZE=2M");
    Ok(())
}
