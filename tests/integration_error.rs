//! Promise 1, Gymnasium's numbers: the error of its integration against that of `data/truth.py`.

use std::sync::LazyLock;

use acrobot::arithmetic::{Arithmetic, Real};
use acrobot::physics::{Dynamics, Pendulum};
use acrobot::{Fast, Params, Portable, State};
use common::{assert_says, distance, dynamics_of, lines, numbers};

/// A run under torques that last 0.2 s each.
struct Run {
    dynamics: Dynamics,
    start: &'static str,
    state: State,
    torques: Vec<f64>,
    after: Vec<Row>,
}

struct Row {
    seconds: u32,
    state: State,
    /// How far the recorded state can be from the solution.
    uncertainty: f64,
}

static RUNS: LazyLock<Vec<Run>> = LazyLock::new(|| {
    let text = include_str!("data/truth.txt");
    let number = |bits: &str| f64::from_bits(u64::from_str_radix(bits, 16).unwrap());
    let state = |words: &[&str]| State::from(std::array::from_fn(|i| number(words[i])));
    let runs = text.split("\nstart ").skip(1).map(|run| {
        let mut rows = run.lines().map(|line| line.split(' ').collect::<Vec<_>>());
        let start = rows.next().unwrap();
        let mut torques = lines(text, "torques");
        let torques = torques.find_map(|line| line.strip_prefix(start[2])).unwrap();
        Run {
            dynamics: dynamics_of(start[0]),
            start: start[1],
            torques: numbers(torques.trim_start()),
            state: state(&start[3..]),
            after: rows
                .map(|row| Row {
                    seconds: row[1].parse().unwrap(),
                    state: state(&row[2..]),
                    uncertainty: row[6].parse().unwrap(),
                })
                .collect(),
        }
    });
    runs.collect()
});

impl Run {
    /// The pendulum at the beginning, with steps of 0.2 s / `parts`.
    fn pendulum<A: Arithmetic>(&self, parts: u32) -> Pendulum<A> {
        let params = Params {
            dt: 0.2 / f64::from(parts),
            // No bounds: only the integration is measured.
            max_velocity1: f32::MAX.into(),
            max_velocity2: f32::MAX.into(),
            dynamics: self.dynamics,
            ..Params::DEFAULT
        };
        Pendulum::new(params.cast(), self.state.cast()).unwrap()
    }

    /// The largest change of the energy in 100 s without a torque, J.
    fn drift<A: Arithmetic>(&self, parts: u32) -> f64 {
        let mut pendulum = self.pendulum::<A>(parts);
        let first = pendulum.energy();
        (0..500 * parts).fold(0.0, |drift: f64, _| {
            pendulum.step(Real::from_f64(0.0)).unwrap();
            drift.max((pendulum.energy().to_f64() - first.to_f64()).abs())
        })
    }

    fn errors<A: Arithmetic>(&self, parts: u32) -> Vec<f64> {
        let mut pendulum = self.pendulum::<A>(parts);
        let mut errors = Vec::new();
        let mut rows = self.after.iter().peekable();
        for (held, &torque) in (1..).zip(&self.torques) {
            for _ in 0..parts {
                pendulum.step(Real::from_f64(torque)).unwrap();
            }
            if let Some(row) = rows.next_if(|row| row.seconds * 5 == held) {
                errors.push(distance(pendulum.state().cast(), row.state));
            }
        }
        assert!(rows.next().is_none());
        errors
    }
}

/// The larger error of the two runs, which differ in their torques.
fn worst<A: Arithmetic>(dynamics: Dynamics, start: &str, parts: u32) -> Vec<f64> {
    RUNS.iter()
        .filter(|run| run.dynamics == dynamics && run.start == start)
        .map(|run| run.errors::<A>(parts))
        .reduce(|x, y| x.into_iter().zip(y).map(|(x, y)| x.max(y)).collect())
        .unwrap()
}

/// Steps for each torque of 0.2 s.
const PARTS: [u32; 4] = [1, 2, 4, 20];

#[test]
fn errors_are_as_the_docs_say() {
    let mut rows = Vec::new();
    for dynamics in [Dynamics::Book, Dynamics::Nips] {
        for parts in PARTS {
            let mut row = format!("| `{dynamics:?}` | {} |", 0.2 / f64::from(parts));
            for start in ["rest", "fast"] {
                for error in worst::<Portable>(dynamics, start, parts) {
                    row += &format!(" {error:.1e} |");
                }
            }
            rows.push(row);
        }
    }
    assert_says("docs/accuracy.md", &rows.join("\n"));
}

/// The book's equations keep the energy.
#[test]
fn energies_drift_as_the_docs_say() {
    let rows = PARTS.map(|parts| {
        let mut row = format!("| {} |", 0.2 / f64::from(parts));
        for start in ["rest", "fast"] {
            let run = RUNS.iter().find(|run| run.start == start).unwrap();
            assert_eq!(run.dynamics, Dynamics::Book);
            let [portable, fast] = [run.drift::<Portable>(parts), run.drift::<Fast>(parts)];
            row += &format!(" {portable:.1e} | {fast:.1e} |");
        }
        row
    });
    assert_says("docs/accuracy.md", &rows.join("\n"));
}

/// The measured errors are therefore those of the method, not of the recorded states.
#[test]
fn the_truth_is_known_far_better_than_the_error() {
    let mut worst = 0.0_f64;
    for run in RUNS.iter() {
        for (error, row) in run.errors::<Portable>(20).into_iter().zip(&run.after) {
            assert!(row.uncertainty * 1e4 <= error);
            worst = worst.max(row.uncertainty);
        }
    }
    assert_says("docs/accuracy.md", &format!("known to {worst:.1e}"));
}

/// In `f32` rounding is small compared with the method's error at Gymnasium's dt, and dominates at
/// 0.01 s.
#[test]
fn single_precision_is_as_good_as_the_docs_say() {
    let (mut excess, mut least, mut most) = (0.0_f64, f64::INFINITY, 0.0_f64);
    for run in RUNS.iter() {
        let [fast, portable] = [run.errors::<Fast>(1), run.errors::<Portable>(1)];
        for (fast, portable) in fast.iter().zip(portable) {
            excess = excess.max((fast / portable - 1.0).abs());
        }
        let after_a_second = run.errors::<Fast>(20)[0];
        (least, most) = (least.min(after_a_second), most.max(after_a_second));
    }
    assert_says(
        "docs/accuracy.md",
        &format!(
            "`Fast` has the same errors within {:.1} % at 0.2 s, and after 1 s at 0.01 s \
            {least:.1e} to {most:.1e}",
            excess * 100.0
        ),
    );
}
