//! Environments: Gymnasium's runs, wrappers and spaces.

use std::f32::consts::PI;

use acrobot::arithmetic::{Damped, Host};
use acrobot::env::{BoxSpace, Env};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::task::{Balance, GymnasiumV0, ResetBounds, Swingup};
use acrobot::{Acrobot, Action, Fast, Params, ResetOptions, TimeLimit};
use common::{Digest, is_recorded_library, lines};

#[test]
fn environments_play_gymnasiums_runs() {
    if !is_recorded_library() {
        return;
    }
    let mut played = 0;
    for row in lines(include_str!("data/seeds.txt"), "play") {
        let [id, seed, digest, episodes] = row.split(' ').collect::<Vec<_>>().try_into().unwrap();
        let mut env: Box<dyn Env> = match id {
            "Acrobot-v0" => {
                Box::new(TimeLimit::with_task_limit(Acrobot::<Host, GymnasiumV0>::new(0)))
            }
            _ => Box::new(TimeLimit::with_task_limit(Acrobot::<Host>::new(0))),
        };
        let sequence: SeedSequence = seed.parse().unwrap();
        let mut actions = Pcg64::from(sequence.clone());
        env.reset_with(ResetOptions { seed: Some(sequence), ..ResetOptions::default() });
        let (mut found, mut ends) = (Digest::default(), 0);
        for _ in 0..1000 {
            let step = env.step(Action::sample(&mut actions));
            for x in &step.observation {
                found.add(x.to_bits().into());
            }
            found.add((step.reward == 0.0).into());
            found.add(step.terminated.into());
            found.add(step.truncated.into());
            if step.is_done() {
                ends += 1;
                env.reset();
            }
        }
        assert_eq!(format!("{:016x}", found.0), digest, "{id}, seed {seed}");
        assert_eq!(ends.to_string(), episodes, "{id}, seed {seed}");
        played += 1;
    }
    assert_eq!(played, 20, "rows `play` in tests/data/seeds.txt: edit this count");
}

#[test]
fn wrappers_fit_any_acrobot() {
    let mut alone = Acrobot::<Damped<Fast>, Swingup>::new(1);
    let boxed: Box<dyn Env> = Box::new(TimeLimit::new(alone.clone(), 200.try_into().unwrap()));
    let mut env = TimeLimit::new(boxed, 500.try_into().unwrap());
    assert_eq!(env.observation_space().high(), [1.0, 1.0, 1.0, 1.0, 1e30, 1e30]);
    for seed in [7, 8] {
        assert_eq!(env.reset_with_seed(seed), alone.reset_with_seed(seed));
        for i in 1..=200 {
            let (step, expected) = (env.step(Action::Positive), alone.step(Action::Positive));
            assert_eq!(step.observation, expected.observation);
            assert_eq!((step.reward, step.terminated), (expected.reward, expected.terminated));
            assert_eq!(step.truncated, i == 200, "the shorter of two limits");
        }
    }
    let bounds = ResetBounds::new(0.5, 0.5).unwrap();
    assert_eq!(env.reset_with(bounds.into()), alone.reset_with(bounds.into()));
}

#[test]
fn spaces_are_gymnasiums_and_know_their_elements() {
    let mut acrobot = Acrobot::<Fast>::new(0);
    let space = acrobot.observation_space();
    // As Gymnasium prints it: 4π and 9π in f32.
    let high = [1.0, 1.0, 1.0, 1.0, 12.566_371, 28.274_334];
    assert_eq!(space.high(), high);
    assert_eq!(space.low(), high.map(|x| -x));
    assert_eq!(Acrobot::<Fast, Balance>::new(0).observation_space(), space);
    let angles = Acrobot::<Fast, GymnasiumV0>::new(0).observation_space();
    assert_eq!(angles.high(), [PI, PI, high[4], high[5]]);
    assert!(space.contains(space.low()) && space.contains(space.high()));
    for number in [high[5].next_up(), -high[5].next_up(), f32::NAN] {
        let mut outside = high;
        outside[5] = number;
        assert!(!space.contains(&outside), "{outside:?}");
    }
    let slower = Params { max_velocity1: 1.0, max_velocity2: 0.05, ..Params::DEFAULT };
    acrobot.set_params(slower).unwrap();
    assert!(acrobot.observation_space().high().ends_with(&[1.0, 0.1]), "0.1 after a reset");
    assert!(!BoxSpace::new(vec![0.0], vec![1.0]).unwrap().contains(&[0.5, 0.5]));
    assert!(space.contains(&space.sample(&mut Pcg64::new(0))));
    for (low, high) in [(0.0, vec![1.0, 2.0]), (1.0, vec![0.0]), (f32::NEG_INFINITY, vec![0.0])] {
        assert!(BoxSpace::new(vec![low], high).is_none());
    }
}
