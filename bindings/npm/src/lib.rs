//! The WebAssembly module of the npm package `acrobot-rs`: functions that its JavaScript calls.
//!
//! JavaScript keeps the address of each acrobot and of each batch in a private field, until it
//! frees it. Other data passes through the words in `memory`, snapshots through memory of their
//! own. There a seed has `words` words of 32 bits; without any the generator continues. JavaScript
//! checks types, lengths, indices and actions, and the crate checks everything else. A setter
//! returns 0, or the kind of error, whose details are in the words.

mod many;
mod snapshot;
mod words;
