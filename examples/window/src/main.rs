//! A window in which the arrow keys play `Acrobot-v1`. See the README in this folder.

mod game;
mod screen;

use std::error::Error;
use std::fmt::Display;
use std::io::{self, Write};
use std::panic;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use acrobot::Action;
use acrobot::numpy::SeedSequence;
use acrobot::physics::Dynamics;
use acrobot::render::Frame;
use clap::Parser;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use examples_common::files;
use winit::application::ApplicationHandler;
use winit::event::{ElementState, KeyEvent, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::keyboard::{Key, NamedKey};
use winit::window::WindowId;

use game::Game;
use screen::Screen;

/// As in Gymnasium: 15 frames per second, one for each step.
const FRAME_TIME: Duration = Duration::from_nanos(1_000_000_000 / 15);

/// Play Acrobot-v1 in a window: left and right apply torque, R resets, Escape or Q quits.
#[derive(Parser)]
#[command(allow_negative_numbers = true)]
struct Options {
    /// Seed of the initial states: a decimal integer of at least 0, of any size.
    #[arg(long, default_value = "42")]
    seed: SeedSequence,
    /// Equations of motion: those of Sutton and Barto's book, or those of the 1996 NIPS paper.
    #[arg(long, default_value = "book", value_parser = dynamics())]
    dynamics: Dynamics,
    /// Quit after this many frames.
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    frames: Option<u64>,
    /// Write the last frame to this PNG file on quitting.
    #[arg(long, value_name = "FILE.png")]
    screenshot: Option<PathBuf>,
}

fn dynamics() -> impl TypedValueParser<Value = Dynamics> {
    PossibleValuesParser::new(["book", "nips"]).map(|name| match name.as_str() {
        "nips" => Dynamics::Nips,
        _ => Dynamics::Book,
    })
}

fn main() -> ExitCode {
    match run(Options::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            // If the message cannot be printed, the exit status still reports the error.
            let _ = writeln!(io::stderr(), "error: {message}");
            ExitCode::FAILURE
        }
    }
}

fn run(options: Options) -> Result<(), String> {
    let game = Game::new(options.seed, options.dynamics).map_err(|error| error.to_string())?;
    let event_loop = event_loop().map_err(no_window)?;

    // Check now, so that an error comes before the game and not after it.
    if let Some(path) = &options.screenshot {
        files::check(path)?;
    }

    let mut app = App {
        game,
        screen: None,
        left: false,
        right: false,
        next_tick: Instant::now(),
        frames: options.frames,
        failure: None,
    };
    let result = event_loop.run_app(&mut app);
    if let Some(message) = app.failure {
        return Err(message);
    }
    result.map_err(|error| format!("the window failed: {error}"))?;

    match &options.screenshot {
        Some(path) => {
            let picture = png(app.game.picture()).map_err(|error| error.to_string())?;
            files::write(path, picture)
        }
        None => Ok(()),
    }
}

/// Creates winit's event loop. Turns winit's panic into an error: it panics if it finds no libxkbcommon.
fn event_loop() -> Result<EventLoop<()>, Box<dyn Error>> {
    panic::set_hook(Box::new(|_| ()));
    let made = panic::catch_unwind(EventLoop::new);
    let _ = panic::take_hook();
    let made = made.map_err(|panic| match panic.downcast::<String>() {
        Ok(message) => *message,
        Err(_) => "winit panicked".to_string(),
    })?;
    Ok(made?)
}

fn no_window(cause: impl Display) -> String {
    format!(
        "cannot open a window. It needs a running X11 or Wayland session, DISPLAY or \
         WAYLAND_DISPLAY set, and the libraries listed in the README ({cause})"
    )
}

fn png(picture: &Frame) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width(), picture.height());
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(picture.bytes())?;
    writer.finish()?;
    Ok(bytes)
}

struct App {
    game: Game,
    screen: Option<Screen>,
    /// Whether the arrow keys are held down.
    left: bool,
    right: bool,
    next_tick: Instant,
    /// The number of frames until the window closes, if there is a limit.
    frames: Option<u64>,
    /// The error that closed the window.
    failure: Option<String>,
}

impl App {
    fn action(&self) -> Action {
        match (self.left, self.right) {
            (true, false) => Action::Negative,
            (false, true) => Action::Positive,
            _ => Action::Zero,
        }
    }

    fn key(&mut self, event_loop: &ActiveEventLoop, event: &KeyEvent) {
        let pressed = event.state == ElementState::Pressed;
        match event.logical_key.as_ref() {
            Key::Named(NamedKey::ArrowLeft) => self.left = pressed,
            Key::Named(NamedKey::ArrowRight) => self.right = pressed,
            Key::Character("r" | "R") if pressed && !event.repeat => {
                self.game.reset();
                self.redraw();
            }
            Key::Named(NamedKey::Escape) | Key::Character("q" | "Q") if pressed => {
                event_loop.exit();
            }
            _ => (),
        }
    }

    fn redraw(&self) {
        if let Some(screen) = &self.screen {
            screen.request_redraw();
        }
    }
}

impl ApplicationHandler for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        match Screen::open(event_loop) {
            Ok(screen) => self.screen = Some(screen),
            Err(error) => {
                self.failure = Some(no_window(error));
                event_loop.exit();
            }
        }
        self.next_tick = Instant::now() + FRAME_TIME;
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::KeyboardInput { event, .. } => self.key(event_loop, &event),
            // If the key is released in another window, this one gets no event.
            WindowEvent::Focused(false) => (self.left, self.right) = (false, false),
            WindowEvent::Resized(_) => self.redraw(),
            WindowEvent::RedrawRequested => {
                if let Some(screen) = &mut self.screen
                    && let Err(error) = screen.show(self.game.picture())
                {
                    self.failure = Some(format!("cannot draw in the window: {error}"));
                    event_loop.exit();
                }
            }
            _ => (),
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let now = Instant::now();
        if now >= self.next_tick {
            self.next_tick = now.max(self.next_tick + FRAME_TIME);
            self.game.tick(self.action());
            self.redraw();
            if let Some(frames) = &mut self.frames {
                *frames -= 1;
                if *frames == 0 {
                    event_loop.exit();
                }
            }
        }
        event_loop.set_control_flow(ControlFlow::WaitUntil(self.next_tick));
    }
}
