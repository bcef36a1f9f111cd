//! Code that several of the programs share.

#![no_std]

pub mod counter;
pub mod plan;
#[cfg(target_arch = "arm")]
pub mod ram;
pub mod stack;

#[cfg(target_arch = "arm")]
pub use {cortex_m::asm::nop, cortex_m_rt::entry};
#[cfg(target_arch = "riscv32")]
pub use {riscv::asm::nop, riscv_rt::entry};

// Linked because it is named.
#[cfg(feature = "soft-floats")]
use soft_floats as _;
