//! Code that several of the programs share.

#![no_std]

pub mod counter;
pub mod episode;
pub mod micromath;
#[cfg(target_arch = "arm")]
pub mod minimal;
pub mod panel;
