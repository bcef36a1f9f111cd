//! Environments: Gymnasium's runs through `make`, live changes, wrappers, and rejected input.

use std::sync::mpsc::{TryRecvError, channel};

use acrobot::arithmetic::{Damped, Host};
use acrobot::env::{
    AcrobotEnv, BoxSpace, Display, Env, Error, RenderMode, Rendering, make, make_with,
};
use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::Dynamics;
use acrobot::render::Figure;
use acrobot::task::{Gymnasium, GymnasiumV0, ResetBounds, Swingup, Task};
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
            let step = env.step(Action::sample(&mut actions));
            for x in &step.observation {
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

#[test]
fn versions_have_gymnasiums_spaces() {
    // As its observation spaces print them: 4π and 9π in f32.
    let (pi, four_pi, nine_pi) = (core::f32::consts::PI, 12.566_371, 28.274_334);
    for (id, high) in [
        ("Acrobot-v0", &[pi, pi, four_pi, nine_pi][..]),
        ("Acrobot-v1", &[1.0, 1.0, 1.0, 1.0, four_pi, nine_pi]),
    ] {
        let mut env = make(id).unwrap();
        let space = env.observation_space();
        assert_eq!(space.high(), high);
        assert!(space.low().iter().copied().eq(high.iter().map(|x| -x)));

        let slower = Params { max_velocity1: 1.0, max_velocity2: 0.05, ..Params::DEFAULT };
        env.unwrapped_mut().set_params(slower).unwrap();
        assert!(env.observation_space().high().ends_with(&[1.0, 0.1]), "0.1 after a reset");
    }
}

#[test]
fn live_changes_reach_through_every_wrapper() {
    let params = Params { dynamics: Dynamics::Nips, dt: 0.05, ..Params::DEFAULT };
    let far = State::from([1.0, 1.0, 2.0, 2.0]);
    let mut alone = Acrobot::<Host>::with_params(0, params).unwrap();
    alone.set_state(far).unwrap();
    let expected = alone.step(Action::Positive).observation;

    let mut changed = TimeLimit::new(make("Acrobot-v1").unwrap(), Gymnasium::MAX_STEPS);
    changed.unwrapped_mut().set_params(params).unwrap();
    let mut made = make_with::<Host>("Acrobot-v1", params, RenderMode::None).unwrap();
    for env in [&mut changed as &mut dyn Env, &mut made] {
        assert_eq!(env.unwrapped().params(), params);
        env.unwrapped_mut().set_state(far).unwrap();
        assert_eq!(env.step(Action::Positive).observation, expected);
        assert_eq!(env.unwrapped().state(), alone.state());
        assert_eq!(env.unwrapped().figure(), Figure::new(&alone));
        // The acrobot itself, if its types are known.
        assert_eq!(env.unwrapped().acrobot(), Some(&alone));
        assert_eq!(env.unwrapped().acrobot::<Portable, Gymnasium>(), None);
        assert_eq!(env.unwrapped_mut().acrobot_mut::<Host, GymnasiumV0>(), None);
        let acrobot = env.unwrapped_mut().acrobot_mut::<Host, Gymnasium>().unwrap();
        acrobot.set_state(State::UPRIGHT).unwrap();
        assert!(env.step(Action::Zero).terminated);
    }
}

#[test]
fn borrowed_and_boxed_environments_are_environments() {
    let (sender, frames) = channel();
    let display = Display::new(move |frame| sender.send(frame.width()).unwrap());
    let mode = RenderMode::Human(display);
    let made = make_with::<Fast>("Acrobot-v0", Params::DEFAULT, mode).unwrap();
    let mut boxed: Box<dyn Env> = Box::new(made);
    let mut env = TimeLimit::new(&mut boxed, Gymnasium::MAX_STEPS);
    let bounds = ResetBounds::new(0.5, 0.5).unwrap();
    assert_eq!(env.reset_with(bounds.into()), [0.5; 4]);
    let length = (1..).find(|_| env.step(Action::Zero).truncated);
    assert_eq!(length, Some(200), "the shorter of two limits");
    assert_eq!(frames.try_iter().count(), 201);
    env.unwrapped_mut().set_state(State::default()).unwrap();
    assert_eq!(env.unwrapped().state(), State::default());
    assert_eq!(env.observation_space().high().len(), 4);
    assert_eq!((env.render(), frames.try_recv()), (Ok(Rendering::Shown), Ok(500)));
    env.close();
    assert_eq!(frames.try_recv(), Err(TryRecvError::Disconnected), "the display is dropped");
    assert_eq!(boxed.render(), Err(Error::NoRenderMode));
}

/// Any arithmetic and any task make an environment, bit-identical to the acrobot alone.
#[test]
fn any_acrobot_is_an_environment() {
    let mut alone = Acrobot::<Damped<Fast>, Swingup>::new(1);
    let mut env = AcrobotEnv::new(alone.clone(), RenderMode::None);
    let (step, expected) = (env.step(Action::Positive), alone.step(Action::Positive));
    assert_eq!(step.observation, expected.observation);
    assert_eq!((step.reward, step.terminated), (expected.reward, expected.terminated));
    assert_eq!(env.unwrapped().acrobot(), Some(&alone));
    assert_eq!(env.observation_space().high(), [1.0, 1.0, 1.0, 1.0, 1e30, 1e30]);
}

#[test]
fn rejections_name_the_rule() {
    for id in ["acrobot-v0", "CartPole-v1"] {
        let expected = format!(r#"the id must be "Acrobot-v1" or "Acrobot-v0", got {id:?}"#);
        assert_eq!(make(id).unwrap_err().to_string(), expected);
    }
    let rule = "the render mode must be RgbArray, Ansi or Human to render, got None";
    assert_eq!(make("Acrobot-v1").unwrap().render().unwrap_err().to_string(), rule);
}

/// `cargo test -p properties` tries more spaces.
#[test]
fn spaces_know_their_elements() {
    let space = make("Acrobot-v1").unwrap().observation_space();
    assert!(space.contains(space.low()) && space.contains(space.high()));
    for number in [space.high()[5].next_up(), space.low()[5].next_down(), f32::NAN] {
        let mut outside = space.high().to_vec();
        outside[5] = number;
        assert!(!space.contains(&outside), "{outside:?}");
    }
    assert!(!BoxSpace::new(vec![0.0], vec![1.0]).unwrap().contains(&[0.5, 0.5]));
    assert!(BoxSpace::new(vec![0.0], vec![1.0, 2.0]).is_none());
}

/// Parameters are checked before and after they are rounded to the scalar. An error names them as
/// they were given.
#[test]
fn numbers_that_only_rounding_makes_valid_or_invalid_are_rejected() {
    let mut env = make_with::<Fast>("Acrobot-v1", Params::DEFAULT, RenderMode::None).unwrap();
    let acrobot = env.unwrapped_mut();
    let before = (acrobot.state(), acrobot.params());
    let far = State { theta2: -1e300, ..State::HANGING };
    let rule = "theta2 must be within its range as f32, in rad, got ";
    assert_eq!(acrobot.set_state(far).unwrap_err().to_string(), format!("{rule}{}", -1e300));
    let default = Params::<f64>::DEFAULT;
    for (params, rule, value) in [
        (Params { mass1: -1.0, ..default }, "mass1 must be finite and above 0 kg", -1.0),
        // Rounded to `f32` it is 0.
        (Params { torque_noise: -1e-60, ..default }, "torque_noise must be finite", -1e-60),
        (Params { mass1: 1e300, ..default }, "mass1 must be within its range as f32", 1e300),
        (Params { dt: 1e-60, ..default }, "dt must be within its range as f32", 1e-60),
    ] {
        let error = acrobot.set_params(params).unwrap_err();
        let text = error.to_string();
        assert!(text.starts_with(rule) && text.ends_with(&format!("got {value}")), "{text}");
        let made = make_with::<Fast>("Acrobot-v1", params, RenderMode::None).unwrap_err();
        assert_eq!(made, Error::Invalid(error));
    }
    assert_eq!((acrobot.state(), acrobot.params()), before);
}
