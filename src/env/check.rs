//! Checks that an environment keeps the contract of [`Env`].

use core::fmt;
use std::format;
use std::string::String;
use std::vec::Vec;

use super::{Env, EnvStep, Space};
use crate::rng::Pcg64;

/// A rule that an environment broke, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Violation {
    /// The rule, as a sentence.
    pub rule: &'static str,
    /// What happened instead.
    pub found: String,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.rule, self.found)
    }
}

impl core::error::Error for Violation {}

const IN_SPACE: &str = "an observation is in the observation space";
const ACTIONS: &str = "the action space contains its samples";
const REWARD: &str = "a reward is finite";
const SEED: &str = "the same seed and the same actions give the same episode";
const AFTER_END: &str = "a reset after an end starts a whole new episode";
const CLONE: &str = "a clone does what its original would have done";
const RENDER: &str = "rendering changes nothing";

/// Episodes are followed for so many steps at the most.
const STEPS: usize = 2000;

/// Plays random episodes and checks the contract: observations and samples lie in their space, rewards are
/// finite, seeds reproduce, a reset after an end starts anew, seeded or not (so that truncation is reported at the
/// end of an episode and not again at the start of the next), clones differ only by the
/// actions they are given, and rendering changes nothing.
///
/// ```
/// use acrobot::env::check_env;
/// use acrobot::{Acrobot, Fast, TimeLimit};
///
/// check_env(&TimeLimit::v1(Acrobot::<Fast>::new(0)), 42)?;
/// # Ok::<(), acrobot::env::Violation>(())
/// ```
///
/// # Errors
///
/// The first [`Violation`] found.
pub fn check_env<E>(env: &E, seed: u64) -> Result<(), Violation>
where
    E: Env<Observation: Clone + fmt::Debug + PartialEq, Action: Clone> + Clone,
{
    let mut rng = Pcg64::new(seed);
    let space = env.action_space();
    let actions: Vec<E::Action> = (0..STEPS).map(|_| space.sample(&mut rng)).collect();
    in_space(env, &env.observation_space().sample(&mut rng))?;
    if !actions.iter().all(|action| space.contains(action)) {
        return Err(Violation {
            rule: ACTIONS,
            found: "a sample outside of it".into(),
        });
    }

    let mut played = env.clone();
    let mut otherwise_seeded = env.clone();
    otherwise_seeded.reset(Some(seed.wrapping_add(1).into()), None);
    let first = play(&mut played, Some(seed), &actions)?;
    let again = play(&mut otherwise_seeded, Some(seed), &actions)?;
    same(SEED, &first, &again)?;

    // The two have come to the same end, and go on in the same stream.
    let next = play(&mut played, None, &actions)?;
    same(SEED, &next, &play(&mut otherwise_seeded, None, &actions)?)?;
    let truncated = |episode: &Episode<_>| episode.steps.last().is_some_and(|step| step.truncated);
    if truncated(&first) && truncated(&next) && next.steps.len() < first.steps.len() {
        let found = format!(
            "truncated after {} and then {} steps",
            first.steps.len(),
            next.steps.len()
        );
        return Err(Violation {
            rule: AFTER_END,
            found,
        });
    }
    same(AFTER_END, &first, &play(&mut played, Some(seed), &actions)?)?;

    let (before, after) = actions.split_at(first.steps.len() / 2);
    let mut original = env.clone();
    original.reset(Some(seed.into()), None);
    for action in before {
        original.step(action.clone());
    }
    let mut copy = original.clone();
    let mut rendered = original.clone();
    let expected = follow(&mut original, after)?;
    same_steps(CLONE, &expected, &follow(&mut copy, after)?)?;

    // Rendering may well be refused; it must not matter.
    let _ = rendered.render();
    same_steps(RENDER, &expected, &follow(&mut rendered, after)?)
}

/// An episode, up to its end: two with the same steps have the same length, since only an end or
/// the end of the actions stops one.
struct Episode<O> {
    start: O,
    steps: Vec<EnvStep<O>>,
}

fn play<E>(
    env: &mut E,
    seed: Option<u64>,
    actions: &[E::Action],
) -> Result<Episode<E::Observation>, Violation>
where
    E: Env<Observation: Clone + fmt::Debug, Action: Clone>,
{
    let (start, _) = env.reset(seed.map(Into::into), None);
    in_space(env, &start)?;
    let steps = follow(env, actions)?;
    Ok(Episode { start, steps })
}

/// Steps to the end of the episode, or of the actions.
fn follow<E>(env: &mut E, actions: &[E::Action]) -> Result<Vec<EnvStep<E::Observation>>, Violation>
where
    E: Env<Observation: Clone + fmt::Debug, Action: Clone>,
{
    let mut steps = Vec::new();
    for action in actions {
        let step = env.step(action.clone());
        in_space(env, &step.observation)?;
        if !step.reward.is_finite() {
            return Err(Violation {
                rule: REWARD,
                found: format!("{}", step.reward),
            });
        }
        let ended = step.ended();
        steps.push(step);
        if ended {
            break;
        }
    }
    Ok(steps)
}

fn in_space<E: Env<Observation: fmt::Debug>>(
    env: &E,
    observation: &E::Observation,
) -> Result<(), Violation> {
    if env.observation_space().contains(observation) {
        return Ok(());
    }
    Err(Violation {
        rule: IN_SPACE,
        found: format!("{observation:?}"),
    })
}

fn same<O: fmt::Debug + PartialEq>(
    rule: &'static str,
    x: &Episode<O>,
    y: &Episode<O>,
) -> Result<(), Violation> {
    if x.start != y.start {
        let found = format!("starts at {:?} and at {:?}", x.start, y.start);
        return Err(Violation { rule, found });
    }
    same_steps(rule, &x.steps, &y.steps)
}

fn same_steps<O: fmt::Debug + PartialEq>(
    rule: &'static str,
    x: &[EnvStep<O>],
    y: &[EnvStep<O>],
) -> Result<(), Violation> {
    for (i, (x, y)) in x.iter().zip(y).enumerate() {
        // The info may hold times.
        let same = x.observation == y.observation
            && x.reward == y.reward
            && (x.terminated, x.truncated) == (y.terminated, y.truncated);
        if !same {
            return Err(Violation {
                rule,
                found: format!("step {} is {x:?} and {y:?}", i + 1),
            });
        }
    }
    Ok(())
}
