//! The adapter passes border everything that the environment returns.

use std::num::NonZeroU32;

use acrobot::env::{AcrobotEnv, Env as _, RecordEpisodeStatistics};
use acrobot::numpy::SeedSequence;
use acrobot::{Action, Observation, Portable, ResetOptions, Step, TimeLimit};
use acrobot_border::{Adapter, One};
use border_core::Env as _;

type Env = RecordEpisodeStatistics<TimeLimit<AcrobotEnv<Portable, Observation>>>;

const SEED: i64 = 42;

fn env(limit: u32) -> Env {
    let limit = NonZeroU32::new(limit).unwrap();
    RecordEpisodeStatistics::new(TimeLimit::new(AcrobotEnv::default(), limit))
}

/// Pumps energy: the torque follows the velocity of link 2.
fn pump(observation: &Observation) -> Action {
    match observation.dtheta2() > 0.0 {
        true => Action::Positive,
        false => Action::Negative,
    }
}

/// The numbers of episodes that were only terminated, only truncated, and both.
type Ends = [u32; 3];

/// Steps an environment and its adapted twin `steps` times, across ends and resets, and compares them.
fn compare(limit: u32, steps: u32, policy: fn(&Observation) -> Action) -> Ends {
    let mut ours = env(limit);
    let mut theirs = Adapter::build(&env(limit), SEED).unwrap();

    let (mut seen, _) = ours.reset_with_seed(42);
    assert_eq!(theirs.reset(None).unwrap(), One(seen));
    let mut ends = [0; 3];
    for _ in 0..steps {
        let action = policy(&seen);
        let Step {
            observation,
            reward,
            terminated,
            truncated,
            info,
        } = ours.step(action);
        let (step, record) = theirs.step_with_reset(&One(action));
        assert_eq!(step.act, One(action));
        assert_eq!(step.obs, One(observation));
        assert_eq!(step.reward, [reward]);
        assert_eq!(step.is_terminated, [i8::from(terminated)]);
        assert_eq!(step.is_truncated, [i8::from(truncated)]);
        assert!(record.is_empty());
        let episode = step.info.0.episode.map(|x| (x.length, x.episode_return));
        assert_eq!(episode, info.episode.map(|x| (x.length, x.episode_return)));

        let end = match (terminated, truncated) {
            (false, false) => None,
            (true, false) => Some(0),
            (false, true) => Some(1),
            (true, true) => Some(2),
        };
        seen = match end {
            None => observation,
            Some(end) => {
                ends[end] += 1;
                ours.reset().0
            }
        };
        assert_eq!(step.init_obs, end.map(|_| One(seen)));
        assert_eq!(step.is_done(), end.is_some());
    }
    ends
}

#[test]
fn passes_terminations_through() {
    let [terminated, truncated, both] = compare(500, 2000, pump);
    assert!(terminated >= 3, "{terminated}");
    assert_eq!((truncated, both), (0, 0));
}

#[test]
fn passes_truncations_through() {
    assert_eq!(compare(100, 1000, |_| Action::Zero), [0, 10, 0]);
}

#[test]
fn passes_both_at_once_through() {
    let mut env = env(500);
    let (mut observation, _) = env.reset_with_seed(42);
    let length = loop {
        let step = env.step(pump(&observation));
        observation = step.observation;
        if let Some(episode) = step.info.episode {
            assert!(step.terminated);
            break episode.length;
        }
    };
    assert_eq!(compare(length, length, pump), [0, 0, 1]);
}

#[test]
fn an_index_gives_the_same_initial_state_whatever_was_played_before() {
    let mut theirs = Adapter::build(&env(500), SEED).unwrap();
    let first = theirs.reset_with_index(3).unwrap();
    theirs.step(&One(Action::Positive));
    let other = theirs.reset_with_index(4).unwrap();
    assert_ne!(first, other);
    assert_eq!(theirs.reset_with_index(3).unwrap(), first);

    let options = ResetOptions {
        seed: Some(SeedSequence::new(42).child(3)),
        ..ResetOptions::default()
    };
    assert_eq!(first, One(env(500).reset_with(options).0));
}

#[test]
fn rejects_a_negative_seed() {
    let error = Adapter::build(&env(500), -1).unwrap_err();
    assert_eq!(error.to_string(), "seed must be at least 0, got -1");
}
