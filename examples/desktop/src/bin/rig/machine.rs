//! A machine in a file.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

use acrobot::Params;
use acrobot::control::mpc::Settings;
use anyhow::{Context, bail};
use machine::Hardware;
use serde::{Deserialize, Serialize};

/// What a file such as `realaigym.toml` has.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rig {
    /// The motor's largest torque, N m.
    pub limit: f32,
    /// The counts of each encoder for a turn.
    pub counts: [i32; 2],
    /// What they count where the machine hangs.
    #[serde(default)]
    pub zeros: [i32; 2],
    /// From a torque until it acts, s.
    #[serde(default)]
    pub delay: f32,
    /// How old a plan may be, s.
    #[serde(default = "second")]
    pub plan_timeout: f32,
    /// By the names of `Params`, in SI units. `dt` is the time of a tick.
    params: BTreeMap<String, f64>,
}

fn second() -> f32 {
    1.0
}

/// The parameters that a file need not have.
const OTHERS: Params = Params {
    gravity: 9.81,
    max_velocity1: f64::INFINITY,
    max_velocity2: f64::INFINITY,
    damping1: 0.0,
    damping2: 0.0,
    ..Params::DEFAULT
};

impl Rig {
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let read = || {
            let rig: Self = toml::from_str(&fs::read_to_string(path)?)?;
            rig.params()?.validate()?;
            Ok::<_, anyhow::Error>(rig)
        };
        read().with_context(|| format!("cannot read {}", path.display()))
    }

    pub fn params(&self) -> anyhow::Result<Params> {
        let mut params = OTHERS;
        let names: Vec<&str> = OTHERS.numbers().map(|(name, _)| name).into();
        if let Some(unknown) = self.params.keys().find(|key| !names.contains(&key.as_str())) {
            bail!("there is no parameter {unknown}; there are: {}", names.join(", "));
        }
        for (name, place) in names.into_iter().zip(params.numbers_mut()) {
            *place = self.params.get(name).copied().unwrap_or(*place);
        }
        Ok(params)
    }

    pub fn with_params(mut self, params: Params) -> Self {
        let numbers = params.numbers().into_iter().zip(OTHERS.numbers());
        let changed = numbers.filter(|((_, value), (_, other))| value != other);
        self.params = changed.map(|((name, value), _)| (name.into(), value)).collect();
        self
    }

    pub fn settings(&self) -> anyhow::Result<Settings> {
        let Self { limit, counts, delay, plan_timeout, .. } = *self;
        Ok(Settings { params: self.params()?.cast(), limit, counts, delay, plan_timeout })
    }

    /// The machine to play: its torque errs by 0.3 % of the largest.
    pub fn hardware(&self) -> anyhow::Result<Hardware> {
        let angle = |i: usize| f64::from(self.zeros[i]) / f64::from(self.counts[i]) * TAU;
        Ok(Hardware {
            params: self.params()?,
            limit: self.limit.into(),
            counts: self.counts,
            zeros: [angle(0), angle(1)],
            delay: self.delay.into(),
            lag: 0.0,
            torque_factor: 1.0,
            torque_std: 0.003 * f64::from(self.limit),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As in the pages' table.
    #[test]
    fn the_file_has_realaigyms_machine() {
        let rig = Rig::read(Path::new("realaigym.toml")).unwrap();
        let (found, expected) = (rig.hardware().unwrap().params, Hardware::realaigym().params);
        for ((name, found), (_, expected)) in found.numbers().into_iter().zip(expected.numbers()) {
            assert!(found == expected || (found - expected).abs() < 1e-15, "{name} {found}");
        }
    }
}
