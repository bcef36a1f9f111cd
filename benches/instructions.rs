//! Counts the instructions of a step for CI. callgrind gives the same count in every run.
//!
//! ```text
//! cargo bench -p benches --bench instructions    # needs the system's valgrind
//! ```
//!
//! It fails if a count exceeds its limit: the measured count plus 5 % for new compilers. It needs
//! x86-64 with AVX2; valgrind does not support AVX-512.

use std::env;
use std::hint::black_box;
use std::process::Command;

use acrobot::arithmetic::{Arithmetic, Micro, Reference};
use acrobot::batch::SimdLevel::{self, Avx2, Baseline};
use acrobot::batch::VecBatch;
use acrobot::numpy::Pcg64;
use acrobot::task::Task;
use acrobot::{Acrobot, Action, Fast, Portable, TimeLimit};
use benches::{Play, measured};

/// About two episodes of a random policy, with their resets.
const STEPS: usize = 1000;
const ACROBOTS: usize = 64;

/// What is counted: its name, its instructions per step of an acrobot, and the program.
const COUNTS: &[(&str, f64, fn())] = &[
    ("Reference", 1870.0, alone::<Reference>),
    ("Portable", 906.0, alone::<Portable>),
    ("Fast", 647.0, alone::<Fast>),
    ("Micro", 491.0, alone::<Micro>),
    ("batch of Fast", 246.0, || batch::<Fast>(Baseline, false)),
    ("batch of Fast, AVX2", 111.0, || batch::<Fast>(Avx2, false)),
    ("batch of Fast, observed", 263.0, || batch::<Fast>(Baseline, true)),
    ("batch of Fast, observed, AVX2", 121.0, || batch::<Fast>(Avx2, true)),
    ("batch of Portable", 816.0, || batch::<Portable>(Baseline, false)),
    ("batch of Portable, AVX2", 345.0, || batch::<Portable>(Avx2, false)),
    ("batch of Fast, measured", 486.0, || measure(Baseline)),
    ("batch of Fast, measured, AVX2", 220.0, || measure(Avx2)),
    // It compiles as long as the others together, so CI counts it at night.
    #[cfg(feature = "long")]
    ("batch of Reference, AVX2", 676.0, || batch::<Reference>(Avx2, false)),
];

/// callgrind counts this function and what it calls, without what comes before and after.
#[inline(never)]
fn counted(steps: &mut dyn FnMut()) {
    steps();
}

fn alone<A: Arithmetic>() {
    let mut rng = Pcg64::new(0);
    let actions: Vec<_> = (0..STEPS).map(|_| Action::sample(&mut rng)).collect();
    let mut acrobot = TimeLimit::with_task_limit(Acrobot::<A>::new(0));
    counted(&mut || {
        for &action in &actions {
            if black_box(acrobot.step(action)).is_done() {
                acrobot.reset();
            }
        }
    });
}

fn batch<A: Arithmetic>(level: SimdLevel, observe: bool) {
    play(Play::<A>::new(ACROBOTS), level, observe);
}

fn measure(level: SimdLevel) {
    let batch = VecBatch::<Fast, _>::with_task(0, measured(), ACROBOTS);
    play(Play::from(batch.expect("memory for the batch")), level, true);
}

fn play<A: Arithmetic, T: Task>(mut play: Play<A, T>, level: SimdLevel, observe: bool) {
    assert!(level.is_available(), "this machine has no {level:?}");
    play.batch.set_simd_level(level);
    counted(&mut || {
        for _ in 0..STEPS {
            play.play(observe);
        }
    });
}

/// The instructions of a program, which this program runs when it is called with its name.
fn count(name: &str) -> f64 {
    let callgrind = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg("--toggle-collect=instructions::counted*")
        .arg(env::current_exe().expect("the path of this program"))
        .arg(name)
        .output()
        .expect("valgrind runs");
    let log = String::from_utf8_lossy(&callgrind.stderr);
    let count = log.split("Collected : ").nth(1).and_then(|rest| rest.lines().next()?.parse().ok());
    count
        .filter(|&count| count > 0.0 && callgrind.status.success())
        .unwrap_or_else(|| panic!("{log}"))
}

fn main() {
    let argument = env::args().nth(1).expect("a name, or --bench from Cargo");
    if let Some((_, _, program)) = COUNTS.iter().find(|(name, ..)| *name == argument) {
        return program();
    }
    let mut exceeded = Vec::new();
    for (name, expected, _) in COUNTS {
        let acrobots = if name.starts_with("batch") { ACROBOTS } else { 1 };
        let instructions = count(name) / (STEPS * acrobots) as f64;
        println!("{name:30} {instructions:6.1} instructions a step, expected {expected}");
        if instructions > expected * 1.05 {
            exceeded.push(name);
        }
    }
    assert!(exceeded.is_empty(), "more than 5 % above what is expected: {exceeded:?}");
}
