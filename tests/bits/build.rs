//! Gives the linker the memory of QEMU's machines, which `.cargo/config.toml` names.

use std::env;

fn main() {
    if env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "none") {
        println!("cargo:rustc-link-arg-bins=-L{}", env!("CARGO_MANIFEST_DIR"));
        println!("cargo:rustc-link-arg-bins=-Tlink.x");
    }
    let origins = match env::var("TARGET").unwrap_or_default() {
        target if target.starts_with("thumbv8m.main") => ["0x10000000", "0x38000000"],
        target if target.starts_with("riscv32") => ["0x80000000", "0x80100000"],
        _ => return,
    };
    for (name, origin) in ["FLASH_ORIGIN", "RAM_ORIGIN"].into_iter().zip(origins) {
        println!("cargo:rustc-link-arg-bins=--defsym={name}={origin}");
    }
}
