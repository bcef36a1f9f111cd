//! Render modes of an environment, and displays that environments share.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, mpsc};
use std::time::Duration;

use acrobot::env::{AcrobotEnv, Display, Env, Error, RenderMode, Rendering};
use acrobot::render::Frame;
use acrobot::{Acrobot, Action, Portable, State};

fn new(render_mode: RenderMode) -> AcrobotEnv {
    AcrobotEnv::new(Acrobot::<Portable>::new(1), render_mode)
}

fn with_mode(render_mode: RenderMode) -> AcrobotEnv {
    let mut env = new(render_mode);
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

    let shown = Arc::new(Mutex::new(Vec::new()));
    let sink = Arc::clone(&shown);
    let display = Display::new(move |frame| sink.lock().unwrap().push(frame.clone()));
    let mut human = with_mode(RenderMode::Human(display));
    human.step(Action::Zero);
    assert_eq!(human.render(), Ok(Rendering::Shown));
    let shown = shown.lock().unwrap();
    assert_eq!(shown.len(), 3, "the reset, the step and the call");
    assert_eq!(shown[1], shown[2]);
    assert_eq!(shown[2], Frame::of(&human.figure()));
}

/// A display's function that renders on the same display gets an error and does not deadlock. The
/// display shows the next frame, also after a panic.
#[test]
fn a_display_rejects_frames_from_its_own_function() {
    let nested: Arc<Mutex<Option<[AcrobotEnv; 2]>>> = Arc::default();
    let (other_sender, other_frames) = mpsc::channel();
    let other = Display::new(move |_| other_sender.send(()).unwrap());
    let (sender, results) = mpsc::channel();
    let slot = Arc::clone(&nested);
    let display = Display::new(move |_| {
        let Some([mut same, mut other]) = slot.lock().unwrap().take() else {
            return sender.send(None).unwrap();
        };
        same.reset();
        same.step(Action::Zero);
        sender.send(Some((same.render(), other.render()))).unwrap();
        panic!("while the display shows a frame");
    });
    let human = |display: &Display| new(RenderMode::Human(display.clone()));
    *nested.lock().unwrap() = Some([&display, &other].map(human));
    let mut env = human(&display);
    drop((display, other));
    // In another thread, so that a deadlock fails the test.
    std::thread::spawn(move || {
        assert!(catch_unwind(AssertUnwindSafe(|| env.reset())).is_err());
        assert_eq!(env.render(), Ok(Rendering::Shown));
    });
    let next = || results.recv_timeout(Duration::from_secs(10));
    let (busy, shown) = (Err(Error::DisplayBusy), Ok(Rendering::Shown));
    assert_eq!(next(), Ok(Some((busy, shown))));
    assert_eq!(next(), Ok(None));
    assert!(next().is_err(), "the sender is dropped");
    assert_eq!(other_frames.try_iter().count(), 1);
    let rule = "the function of a display must not render on that display";
    assert_eq!(Error::DisplayBusy.to_string(), rule);
}

#[test]
fn threads_share_a_display() {
    let (sender, frames) = mpsc::channel();
    let display = Display::new(move |_| {
        std::thread::sleep(Duration::from_millis(1));
        sender.send(()).unwrap();
    });
    std::thread::scope(|scope| {
        for _ in 0..2 {
            let mut env = new(RenderMode::Human(display.clone()));
            scope.spawn(move || (0..20).for_each(|_| assert!(env.render().is_ok())));
        }
    });
    drop(display);
    assert_eq!(frames.iter().count(), 40);
}
