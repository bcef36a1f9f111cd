//! The guide: one page for each reader and each subject.
//!
//! | you write | begin with |
//! |---|---|
//! | Rust on a desktop or a server | [`rust`] |
//! | firmware | [`embedded`] |
//! | C or C++ | [`c`] |
//! | a web page | [`wasm`] |
//! | Python | [`python`], then [`python_many`] and [`python_parameters`] |
//!
//! | you want to know | read |
//! |---|---|
//! | which arithmetic to choose; units, ranges and errors | [`numbers`] |
//! | how to hold it upright, and with which motor | [`control`] |
//! | how close it is to Gymnasium | [`parity`] |
//! | how close it is to the solution of the equations | [`accuracy`] |
//! | why all machines compute the same bits, and where that ends | [`determinism`] |
//! | the equations, and their sources | [`equations`] |
//! | how another Acrobot compares itself with Gymnasium | [`ports`] |
//! | how fast it is | [`benchmarks`] |
//! | what it costs on a microcontroller | [`embedded_figures`] |
//! | how well it learns | [`learning`] |
//! | dm_control's swing-up, with friction | [`swingup`] |
//! | how well any policy can do | [`optimum`] |
//!
//! # Files
//!
//! Paths such as `examples/cortex-m` and `tests/data` are in the repository, beside the crate's source.

// Each page is also a file that GitHub shows. Its links are defined twice: for rustdoc in docs/rustdoc-links.txt, and for
// GitHub at the page's end. The first definition counts. A page whose examples need a feature is not tested without it.

#[doc = include_str!("../docs/rustdoc-links.txt")]
#[cfg_attr(any(not(doctest), feature = "std"), doc = include_str!("../docs/rust.md"))]
pub mod rust {}

#[doc = include_str!("../docs/rustdoc-links.txt")]
#[doc = include_str!("../docs/balance.txt")]
#[cfg_attr(
    any(not(doctest), all(feature = "graphics", feature = "serde")),
    doc = include_str!("../docs/embedded.md")
)]
pub mod embedded {}

macro_rules! pages {
    ($($module:ident $file:literal),* $(,)?) => {$(
        #[doc = include_str!("../docs/rustdoc-links.txt")]
        #[doc = include_str!(concat!("../docs/", $file))]
        pub mod $module {}
    )*};
}

pages! {
    embedded_figures "embedded-figures.md",
    c "c.md",
    wasm "wasm.md",
    python "python.md",
    python_many "python-many.md",
    python_parameters "python-parameters.md",
    numbers "numbers.md",
    control "control.md",
    parity "parity.md",
    accuracy "accuracy.md",
    determinism "determinism.md",
    equations "equations.md",
    ports "ports.md",
    benchmarks "benchmarks.md",
    learning "learning.md",
    swingup "swingup.md",
    optimum "optimum.md",
}

// For its tests only: its links and pictures lead into the repository.
#[cfg(doctest)]
#[cfg_attr(feature = "std", doc = include_str!("../README.md"))]
pub mod readme {}
