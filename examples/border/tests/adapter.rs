//! What border gets through the adapter is what the environment gives.

use std::num::NonZeroU32;

use acrobot::env::{Env as _, EnvStep, RecordEpisodeStatistics};
use acrobot::{Acrobot, Action, Observation, Portable, SeedSequence, TimeLimit};
use acrobot_border::{Adapter, One};
use border_core::Env as _;

type Env = RecordEpisodeStatistics<TimeLimit<Acrobot<Portable>>>;

const SEED: i64 = 42;

fn env(limit: u32) -> Env {
    let limit = NonZeroU32::new(limit).unwrap();
    RecordEpisodeStatistics::new(TimeLimit::new(Acrobot::new(7), limit))
}

/// Pumps energy: the torque goes with the velocity between the links.
fn pump(observation: &Observation) -> Action {
    match observation[5] {
        velocity if velocity > 0.0 => Action::Positive,
        _ => Action::Negative,
    }
}

/// How often an episode was terminated only, truncated only, and both at once.
type Ends = [u32; 3];

/// Plays `steps` steps beside each other, over ends and resets, and compares them.
fn compare(limit: u32, steps: u32, policy: fn(&Observation) -> Action) -> Ends {
    let mut ours = env(limit);
    let mut theirs = Adapter::build(&env(limit), SEED).unwrap();

    let (mut start, _) = ours.reset(Some(42.into()), None);
    assert_eq!(theirs.reset(None).unwrap(), One(start));
    let mut ends = [0; 3];
    for _ in 0..steps {
        let action = policy(&start);
        let EnvStep {
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
        start = match end {
            None => observation,
            Some(end) => {
                ends[end] += 1;
                ours.reset(None, None).0
            }
        };
        assert_eq!(step.init_obs, end.map(|_| One(start)));
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
    let (mut observation, _) = env.reset(Some(42.into()), None);
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
fn an_index_is_a_start_whatever_was_played_before() {
    let mut theirs = Adapter::build(&env(500), SEED).unwrap();
    let first = theirs.reset_with_index(3).unwrap();
    theirs.step(&One(Action::Positive));
    let other = theirs.reset_with_index(4).unwrap();
    assert_ne!(first, other);
    assert_eq!(theirs.reset_with_index(3).unwrap(), first);

    let seed = SeedSequence::from(42).child(3);
    assert_eq!(first, One(env(500).reset(Some(seed), None).0));
}

#[test]
fn refuses_a_negative_seed() {
    let error = Adapter::build(&env(500), -1).unwrap_err();
    assert_eq!(error.to_string(), "a seed is not negative: -1");
}
