//! Render modes of an environment.

use std::sync::mpsc::channel;

use acrobot::env::{AcrobotEnv, Display, Env, RenderMode, Rendering};
use acrobot::render::Frame;
use acrobot::{Acrobot, Action, Portable, State};

fn with_mode(render_mode: RenderMode) -> AcrobotEnv {
    let mut env = AcrobotEnv::new(Acrobot::<Portable>::new(1), render_mode);
    env.reset();
    env.set_state(State::from([0.6, -1.5, 1.0, -2.0])).unwrap();
    env
}

#[test]
fn each_render_mode_returns_its_kind() {
    let mut rgb = with_mode(RenderMode::RgbArray);
    let Ok(Rendering::Frame(frame)) = rgb.render() else { panic!("no frame") };
    assert_eq!((frame.width(), frame.height()), (500, 500));
    assert_eq!(frame, Frame::of(&rgb.figure()));

    let Ok(Rendering::Text(text)) = with_mode(RenderMode::Ansi).render() else { panic!("no text") };
    common::assert_snapshot("ansi.txt", &text);

    let (sender, shown) = channel();
    let display = Display::new(move |frame| sender.send(frame.clone()).unwrap());
    let mut human = with_mode(RenderMode::Human(display));
    human.step(Action::Zero);
    assert_eq!(human.render(), Ok(Rendering::Shown));
    let shown: Vec<Frame> = shown.try_iter().collect();
    assert_eq!(shown.len(), 3, "the reset, the step and the call");
    assert_eq!(shown[1], shown[2]);
    assert_eq!(shown[2], Frame::of(&human.figure()));
}
