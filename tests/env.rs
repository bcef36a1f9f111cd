//! The host's environments: Gymnasium's runs through `make`, pictures, live changes, and what is refused.

mod common;

use std::sync::{Arc, Mutex};

use acrobot::env::{
    AcrobotEnv, ArithmeticKind, BoxSpace, Discrete, Display, Env, Error, Frame, Options,
    RecordEpisodeStatistics, RenderMode, Rendering, Space, acrobot_v1, make, make_with,
};
use acrobot::{
    Acrobot, Action, Dynamics, Fast, Figure, Host, Micro, Observation, Params, Pcg64, Portable,
    SeedSequence, StartBounds, State, TimeLimit,
};
use common::{Digest, is_recorded_library};

#[test]
fn make_plays_gymnasiums_runs() {
    if !is_recorded_library() {
        return;
    }
    let rows = include_str!("data/seeds.txt")
        .lines()
        .filter_map(|line| line.strip_prefix("play "));
    let mut played = 0;
    for row in rows {
        let [id, seed, digest, episodes] = row.split(' ').collect::<Vec<_>>()[..] else {
            panic!("{row}")
        };
        let mut env = make(id).unwrap();
        let mut actions = Pcg64::new(seed.parse::<SeedSequence>().unwrap());
        env.reset(Some(seed.parse().unwrap()), None);
        let (mut found, mut ends) = (Digest::new(), 0);
        for _ in 0..1000 {
            let step = env.step(env.action_space().sample(&mut actions));
            step.observation
                .iter()
                .for_each(|x| found.add(x.to_bits().into()));
            found.add((step.reward == 0.0).into());
            found.add(step.terminated.into());
            found.add(step.truncated.into());
            if step.ended() {
                ends += 1;
                env.reset(None, None);
            }
        }
        assert_eq!(format!("{:016x}", found.0), digest, "{id}, seed {seed}");
        assert_eq!(ends.to_string(), episodes, "{id}, seed {seed}");
        played += 1;
    }
    assert_eq!(played, 20);
}

#[test]
fn versions_differ_in_limit_and_observation() {
    let (mut v0, mut v1) = (make("Acrobot-v0").unwrap(), make("Acrobot-v1").unwrap());
    let (angles, _) = v0.reset(Some(5.into()), None);
    let (sines, _) = v1.reset(Some(5.into()), None);
    assert_eq!((angles.len(), sines.len()), (4, 6));
    let state = v1.unwrapped().state();
    assert_eq!(f64::from(angles[2]), state.dtheta1);
    assert_eq!(sines[4..], angles[2..]);
    for n in 1..=500 {
        assert_eq!(v0.step(Action::Zero).truncated, n >= 200);
        assert_eq!(v1.step(Action::Zero).truncated, n >= 500);
    }
    assert_eq!(**v0.observation_space().high(), *Observation::V0_HIGH);
    assert_eq!(**v1.observation_space().high(), *Observation::HIGH);
    assert_eq!(**v1.observation_space().low(), *Observation::LOW);
    assert_eq!(v1.action_space().n().get(), 3);

    let bounds = StartBounds::new(0.3, 0.3).unwrap();
    let (start, _) = v0.reset(None, Some(bounds));
    assert_eq!(*start, [0.3; 4]);
}

#[test]
fn live_changes_reach_through_every_wrapper() {
    let params = Params {
        dynamics: Dynamics::Nips,
        dt: 0.05,
        ..Params::DEFAULT
    };
    let mut typed = RecordEpisodeStatistics::new(acrobot_v1::<Host>(Options::default()).unwrap());
    let mut erased = make("Acrobot-v1").unwrap();
    let mut made_so = make_with(
        "Acrobot-v1",
        Options {
            params,
            ..Options::default()
        },
    )
    .unwrap();
    typed.reset(Some(3.into()), None);
    erased.reset(Some(3.into()), None);
    made_so.reset(Some(3.into()), None);
    typed.unwrapped_mut().set_params(params).unwrap();
    erased.unwrapped_mut().set_params(params).unwrap();
    assert_eq!(erased.unwrapped().params(), params);
    let far = State::from([1.0, 1.0, 2.0, 2.0]);
    typed.inner_mut().unwrapped_mut().set_state(far).unwrap();
    erased.unwrapped_mut().set_state(far).unwrap();
    made_so.unwrapped_mut().set_state(far).unwrap();
    let expected = typed.step(Action::Positive);
    assert_eq!(
        *erased.step(Action::Positive).observation,
        *expected.observation
    );
    assert_eq!(
        *made_so.step(Action::Positive).observation,
        *expected.observation
    );

    let slower = Params {
        max_velocity1: 1.0,
        max_velocity2: 2.0,
        ..params
    };
    let mut angles = make("Acrobot-v0").unwrap();
    angles.unwrapped_mut().set_params(slower).unwrap();
    erased.unwrapped_mut().set_params(slower).unwrap();
    assert_eq!(erased.observation_space().high()[4..], [1.0, 2.0]);
    assert_eq!(angles.observation_space().high()[2..], [1.0, 2.0]);
    assert_eq!(erased.unwrapped().figure(), Figure::new(typed.unwrapped()));
}

/// What `make` returns goes where any environment goes.
#[test]
fn boxed_and_borrowed_environments_are_environments() {
    let limit = 3.try_into().unwrap();
    let mut env = RecordEpisodeStatistics::new(TimeLimit::new(make("Acrobot-v0").unwrap(), limit));
    env.reset(Some(1.into()), None);
    let mut borrowed = RecordEpisodeStatistics::new(&mut env);
    borrowed.step(Action::Zero);
    borrowed.step(Action::Zero);
    assert_eq!(borrowed.step(Action::Zero).info.episode.unwrap().length, 3);
    assert_eq!(borrowed.observation_space().high().len(), 4);
    assert_eq!(borrowed.action_space().n().get(), 3);
    assert_eq!(borrowed.render(), Err(Error::NoRenderMode));
    borrowed
        .unwrapped_mut()
        .set_state(State::default())
        .unwrap();
    assert_eq!(borrowed.unwrapped().state(), State::default());
    let (start, _) = borrowed.reset(None, Some(StartBounds::new(0.5, 0.5).unwrap()));
    assert_eq!(*start, [0.5; 4]);
    borrowed.close();

    // The shorter of two limits, and whoever shows is let go of through all of them.
    let (sender, frames) = std::sync::mpsc::channel();
    let display = Display::new(move |frame| sender.send(frame.width()).unwrap());
    assert_eq!(format!("{display:?}"), "Display");
    let options = Options {
        render_mode: RenderMode::Human(display),
        ..Options::default()
    };
    let mut env = TimeLimit::v1(RecordEpisodeStatistics::new(
        make_with("Acrobot-v0", options).unwrap(),
    ));
    env.reset(None, None);
    let length = (1..).find(|_| Env::step(&mut env, Action::Zero).truncated);
    assert_eq!(length, Some(200));
    assert!(
        env.inner()
            .episodes()
            .all(|episode| !episode.elapsed.is_zero())
    );
    assert_eq!(frames.try_iter().count(), 201);
    RecordEpisodeStatistics::new(&mut env).close();
    assert!(frames.recv().is_err(), "nobody is left to send");
    assert_eq!(env.render(), Err(Error::NoRenderMode));
}

#[test]
fn every_arithmetic_can_be_made() {
    fn start<A: acrobot::Arithmetic>() -> State {
        let mut acrobot = Acrobot::<A>::new(1);
        acrobot.step(Action::Positive);
        acrobot.state().cast()
    }
    for (arithmetic, expected) in [
        (ArithmeticKind::Host, start::<Host>()),
        (ArithmeticKind::Portable, start::<Portable>()),
        (ArithmeticKind::Fast, start::<Fast>()),
        (ArithmeticKind::Micro, start::<Micro>()),
    ] {
        let mut env = make_with(
            "Acrobot-v1",
            Options {
                arithmetic,
                ..Options::default()
            },
        )
        .unwrap();
        env.reset(Some(1.into()), None);
        env.step(Action::Positive);
        assert_eq!(env.unwrapped().state(), expected, "{arithmetic:?}");
    }
}

fn with_mode(render_mode: RenderMode) -> TimeLimit<AcrobotEnv<Portable, Observation>> {
    let mut env = acrobot_v1::<Portable>(Options {
        render_mode,
        ..Options::default()
    })
    .unwrap();
    env.reset(Some(1.into()), None);
    env.unwrapped_mut()
        .set_state(State::from([0.6, -1.5, 1.0, -2.0]))
        .unwrap();
    env
}

#[test]
fn each_render_mode_returns_its_kind() {
    let mut rgb = with_mode(RenderMode::RgbArray);
    let Ok(Rendering::Frame(frame)) = rgb.render() else {
        panic!("no frame")
    };
    assert_eq!((frame.width(), frame.height()), (500, 500));
    assert_eq!(frame, Frame::of(&Figure::new(rgb.unwrapped())));

    let Ok(Rendering::Text(text)) = with_mode(RenderMode::Ansi).render() else {
        panic!("no text")
    };
    common::assert_snapshot("ansi.txt", include_str!("data/ansi.txt"), &text);

    let shown = Arc::new(Mutex::new(Vec::new()));
    let sink = Arc::clone(&shown);
    let display = Display::new(move |frame| sink.lock().unwrap().push(frame.clone()));
    let mut human = with_mode(RenderMode::Human(display));
    human.step(Action::Zero);
    assert_eq!(human.render(), Ok(Rendering::Shown));
    let shown = shown.lock().unwrap();
    assert_eq!(shown.len(), 3, "the reset, the step and the call");
    assert_eq!(shown[1], shown[2]);
    assert_eq!(shown[2], Frame::of(&Figure::new(human.unwrapped())));
}

#[test]
fn statistics_are_of_each_episode() {
    let mut env = RecordEpisodeStatistics::new(TimeLimit::new(
        Acrobot::<Fast>::new(0),
        5.try_into().unwrap(),
    ));
    assert_eq!(env.mean_return(), None);
    for episode in 1..=120 {
        env.reset(None, None);
        if episode == 120 {
            let upright = State {
                theta1: 3.0,
                ..State::default()
            };
            env.unwrapped_mut().set_state(upright).unwrap();
        }
        let last = loop {
            let step = env.step(Action::Zero);
            assert_eq!(step.info.episode.is_some(), step.ended());
            if let Some(last) = step.info.episode {
                break last;
            }
        };
        let expected = if episode == 120 { (1, 0.0) } else { (5, -5.0) };
        assert_eq!((last.length, last.episode_return), expected);
    }
    assert_eq!(env.episodes().count(), 100);
    assert_eq!(env.mean_return(), Some(-99.0 * 5.0 / 100.0));
}

#[test]
fn what_does_not_fit_is_refused_with_what_to_do() {
    for (id, nearest) in [
        ("Acrobot-v2", "Acrobot-v1"),
        ("acrobot-v0", "Acrobot-v0"),
        ("", "Acrobot-v1"),
        ("CartPole-v1", "Acrobot-v1"),
    ] {
        let text = make(id).unwrap_err().to_string();
        let expected = format!(
            "there is no environment {id:?}; did you mean {nearest:?}? Known are Acrobot-v0 and Acrobot-v1"
        );
        assert_eq!(text, expected);
    }
    let refused = |params, arithmetic| {
        let options = Options {
            params,
            arithmetic,
            ..Options::default()
        };
        make_with("Acrobot-v1", options).unwrap_err().to_string()
    };
    let text = refused(
        Params {
            dt: -1.0,
            ..Params::DEFAULT
        },
        ArithmeticKind::Host,
    );
    assert_eq!(text, "dt is -1 s; allowed is a finite number above 0");
    let text = refused(
        Params {
            mass1: 1e-60,
            ..Params::DEFAULT
        },
        ArithmeticKind::Fast,
    );
    assert_eq!(text, "mass1 is 0 kg; allowed is a finite number above 0");

    let mut mute = make("Acrobot-v1").unwrap();
    let error = mute.render().unwrap_err();
    assert_eq!(error, Error::NoRenderMode);
    assert!(
        error
            .to_string()
            .contains("make the environment with the render mode RgbArray, Ansi or Human")
    );
    assert_eq!(Acrobot::<Fast>::new(0).render(), Err(Error::NoRenderMode));

    let before = mute.unwrapped().state();
    assert!(
        mute.unwrapped_mut()
            .set_state(State {
                theta1: f64::NAN,
                ..before
            })
            .is_err()
    );
    assert!(
        mute.unwrapped_mut()
            .set_params(Params {
                mass1: 0.0,
                ..Params::DEFAULT
            })
            .is_err()
    );
    assert_eq!(mute.unwrapped().state(), before);
    assert_eq!(mute.unwrapped().params(), Params::DEFAULT);
}

#[test]
fn spaces_know_their_elements() {
    let space = acrobot_v1::<Fast>(Options::default())
        .unwrap()
        .observation_space();
    assert!(space.contains(space.low()) && space.contains(space.high()));
    for i in 0..6 {
        let mut outside = *space.high();
        outside.0[i] = outside.0[i].next_up();
        assert!(!space.contains(&outside));
        outside.0[i] = space.low()[i].next_down();
        assert!(!space.contains(&outside));
        outside.0[i] = f32::NAN;
        assert!(!space.contains(&outside));
    }
    assert!(
        !BoxSpace::new(vec![0.0], vec![1.0])
            .unwrap()
            .contains(&vec![0.5, 0.5])
    );
    assert!(BoxSpace::new(vec![0.0], vec![1.0, 2.0]).is_none());
    assert!(BoxSpace::new([f32::NEG_INFINITY], [0.0]).is_none());
    assert!(BoxSpace::new([0.0], [f32::NAN]).is_none());
    assert!(
        Action::ALL
            .iter()
            .all(|action| Discrete::ACTIONS.contains(action))
    );
}

#[test]
fn what_only_rounding_would_allow_is_refused() {
    // As f32 it is 0.
    let params = Params {
        torque_noise: -1e-60,
        ..Params::DEFAULT
    };
    let options = Options {
        arithmetic: ArithmeticKind::Fast,
        ..Options::default()
    };
    let mut env = make_with("Acrobot-v1", options.clone()).unwrap();
    let expected = params.validate().unwrap_err();
    assert_eq!(env.unwrapped_mut().set_params(params), Err(expected));
    let made = make_with("Acrobot-v1", Options { params, ..options });
    let error = made.unwrap_err();
    assert_eq!(error, Error::Invalid(expected));
    let source = std::error::Error::source(&error).unwrap();
    assert_eq!(source.to_string(), expected.to_string());
    assert!(format!("{env:?}").starts_with("DynEnv { state: State"));
}
