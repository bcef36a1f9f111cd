//! What several of the programs share.

#![no_std]

pub mod counter;
pub mod episode;
pub mod minimal;
pub mod panel;
