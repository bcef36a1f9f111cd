//! Environments: Gymnasium's runs through `make`, live changes, wrappers, and rejected input.

use acrobot::arithmetic::{Arithmetic, Host, Micro, Reference};
use acrobot::env::{
    AcrobotEnv, ArithmeticKind, BoxSpace, DiscreteSpace, Display, DynObservation, Env, Error,
    Options, RecordEpisodeStatistics, RenderMode, Space, acrobot_v1, make, make_with,
};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::Dynamics;
use acrobot::render::Figure;
use acrobot::task::{Gymnasium, ResetBounds, Task};
use acrobot::{Acrobot, Action, Fast, Params, Portable, ResetOptions, State, TimeLimit};
use common::{Digest, is_recorded_library, lines};

#[test]
fn make_plays_gymnasiums_runs() {
    if !is_recorded_library() {
        return;
    }
    let mut played = 0;
    for row in lines(include_str!("data/seeds.txt"), "play") {
        let [id, seed, digest, episodes] = row.split(' ').collect::<Vec<_>>().try_into().unwrap();
        let mut env = make(id).unwrap();
        let sequence: SeedSequence = seed.parse().unwrap();
        let mut actions = Pcg64::from(sequence.clone());
        env.reset_with(ResetOptions { seed: Some(sequence), ..ResetOptions::default() });
        let (mut found, mut ends) = (Digest::default(), 0);
        for _ in 0..1000 {
            let step = env.step(env.action_space().sample(&mut actions));
            for x in step.observation.as_slice() {
                found.add(x.to_bits().into());
            }
            found.add((step.reward == 0.0).into());
            found.add(step.terminated.into());
            found.add(step.truncated.into());
            if step.done() {
                ends += 1;
                env.reset();
            }
        }
        assert_eq!(format!("{:016x}", found.0), digest, "{id}, seed {seed}");
        assert_eq!(ends.to_string(), episodes, "{id}, seed {seed}");
        played += 1;
    }
    assert_eq!(played, 20);
}

/// The first observation of a reset whose bounds are both `x`.
fn reset_to(mut env: impl Env<Observation = DynObservation>, x: f64) -> Vec<f32> {
    let (observation, _) = env.reset_with(ResetOptions {
        bounds: Some(ResetBounds::new(x, x).unwrap()),
        ..ResetOptions::default()
    });
    observation.as_slice().to_vec()
}

#[test]
fn versions_have_gymnasiums_spaces() {
    // As its observation spaces print them: 4π and 9π in f32.
    let (pi, four_pi, nine_pi) = (core::f32::consts::PI, 12.566_371, 28.274_334);
    let (mut v0, v1) = (make("Acrobot-v0").unwrap(), make("Acrobot-v1").unwrap());
    for (env, high) in
        [(&v0, &[pi, pi, four_pi, nine_pi][..]), (&v1, &[1.0, 1.0, 1.0, 1.0, four_pi, nine_pi])]
    {
        let space = env.observation_space();
        assert_eq!(space.high().as_slice(), high);
        assert!(space.low().as_slice().iter().copied().eq(high.iter().map(|x| -x)));
        assert_eq!(env.action_space().n().get(), 3);
    }
    assert_eq!(reset_to(&mut v0, 0.3), [0.3; 4]);
}

#[test]
fn live_changes_reach_through_every_wrapper() {
    let params = Params { dynamics: Dynamics::Nips, dt: 0.05, ..Params::DEFAULT };
    let mut typed = RecordEpisodeStatistics::new(acrobot_v1::<Host>(Options::default()).unwrap());
    let mut erased = make("Acrobot-v1").unwrap();
    let mut made = make_with("Acrobot-v1", Options { params, ..Options::default() }).unwrap();
    typed.unwrapped_mut().set_params(params).unwrap();
    erased.unwrapped_mut().set_params(params).unwrap();
    assert_eq!(erased.unwrapped().params(), params);
    let far = State::from([1.0, 1.0, 2.0, 2.0]);
    typed.inner_mut().unwrapped_mut().set_state(far).unwrap();
    erased.unwrapped_mut().set_state(far).unwrap();
    made.unwrapped_mut().set_state(far).unwrap();
    let expected = typed.step(Action::Positive);
    for env in [&mut erased, &mut made] {
        let step = env.step(Action::Positive);
        assert_eq!(step.observation, expected.observation.into());
    }

    let slower = Params { max_velocity1: 1.0, max_velocity2: 2.0, ..params };
    let mut angles = make("Acrobot-v0").unwrap();
    angles.unwrapped_mut().set_params(slower).unwrap();
    erased.unwrapped_mut().set_params(slower).unwrap();
    assert_eq!(erased.observation_space().high().as_slice()[4..], [1.0, 2.0]);
    assert_eq!(angles.observation_space().high().as_slice()[2..], [1.0, 2.0]);
    assert_eq!(erased.unwrapped().figure(), Figure::new(typed.unwrapped()));
    erased.unwrapped_mut().set_state(State::UPRIGHT).unwrap();
    assert!(erased.step(Action::Zero).terminated);
}

#[test]
fn boxed_and_borrowed_environments_are_environments() {
    let limit = 3.try_into().unwrap();
    let mut env = RecordEpisodeStatistics::new(TimeLimit::new(make("Acrobot-v0").unwrap(), limit));
    env.reset_with_seed(1);
    let mut borrowed = RecordEpisodeStatistics::new(&mut env);
    borrowed.step(Action::Zero);
    borrowed.step(Action::Zero);
    assert_eq!(borrowed.step(Action::Zero).info.episode.unwrap().length, 3);
    assert_eq!(borrowed.observation_space().high().as_slice().len(), 4);
    assert_eq!(borrowed.action_space().n().get(), 3);
    assert_eq!(borrowed.render(), Err(Error::NoRenderMode));
    borrowed.unwrapped_mut().set_state(State::default()).unwrap();
    assert_eq!(borrowed.unwrapped().state(), State::default());
    assert_eq!(reset_to(&mut borrowed, 0.5), [0.5; 4]);
    borrowed.close();

    // The shorter of two limits truncates. `close` reaches through all wrappers and drops the
    // display.
    let (sender, frames) = std::sync::mpsc::channel();
    let display = Display::new(move |frame| sender.send(frame.width()).unwrap());
    assert_eq!(format!("{display:?}"), "Display");
    let options = Options { render_mode: RenderMode::Human(display), ..Options::default() };
    let env = RecordEpisodeStatistics::new(make_with("Acrobot-v0", options).unwrap());
    let mut env = TimeLimit::new(env, Gymnasium::MAX_STEPS);
    env.reset();
    let length = (1..).find(|_| env.step(Action::Zero).truncated);
    assert_eq!(length, Some(200));
    assert!(env.inner().episodes().all(|episode| !episode.elapsed.is_zero()));
    assert_eq!(frames.try_iter().count(), 201);
    RecordEpisodeStatistics::new(&mut env).close();
    assert!(frames.recv().is_err(), "the sender is dropped");
    assert_eq!(env.render(), Err(Error::NoRenderMode));
}

#[test]
fn every_arithmetic_can_be_made() {
    fn after_a_step<A: Arithmetic>() -> State {
        let mut acrobot = Acrobot::<A>::new(1);
        acrobot.step(Action::Positive);
        acrobot.state().cast()
    }
    for (arithmetic, expected) in [
        (ArithmeticKind::Host, after_a_step::<Host>()),
        (ArithmeticKind::Reference, after_a_step::<Reference>()),
        (ArithmeticKind::Portable, after_a_step::<Portable>()),
        (ArithmeticKind::Fast, after_a_step::<Fast>()),
        (ArithmeticKind::Micro, after_a_step::<Micro>()),
    ] {
        let mut env =
            make_with("Acrobot-v1", Options { arithmetic, ..Options::default() }).unwrap();
        env.reset_with_seed(1);
        env.step(Action::Positive);
        assert_eq!(env.unwrapped().state(), expected, "{arithmetic:?}");
    }
}

#[test]
fn statistics_cover_each_episode() {
    let env = AcrobotEnv::<Fast, [f32; 6]>::default();
    let mut env = RecordEpisodeStatistics::new(TimeLimit::new(env, 5.try_into().unwrap()));
    assert_eq!(env.mean_return(), None);
    for episode in 1..=120 {
        env.reset();
        if episode == 120 {
            let upright = State { theta1: 3.0, ..State::default() };
            env.unwrapped_mut().set_state(upright).unwrap();
        }
        let last = loop {
            let step = env.step(Action::Zero);
            assert_eq!(step.info.episode.is_some(), step.done());
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
fn unwrapping_changes_nothing() {
    let mut env = acrobot_v1::<Fast>(Options::default()).unwrap();
    let mut wrapped = RecordEpisodeStatistics::new(env.clone());
    for _ in 0..3 {
        env.step(Action::Positive);
        wrapped.step(Action::Positive);
    }
    let inner = wrapped.into_inner();
    assert_eq!(inner.elapsed_steps(), 3);
    assert_eq!(inner.unwrapped(), env.unwrapped());
    assert_eq!(inner.into_inner().unwrapped(), env.unwrapped());
}

#[test]
fn rejections_name_the_rule() {
    for id in ["Acrobot-v2", "acrobot-v0", "", "CartPole-v1"] {
        let error = make(id).unwrap_err();
        let expected = format!(r#"the id must be "Acrobot-v1" or "Acrobot-v0", got {id:?}"#);
        assert_eq!(error.to_string(), expected);
        assert_eq!(error, Error::UnknownId(id.to_owned()));
    }
    // A long id is cut after 64 characters, however many bytes each has.
    for letter in ["x", "é", "\0"] {
        let exact = letter.repeat(64);
        let error = make(&letter.repeat(1_000_000)).unwrap_err();
        assert_eq!(error, Error::UnknownId(format!("{exact}…")));
        assert_eq!(make(&exact).unwrap_err(), Error::UnknownId(exact));
    }

    let mut options = Options::default();
    options.params.mass1 = -1.0;
    let error = make_with("Acrobot-v1", options).unwrap_err();
    assert_eq!(error.to_string(), "mass1 must be finite and above 0 kg, got -1");

    let error = AcrobotEnv::<Fast, [f32; 6]>::default().render().unwrap_err();
    let rule = "the render mode must be RgbArray, Ansi or Human to render, got None";
    assert_eq!(error.to_string(), rule);
    assert_eq!(make("Acrobot-v1").unwrap().render(), Err(error));
}

#[test]
fn spaces_know_their_elements() {
    let space = acrobot_v1::<Fast>(Options::default()).unwrap().observation_space();
    assert!(space.contains(space.low()) && space.contains(space.high()));
    for i in 0..6 {
        let [low, high] = [space.low(), space.high()].map(|bound| bound.as_ref()[i]);
        for number in [high.next_up(), low.next_down(), f32::NAN] {
            let mut outside = *space.high();
            outside.as_mut()[i] = number;
            assert!(!space.contains(&outside), "{outside:?}");
        }
    }
    assert!(!BoxSpace::new(vec![0.0], vec![1.0]).unwrap().contains(&vec![0.5, 0.5]));
    assert!(BoxSpace::new(vec![0.0], vec![1.0, 2.0]).is_none());
    assert!(Action::ALL.iter().all(|action| DiscreteSpace::ACTIONS.contains(action)));
}

/// Parameters are checked before and after they are rounded to the scalar. An error names them as
/// they were given.
#[test]
fn numbers_that_only_rounding_makes_valid_or_invalid_are_rejected() {
    let options = Options { arithmetic: ArithmeticKind::Fast, ..Options::default() };
    let mut env = make_with("Acrobot-v1", options.clone()).unwrap();
    let acrobot = env.unwrapped_mut();
    let before = (acrobot.state(), acrobot.params());
    let far = State::from([0.0, -1e300, 0.0, 0.0]);
    let rule = "theta2 must be within its range as f32, in rad, got ";
    assert_eq!(acrobot.set_state(far).unwrap_err().to_string(), format!("{rule}{}", -1e300));
    let default = Params::<f64>::DEFAULT;
    let light = Params { inertia1: 1e-60, center_of_mass1: 0.0, ..default };
    for (params, rule, value) in [
        // Rounded to `f32` it is 0.
        (Params { torque_noise: -1e-60, ..default }, "torque_noise must be finite", -1e-60),
        (Params { mass1: 1e300, ..default }, "mass1 must be within its range as f32", 1e300),
        (Params { dt: 1e-60, ..default }, "dt must be within its range as f32", 1e-60),
        (light, "inertia1 must be within its range as f32", 1e-60),
    ] {
        let error = acrobot.set_params(params).unwrap_err();
        let text = error.to_string();
        assert!(text.starts_with(rule) && text.ends_with(&format!("got {value}")), "{text}");
        let made = make_with("Acrobot-v1", Options { params, ..options.clone() }).unwrap_err();
        assert_eq!(made, Error::Invalid(error));
        assert_eq!(std::error::Error::source(&made).unwrap().to_string(), text);
    }
    assert_eq!((acrobot.state(), acrobot.params()), before);
    assert!(format!("{env:?}").starts_with("DynEnv { state: State"));
}
