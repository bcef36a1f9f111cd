//! Gives the linker the memory of QEMU's machines, which `.cargo/config.toml` names.

use std::env;

fn main() {
    if !env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "none") {
        return;
    }
    // The folder of `memory.x`.
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    println!("cargo:rustc-link-arg-bins=-L{root}/examples/cortex-m");
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    let symbols: &[_] = match env::var("TARGET").unwrap_or_default() {
        target if target.starts_with("thumbv8m.main") => {
            &["FLASH_ORIGIN=0x10000000", "RAM_ORIGIN=0x30000000"]
        }
        target if target.starts_with("riscv") => {
            &["FLASH_ORIGIN=0x80000000", "RAM_ORIGIN=0x80100000", "FLASH_SIZE=1M"]
        }
        _ => &[],
    };
    for symbol in symbols {
        println!("cargo:rustc-link-arg-bins=--defsym={symbol}");
    }
}
