#![doc = include_str!("../docs/rustdoc-links.txt")]
#![doc = include_str!("../docs/README.md")]

// Each page is also a file that GitHub shows. Its links are defined twice: for rustdoc in
// docs/rustdoc-links.txt, and for GitHub at the page's end. The first definition counts. A page
// whose examples need a feature is not tested without it.

#[doc = include_str!("../docs/rustdoc-links.txt")]
#[cfg_attr(any(not(doctest), feature = "std"), doc = include_str!("../docs/rust.md"))]
pub mod rust {}

#[doc = include_str!("../docs/rustdoc-links.txt")]
#[cfg_attr(any(not(doctest), feature = "serde"), doc = include_str!("../docs/embedded-topics.md"))]
pub mod embedded_topics {}

#[doc = include_str!("../docs/rustdoc-links.txt")]
#[cfg_attr(any(not(doctest), feature = "alloc"), doc = include_str!("../docs/tasks.md"))]
pub mod tasks {}

#[doc = include_str!("../docs/rustdoc-links.txt")]
#[doc = include_str!("../docs/control.md")]
pub mod control {}

macro_rules! pages {
    ($($module:ident $file:literal),* $(,)?) => {$(
        #[doc = include_str!("../docs/rustdoc-links.txt")]
        #[doc = include_str!(concat!("../docs/", $file))]
        pub mod $module {}
    )*};
}

pages! {
    embedded "embedded.md",
    embedded_figures "embedded-figures.md",
    c "c.md",
    wasm "wasm.md",
    python "python.md",
    python_control "python-control.md",
    python_firmware "python-firmware.md",
    python_many "python-many.md",
    python_parameters "python-parameters.md",
    languages "languages.md",
    numbers "numbers.md",
    parity "parity.md",
    accuracy "accuracy.md",
    determinism "determinism.md",
    equations "equations.md",
    benchmarks "benchmarks.md",
    learning "learning.md",
    real "real.md",
    swingup "swingup.md",
    realaigym "realaigym.md",
    optimum "optimum.md",
}

// For its tests only: its links and pictures lead into the repository.
#[cfg(doctest)]
#[cfg_attr(feature = "std", doc = include_str!("../README.md"))]
pub mod readme {}
