//! Code that several of the programs share.

#![no_std]

pub mod counter;
pub mod micromath;
#[cfg(target_arch = "arm")]
pub mod minimal;
pub mod panel;
