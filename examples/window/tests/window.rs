//! The window shows the states that the pressed keys lead to, and options and errors work as documented. The tests press keys
//! on an X server and compare its screen pixel by pixel.

use std::fs;
use std::io::{BufRead, BufReader, Cursor};
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use acrobot::arithmetic::Host;
use acrobot::render::{Figure, Frame, Theme};
use acrobot::{Acrobot, Action};
use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_9X18_BOLD};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::{Drawable, Point};
use embedded_graphics::text::{Baseline, Text};

const LINK: [u8; 3] = [0, 204, 204];
const INK: [u8; 3] = [68, 68, 68];
const WHITE: [u8; 3] = [255, 255, 255];

#[test]
fn the_screen_shows_the_states_that_the_keys_lead_to() {
    let screen = Screen::start();
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("last.png");
    let mut game = screen.play(&["--seed", "42", "--screenshot", file.to_str().unwrap()]);

    // Before a key is pressed, the screen shows the picture and its overlay.
    let steps = screen.wait_for("the initial state", |picture| {
        let steps = picture.steps()?;
        picture.shows(0, &[(Action::Zero, steps)]).then_some(steps)
    });
    let size = screen.picture().count(LINK);
    assert!((4_000..12_000).contains(&size), "{size} pixels of links");

    let window = screen.xdotool(&["search", "--name", "^Acrobot$"]);
    screen.xdotool(&["windowfocus", "--sync", &window]);
    screen.xdotool(&["keydown", "Right"]);
    let steps = screen.wait_for("ten steps of the right arrow", |picture| {
        let now = picture.steps()?;
        let held = |before| {
            picture.shows(
                0,
                &[(Action::Zero, before), (Action::Positive, now - before)],
            )
        };
        (steps..=now.checked_sub(10)?).any(held).then_some(now)
    });
    screen.keep("right.png");
    screen.xdotool(&["keyup", "Right"]);

    screen.xdotool(&["key", "r"]);
    screen.wait_for("the second initial state", |picture| {
        let now = picture.steps()?;
        (now < steps && picture.shows(1, &[(Action::Zero, now)])).then_some(())
    });
    screen.keep("reset.png");

    // A window that is not square shows the picture scaled, in its middle.
    screen.xdotool(&["windowsize", &window, "800", "300"]);
    screen.wait_for("the picture scaled", |picture| {
        let expected = size * 300 * 300 / (500 * 500);
        let links = (expected * 9 / 10..expected * 11 / 10).contains(&picture.count(LINK));
        (links && picture.pixel(0, 0) == WHITE && picture.pixel(799, 299) == WHITE).then_some(())
    });
    screen.keep("resized.png");

    screen.xdotool(&["key", "Escape"]);
    let status = eventually("the end", || game.0.try_wait().unwrap());
    assert!(status.success(), "{status}");
    let last = Picture::decode(fs::read(file).unwrap());
    assert_eq!((last.width, last.rgb.len()), (500, 500 * 500 * 3));
    let steps = last.steps().expect("an overlay");
    assert!(last.shows(1, &[(Action::Zero, steps)]), "at step {steps}");
}

#[test]
fn the_window_shows_15_frames_per_second_and_closes_after_the_last() {
    let screen = Screen::start();
    let start = Instant::now();
    let output = screen.run(&["--frames", "30", "--dynamics", "nips"]);
    assert!(output.status.success(), "{output:?}");
    assert!(
        start.elapsed() >= Duration::from_millis(1990),
        "30 frames took {:?}",
        start.elapsed()
    );
}

#[test]
fn invalid_options_and_displays_are_errors_with_the_reason() {
    let screen = Screen::start();
    for (arguments, status, words) in [
        (&["--seed", "-1"], 2, "decimal integer"),
        (&["--dynamics", "newton"], 2, "book, nips"),
        (&["--frames", "0"], 2, "0 is not in 1.."),
        (&["--screenshot", "no/such/folder.png"], 1, "cannot write"),
    ] {
        rejected(&screen.run(arguments), status, words);
    }
    let unset = game(&[]).env_remove("DISPLAY").output().unwrap();
    rejected(&unset, 1, "DISPLAY");
    let wrong = game(&[]).env("DISPLAY", ":65000").output().unwrap();
    rejected(&wrong, 1, "cannot open a window");
}

#[test]
fn a_killed_game_leaves_no_screenshot() {
    let screen = Screen::start();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("killed");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir(&folder).unwrap();
    let file = folder.join("last.png");
    for old in [None, Some("old")] {
        if let Some(old) = old {
            fs::write(&file, old).unwrap();
        }
        let game = screen.play(&["--screenshot", file.to_str().unwrap()]);
        screen.wait_for("the picture", Picture::steps);
        drop(game);
        assert_eq!(fs::read_to_string(&file).ok().as_deref(), old);
    }
    fs::remove_file(&file).unwrap();
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
}

#[test]
fn a_screenshot_that_cannot_be_written_is_an_error() {
    let screen = Screen::start();
    let full = Path::new(env!("CARGO_TARGET_TMPDIR")).join("full.png");
    let _ = fs::remove_file(&full);
    symlink("/dev/full", &full).unwrap();
    let arguments = ["--frames", "1", "--screenshot", full.to_str().unwrap()];
    rejected(&screen.run(&arguments), 1, "No space left on device");
    assert!(full.is_symlink());

    let folder = env!("CARGO_TARGET_TMPDIR");
    rejected(&screen.run(&["--screenshot", folder]), 1, "Is a directory");

    let mut unprinted = game(&["--screenshot", "no/such/folder.png"]);
    unprinted.env("DISPLAY", &screen.display);
    let stderr = fs::File::options().write(true).open("/dev/full").unwrap();
    assert_eq!(unprinted.stderr(stderr).status().unwrap().code(), Some(1));
}

fn rejected(output: &Output, status: i32, words: &str) {
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{message}");
    assert!(message.contains(words), "{message}");
    assert!(!message.contains("panicked"), "{message}");
}

fn game(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_acrobot-window"));
    command.args(arguments);
    command
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET");
    command
}

/// A process that is killed at the end of the test, even if the test fails.
struct Process(Child);

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A virtual X server.
struct Screen {
    _server: Process,
    display: String,
}

impl Screen {
    fn start() -> Self {
        let mut server = tool("Xvfb");
        server.args("-displayfd 1 -screen 0 800x600x24 -nolisten tcp".split(' '));
        server.stdout(Stdio::piped()).stderr(Stdio::null());
        let mut server = Process(server.spawn().unwrap());
        let mut number = String::new();
        let stdout = server.0.stdout.as_mut().unwrap();
        BufReader::new(stdout).read_line(&mut number).unwrap();
        assert!(!number.is_empty(), "Xvfb failed to start");
        Self {
            _server: server,
            display: format!(":{}", number.trim()),
        }
    }

    fn play(&self, arguments: &[&str]) -> Process {
        Process(
            game(arguments)
                .env("DISPLAY", &self.display)
                .spawn()
                .unwrap(),
        )
    }

    fn run(&self, arguments: &[&str]) -> Output {
        game(arguments)
            .env("DISPLAY", &self.display)
            .output()
            .unwrap()
    }

    fn tool(&self, name: &str, arguments: &[&str]) -> Vec<u8> {
        let mut command = tool(name);
        let output = command
            .args(arguments)
            .env("DISPLAY", &self.display)
            .output()
            .unwrap();
        assert!(output.status.success(), "{name} {arguments:?}: {output:?}");
        output.stdout
    }

    fn xdotool(&self, arguments: &[&str]) -> String {
        let output = String::from_utf8(self.tool("xdotool", arguments)).unwrap();
        output.trim().to_string()
    }

    fn screenshot(&self) -> Vec<u8> {
        self.tool("import", &["-window", "root", "PNG24:-"])
    }

    fn picture(&self) -> Picture {
        Picture::decode(self.screenshot())
    }

    /// Saves a screenshot in `target/tmp`.
    fn keep(&self, name: &str) {
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        fs::write(file, self.screenshot()).unwrap();
    }

    fn wait_for<T>(&self, what: &str, found: impl Fn(&Picture) -> Option<T>) -> T {
        eventually(what, || found(&self.picture()))
    }
}

fn tool(name: &str) -> Command {
    let found = std::env::var_os("PATH")
        .is_some_and(|path| std::env::split_paths(&path).any(|folder| folder.join(name).exists()));
    assert!(
        found,
        "{name} is missing; the test needs `apt-get install xvfb xdotool imagemagick`"
    );
    Command::new(name)
}

fn eventually<T>(what: &str, mut found: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(20) {
        if let Some(found) = found() {
            return found;
        }
        sleep(Duration::from_millis(50));
    }
    panic!("20 s passed without {what}");
}

/// The pixels of a screen or a PNG file.
struct Picture {
    width: usize,
    rgb: Vec<u8>,
}

impl Picture {
    fn decode(file: Vec<u8>) -> Self {
        let mut reader = png::Decoder::new(Cursor::new(file)).read_info().unwrap();
        let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut rgb).unwrap();
        assert_eq!(info.color_type, png::ColorType::Rgb);
        Self {
            width: info.width as usize,
            rgb,
        }
    }

    fn pixel(&self, x: usize, y: usize) -> [u8; 3] {
        let start = 3 * (y * self.width + x);
        self.rgb[start..start + 3].try_into().unwrap()
    }

    fn count(&self, color: [u8; 3]) -> usize {
        let pixels = self.rgb.chunks_exact(3);
        pixels.filter(|&pixel| pixel == color).count()
    }

    /// Reads the number after the word "step" in the overlay.
    fn steps(&self) -> Option<u32> {
        let [red, green, blue] = INK;
        let style = MonoTextStyle::new(&FONT_9X18_BOLD, Rgb888::new(red, green, blue));
        (0..=500).find(|steps| {
            let text = format!("step {steps:3}");
            let mut frame = Frame::new(90, 30);
            let Ok(_) = Text::with_baseline(&text, Point::new(10, 10), style, Baseline::Top)
                .draw(&mut frame);
            pixels(&frame).all(|(x, y, pixel)| (pixel == INK) == (self.pixel(x, y) == INK))
        })
    }

    /// Whether the picture shows, under the overlay, the state that these actions lead to in this episode of seed 42.
    fn shows(&self, episode: u32, actions: &[(Action, u32)]) -> bool {
        let mut acrobot = Acrobot::<Host>::new(42);
        for _ in 0..episode {
            acrobot.reset();
        }
        let mut torque = 0.0;
        for &(action, steps) in actions {
            for _ in 0..steps {
                acrobot.step(action);
                torque = f32::from(u8::from(action)) - 1.0;
            }
        }
        let mut frame = Frame::new(500, 500);
        let figure = Figure::new(&acrobot).with_torque(torque);
        let Ok(()) = figure.draw(&mut frame, &Theme::GYMNASIUM);
        pixels(&frame).all(|(x, y, pixel)| [pixel, INK].contains(&self.pixel(x, y)))
    }
}

fn pixels(frame: &Frame) -> impl Iterator<Item = (usize, usize, [u8; 3])> {
    let width = frame.width() as usize;
    let pixels = frame.bytes().chunks_exact(3).enumerate();
    pixels.map(move |(i, pixel)| (i % width, i / width, [pixel[0], pixel[1], pixel[2]]))
}
