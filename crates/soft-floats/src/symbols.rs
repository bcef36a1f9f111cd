//! The routines under the names that the compiler calls. Rust's are weak symbols, so these replace
//! them.
//!
//! Without an FPU a `u32` is passed as an `f32` is. With `f32` LLVM does not end a routine with a
//! jump to another.

#[cfg_attr(target_arch = "arm", unsafe(export_name = "__aeabi_fadd"))]
#[cfg_attr(target_arch = "riscv32", unsafe(export_name = "__addsf3"))]
extern "C" fn add(a: u32, b: u32) -> u32 {
    crate::add(a, b)
}

#[cfg_attr(target_arch = "arm", unsafe(export_name = "__aeabi_fsub"))]
#[cfg_attr(target_arch = "riscv32", unsafe(export_name = "__subsf3"))]
extern "C" fn sub(a: u32, b: u32) -> u32 {
    crate::sub(a, b)
}

#[cfg_attr(target_arch = "arm", unsafe(export_name = "__aeabi_fmul"))]
#[cfg_attr(target_arch = "riscv32", unsafe(export_name = "__mulsf3"))]
extern "C" fn mul(a: u32, b: u32) -> u32 {
    crate::mul(a, b)
}
