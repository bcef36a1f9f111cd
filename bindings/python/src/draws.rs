//! The parameters that each reset draws.

use std::collections::BTreeMap;

use acrobot::numpy::{Pcg64, uniform};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{NUMBERS, Params, fields};

/// How a parameter is drawn between its bounds, between which the mean must be.
#[derive(Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Distribution {
    Uniform,
    LogUniform,
    Normal { mean: f64, std: f64 },
}

impl Distribution {
    /// That of an object in Python.
    pub fn of(drawn: &Bound<'_, PyAny>) -> PyResult<Self> {
        let number = |name| drawn.getattr(name)?.extract();
        let kind: String = drawn.getattr("kind")?.extract()?;
        Ok(match kind.as_str() {
            "Normal" => Self::Normal { mean: number("mean")?, std: number("std")? },
            "LogUniform" => Self::LogUniform,
            _ => Self::Uniform,
        })
    }

    /// Draws with the same bits on all machines.
    fn draw(self, rng: &mut Pcg64, low: f64, high: f64) -> f64 {
        let drawn = match self {
            _ if low == high => low, // as in the crate
            Self::Uniform => uniform(rng, low, high),
            Self::LogUniform => libm::exp(uniform(rng, libm::log(low), libm::log(high))),
            Self::Normal { mean, std } => {
                // One of 10^15 draws would be farther from the mean.
                let (low, high) = (low.max(mean - 8.0 * std), high.min(mean + 8.0 * std));
                // A uniform draw is accepted by the density: one in seven. Only a generator or
                // bounds that always give the same number get to the end.
                let accepted = (0..1000).find_map(|_| {
                    let drawn = uniform(rng, low, high);
                    let z = (drawn - mean) / std;
                    (uniform(rng, 0.0, 1.0) < libm::exp(-0.5 * z * z)).then_some(drawn)
                });
                accepted.unwrap_or(mean)
            }
        };
        drawn.max(low).min(high)
    }
}

/// The parameters that each reset draws.
#[derive(Clone, Default, Serialize, Deserialize)]
pub struct Draws {
    /// By Python's names of the parameters.
    pub distributions: BTreeMap<String, Distribution>,
    /// The bounds of these parameters. The others have no meaning.
    pub bounds: [Params; 2],
}

impl Draws {
    /// These parameters with each drawn one at its lower and at its upper bound.
    pub fn ends(&self, params: Params) -> [Params; 2] {
        self.bounds.map(|mut bound| {
            let mut end = params;
            for field in self.distributions.keys().flat_map(|name| fields(name)) {
                *field(&mut end) = *field(&mut bound);
            }
            end
        })
    }

    /// Draws in the order of `NUMBERS`.
    pub fn draw(&self, mut params: Params, rng: &mut Pcg64) -> Params {
        let [mut low, mut high] = self.bounds;
        for (name, own, field) in &NUMBERS {
            if let Some(how) = self.distributions.get(*name) {
                *field(&mut params) = if (*name, *own) == ("LINK_MOI", "inertia2") {
                    params.inertia1 // of both links
                } else {
                    how.draw(rng, *field(&mut low), *field(&mut high))
                };
            }
        }
        params
    }
}
