//! Any environment of the crate `acrobot` as an environment of `border-core`.

use std::fmt::Debug;

use acrobot::SeedSequence;
use acrobot::env::{Env, Info};
use anyhow::Context;
use border_core::record::Record;
use border_core::{Act, Obs, Step};

/// An environment of ours where border wants one of its own.
#[derive(Clone, Debug)]
pub struct Adapter<E> {
    env: E,
    seed: SeedSequence,
    /// The seed, until the first reset has used it; later starts are the next of its stream.
    unused: Option<SeedSequence>,
}

/// An observation or an action of ours, marked as one of border's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct One<T>(pub T);

impl<T: Clone + Debug> Obs for One<T> {
    fn len(&self) -> usize {
        1 // environment, not numbers: border allows for many at once
    }
}

impl<T: Clone + Debug> Act for One<T> {
    fn len(&self) -> usize {
        1
    }
}

/// What a step tells beside the rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Told(pub Info);

impl border_core::Info for Told {}

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
            u64::try_from(seed).with_context(|| format!("a seed is not negative: {seed}"))?;
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
            None, // `step_with_reset` of border fills in the next start
        );
        (step, Record::empty())
    }

    /// Border asks for it at the beginning and at ends only, so that there is nothing to look up
    /// in the ends.
    fn reset(&mut self, _ends: Option<&Vec<i8>>) -> anyhow::Result<Self::Obs> {
        let (observation, _) = self.env.reset(self.unused.take(), None);
        Ok(One(observation))
    }

    /// Start number `index` of the seed, whatever was played before: an evaluation's episodes.
    fn reset_with_index(&mut self, index: usize) -> anyhow::Result<Self::Obs> {
        let (observation, _) = self.env.reset(Some(self.seed.child(index as u64)), None);
        Ok(One(observation))
    }
}
