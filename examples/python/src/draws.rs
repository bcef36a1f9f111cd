//! The parameters that each reset draws, and the draws that the crate does not have.

use std::collections::BTreeMap;

use acrobot::Params;
use acrobot::numpy::{Pcg64, uniform};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{NUMBERS, fields};

/// How a parameter is drawn between its bounds.
#[derive(Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Distribution {
    Uniform,
    LogUniform,
    Normal { mean: f64, std: f64 },
}

impl Distribution {
    /// That of an object of a Python class with the same name.
    pub fn of(drawn: &Bound<'_, PyAny>) -> PyResult<Self> {
        let kind: String = drawn.getattr("_KIND")?.extract()?;
        Ok(match &*kind {
            "Normal" => Self::Normal {
                mean: drawn.getattr("mean")?.extract()?,
                std: drawn.getattr("std")?.extract()?,
            },
            "LogUniform" => Self::LogUniform,
            _ => Self::Uniform,
        })
    }

    fn draw(self, rng: &mut Pcg64, low: f64, high: f64) -> f64 {
        let drawn = match self {
            // As in the crate.
            _ if low == high => low,
            Self::Uniform => uniform(rng, low, high),
            Self::LogUniform => libm::exp(uniform(rng, libm::log(low), libm::log(high))),
            Self::Normal { mean, std } => normal(rng, mean, std, low, high),
        };
        drawn.max(low).min(high)
    }
}

/// A normal draw between bounds, which the mean must be between: a uniform draw, accepted with a probability
/// proportional to the density. All bits of `libm` are the same on all machines.
fn normal(rng: &mut Pcg64, mean: f64, std: f64, low: f64, high: f64) -> f64 {
    // One of 10^15 draws would be farther away.
    let (low, high) = (low.max(mean - 8.0 * std), high.min(mean + 8.0 * std));
    // One in seven is accepted, so only a broken generator or a width that rounds to 0 gets to the end.
    for _ in 0..1000 {
        let drawn = uniform(rng, low, high);
        let z = (drawn - mean) / std;
        if uniform(rng, 0.0, 1.0) < libm::exp(-0.5 * z * z) {
            return drawn;
        }
    }
    mean
}

/// The parameters that each reset draws.
#[derive(Clone, Default, Serialize, Deserialize)]
pub struct Draws {
    /// The distributions, by Gymnasium's names of the parameters.
    pub distributions: BTreeMap<String, Distribution>,
    /// The bounds of these parameters. The others in them have no meaning.
    pub low: Params,
    pub high: Params,
}

impl Draws {
    /// These parameters with each drawn one at its lower and at its upper bound.
    pub fn ends(&self, params: Params) -> [Params; 2] {
        [self.low, self.high].map(|mut bound| {
            let mut end = params;
            for field in self.distributions.keys().flat_map(|name| fields(name)) {
                *field(&mut end) = *field(&mut bound);
            }
            end
        })
    }

    /// Whether the crate can draw them.
    pub fn are_uniform(&self) -> bool {
        // It would draw another LINK_MOI for each link.
        let mut distributions = self.distributions.iter();
        distributions.all(|(name, how)| *how == Distribution::Uniform && name != "LINK_MOI")
    }

    /// Draws in the order of the table, which is the crate's.
    pub fn draw(&self, mut params: Params, rng: &mut Pcg64) -> Params {
        let (mut low, mut high) = (self.low, self.high);
        // Gymnasium has one moment of inertia for both links.
        for (name, _, field) in NUMBERS.iter().filter(|(_, own, _)| *own != "inertia2") {
            if let Some(how) = self.distributions.get(*name) {
                *field(&mut params) = how.draw(rng, *field(&mut low), *field(&mut high));
            }
        }
        params.inertia2 = params.inertia1;
        params
    }
}
