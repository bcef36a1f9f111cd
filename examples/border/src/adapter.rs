//! Any environment of the crate `acrobot` as an environment of `border-core`.

use std::fmt::Debug;

use acrobot::ResetOptions;
use acrobot::env::{Env, Info};
use acrobot::numpy::SeedSequence;
use anyhow::Context;
use border_core::record::Record;
use border_core::{Act, Obs, Step};

/// An environment of `acrobot` as one of border's.
#[derive(Clone, Debug)]
pub struct Adapter<E> {
    env: E,
    seed: SeedSequence,
    /// The seed, until the first reset uses it. Later initial states are the next of its stream.
    unused: Option<SeedSequence>,
}

/// An observation or an action of `acrobot`, as one of border's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct One<T>(pub T);

impl<T: Clone + Debug> Obs for One<T> {
    fn len(&self) -> usize {
        1 // environment: border can step many at once
    }
}

impl<T: Clone + Debug> Act for One<T> {
    fn len(&self) -> usize {
        1
    }
}

/// What a step reports besides the rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Told(pub Info);

impl border_core::Info for Told {}

impl<E: Env> Adapter<E> {
    fn begin(&mut self, seed: Option<SeedSequence>) -> One<E::Observation> {
        let (observation, _) = self.env.reset_with(ResetOptions {
            seed,
            ..ResetOptions::default()
        });
        One(observation)
    }
}

impl<E> border_core::Env for Adapter<E>
where
    E: Env<Observation: Clone + Debug, Action: Clone + Debug> + Clone,
{
    /// An environment to clone: border builds one to train in and another to evaluate in.
    type Config = E;
    type Obs = One<E::Observation>;
    type Act = One<E::Action>;
    type Info = Told;

    fn build(env: &E, seed: i64) -> anyhow::Result<Self> {
        let seed =
            u64::try_from(seed).with_context(|| format!("seed must be at least 0, got {seed}"))?;
        Ok(Self {
            env: env.clone(),
            seed: seed.into(),
            unused: Some(seed.into()),
        })
    }

    fn step(&mut self, action: &Self::Act) -> (Step<Self>, Record) {
        let step = self.env.step(action.0.clone());
        let step = Step::new(
            One(step.observation),
            action.clone(),
            vec![step.reward],
            vec![step.terminated.into()],
            vec![step.truncated.into()],
            Told(step.info),
            None, // border's `step_with_reset` fills in the next initial observation
        );
        (step, Record::empty())
    }

    /// border calls it only at the beginning and at ends, so `_ends` says nothing new.
    fn reset(&mut self, _ends: Option<&Vec<i8>>) -> anyhow::Result<Self::Obs> {
        let seed = self.unused.take();
        Ok(self.begin(seed))
    }

    /// Initial state number `index` of the seed, independent of earlier episodes: for evaluations.
    fn reset_with_index(&mut self, index: usize) -> anyhow::Result<Self::Obs> {
        let seed = self.seed.child(index as u64);
        Ok(self.begin(Some(seed)))
    }
}
