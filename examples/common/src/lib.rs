//! What several example programs share.

pub mod animation;
pub mod exit;
pub mod files;
pub mod heat_map;
pub mod svg;
pub mod weights;
