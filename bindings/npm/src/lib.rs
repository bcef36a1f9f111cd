//! The WebAssembly module of the npm package `acrobot-rs`: functions that its JavaScript calls.
//!
//! JavaScript keeps the address of each acrobot and of each batch in a private field, until it
//! frees it. Other data passes through the words in `memory`, snapshots through memory of their
//! own. There a seed has `words` words of 32 bits; without any the generator continues. JavaScript
//! checks types, lengths, indices and actions, and the crate checks everything else. A setter
//! returns 0, or the kind of error, whose details are in the words.

mod many;
mod single;
mod snapshot;
mod words;

/// What has another type for each task.
pub enum Tasks<A, B, C> {
    Acrobot(A),
    Swingup(B),
    Balance(C),
}

impl<A, B, C> Tasks<A, B, C> {
    /// JavaScript's number of the task.
    pub fn number(&self) -> u32 {
        match self {
            Self::Acrobot(_) => 0,
            Self::Swingup(_) => 1,
            Self::Balance(_) => 2,
        }
    }
}

/// Does something with what an enum [`Tasks`] has, whatever the task.
macro_rules! with_task {
    ($tasks:expr, $of:ident => $result:expr) => {
        match $tasks {
            $crate::Tasks::Acrobot($of) => $result,
            $crate::Tasks::Swingup($of) => $result,
            $crate::Tasks::Balance($of) => $result,
        }
    };
}
pub(crate) use with_task;
