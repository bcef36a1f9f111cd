//! Checks that an environment keeps the contract of [`Env`].

use core::fmt;
use std::format;
use std::string::String;
use std::vec::Vec;

use super::Env;
use super::info::Info;
use crate::acrobot::Step;
use crate::action::Action;
use crate::numpy::Pcg64;

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

/// An error unless the rule `holds`.
fn require(
    holds: bool,
    rule: &'static str,
    found: impl FnOnce() -> String,
) -> Result<(), Violation> {
    holds.then_some(()).ok_or_else(|| Violation { rule, found: found() })
}

const SEED: &str = "the same seed and actions give the same episode";
const AFTER_END: &str = "a reset after the end begins a full new episode";

/// The largest number of steps of an episode.
const STEPS: usize = 2000;

type Steps = Vec<Step<Vec<f32>, Info>>;

/// Plays random episodes and checks the contract:
///
/// - Observations are in their space, and rewards are finite.
/// - The same seed gives the same episode.
/// - A reset after the end begins a full new episode, with or without a seed.
/// - A clone behaves like its original.
/// - Rendering changes nothing.
///
/// ```
/// use acrobot::env::{check_env, make};
///
/// assert!(check_env(&make("Acrobot-v1")?, 42).is_ok());
/// # Ok::<(), acrobot::env::Error>(())
/// ```
///
/// # Errors
///
/// The first [`Violation`] found.
pub fn check_env<E: Env + Clone>(env: &E, seed: u64) -> Result<(), Violation> {
    let (mut rng, space) = (Pcg64::new(seed), env.action_space());
    let actions: Vec<Action> = (0..STEPS).map(|_| space.sample(&mut rng)).collect();

    let mut played = env.clone();
    let mut otherwise_seeded = env.clone();
    otherwise_seeded.reset_with_seed(seed.wrapping_add(1));
    let first = play(&mut played, Some(seed), &actions)?;
    let again = play(&mut otherwise_seeded, Some(seed), &actions)?;
    same(SEED, &first, &again)?;

    // Both continue the same stream.
    let next = play(&mut played, None, &actions)?;
    same(SEED, &next, &play(&mut otherwise_seeded, None, &actions)?)?;
    let truncated = |steps: &Steps| steps.last().is_some_and(|step| step.truncated);
    let [len, next_len] = [first.len(), next.len()].map(|len| len - 1);
    let shortened = truncated(&first) && truncated(&next) && next_len < len;
    require(!shortened, AFTER_END, || format!("truncated after {len} and then {next_len} steps"))?;
    same(AFTER_END, &first, &play(&mut played, Some(seed), &actions)?)?;

    let (before, after) = actions.split_at(len / 2);
    let mut original = env.clone();
    play(&mut original, Some(seed), before)?;
    let mut copy = original.clone();
    let mut rendered = original.clone();
    let expected = follow(&mut original, after)?;
    same("a clone behaves like its original", &expected, &follow(&mut copy, after)?)?;

    // Whether rendering succeeds must not matter.
    let _ = rendered.render();
    same("rendering changes nothing", &expected, &follow(&mut rendered, after)?)
}

/// The reset, as a step without a reward, and the steps up to the end or to the last action.
fn play(env: &mut impl Env, seed: Option<u64>, actions: &[Action]) -> Result<Steps, Violation> {
    let observation = match seed {
        Some(seed) => env.reset_with_seed(seed),
        None => env.reset(),
    };
    in_space(env, &observation)?;
    let info = Info::default();
    let reset = Step { observation, reward: 0.0, terminated: false, truncated: false, info };
    let mut steps = follow(env, actions)?;
    steps.insert(0, reset);
    Ok(steps)
}

/// Steps to the end of the episode or to the last action.
fn follow(env: &mut impl Env, actions: &[Action]) -> Result<Steps, Violation> {
    let mut steps = Vec::new();
    for &action in actions {
        let step = env.step(action);
        in_space(env, &step.observation)?;
        let (reward, done) = (step.reward, step.done());
        require(reward.is_finite(), "rewards are finite", || format!("{reward}"))?;
        steps.push(step);
        if done {
            break;
        }
    }
    Ok(steps)
}

fn in_space(env: &impl Env, observation: &[f32]) -> Result<(), Violation> {
    let contained = env.observation_space().contains(observation);
    require(contained, "observations are in the observation space", || format!("{observation:?}"))
}

fn same(rule: &'static str, x: &Steps, y: &Steps) -> Result<(), Violation> {
    for (i, (x, y)) in x.iter().zip(y).enumerate() {
        // Infos may contain times, which differ.
        let same = Step { info: y.info, ..x.clone() } == *y;
        require(same, rule, || format!("number {i} is {x:?} and {y:?}"))?;
    }
    Ok(())
}
