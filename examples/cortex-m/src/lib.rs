//! What several of the programs share.

#![no_std]

pub mod counter;
pub mod minimal;
pub mod panel;
