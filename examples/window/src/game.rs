//! The game: steps `Acrobot-v1` in human mode and writes an overlay onto its frames.

use std::sync::mpsc::{self, Receiver};

use acrobot::arithmetic::Host;
use acrobot::env::{AcrobotEnv, Display, Env, Error, Options, RenderMode, acrobot_v1};
use acrobot::numpy::SeedSequence;
use acrobot::physics::Dynamics;
use acrobot::render::{Figure, Frame, Theme};
use acrobot::{Action, Observation, Params, ResetOptions, TimeLimit};
use embedded_graphics::Drawable;
use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_9X18_BOLD};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::Point;
use embedded_graphics::text::{Baseline, Text};

/// The overlay's colour. Nothing else in the picture has it, so the tests can find the overlay.
const INK: Rgb888 = Rgb888::new(68, 68, 68);

/// The number of ticks for which an ended episode stays on the screen: two seconds.
const PAUSE: u32 = 30;

pub struct Game {
    env: TimeLimit<AcrobotEnv<Host, Observation>>,
    /// Receives the frames that the environment shows.
    shown: Receiver<Frame>,
    picture: Frame,
    episode_return: f32,
    end: Option<End>,
}

/// How the episode ended, and for how many more ticks it stays on the screen.
struct End {
    text: &'static str,
    pause: u32,
}

impl Game {
    pub fn new(seed: SeedSequence, dynamics: Dynamics) -> Result<Self, Error> {
        let (sender, shown) = mpsc::channel();
        let display = Display::new(move |frame| {
            // This fails only if the game was dropped.
            let _ = sender.send(frame.clone());
        });
        let mut game = Self {
            env: acrobot_v1(Options {
                render_mode: RenderMode::Human(display),
                params: Params {
                    dynamics,
                    ..Params::DEFAULT
                },
                ..Options::default()
            })?,
            shown,
            picture: Frame::new(0, 0),
            episode_return: 0.0,
            end: None,
        };
        game.begin(Some(seed));
        Ok(game)
    }

    /// Begins the next episode of the same seed.
    pub fn reset(&mut self) {
        self.begin(None);
    }

    fn begin(&mut self, seed: Option<SeedSequence>) {
        self.env.reset_with(ResetOptions {
            seed,
            ..ResetOptions::default()
        });
        self.episode_return = 0.0;
        self.end = None;
        self.draw(Action::Zero);
    }

    /// One step of the environment or, after an episode's end, one tick of the pause.
    pub fn tick(&mut self, action: Action) {
        match &mut self.end {
            Some(End { pause: 0, .. }) => self.reset(),
            Some(end) => end.pause -= 1,
            None => {
                let step = self.env.step(action);
                self.episode_return += step.reward;
                self.end = step.done().then_some(End {
                    text: if step.terminated {
                        "Goal! R: reset"
                    } else {
                        "Out of time. R: reset"
                    },
                    pause: PAUSE,
                });
                self.draw(action);
            }
        }
    }

    /// The environment's last frame with the overlay on it.
    pub fn picture(&self) -> &Frame {
        &self.picture
    }

    fn draw(&mut self, action: Action) {
        if let Some(frame) = self.shown.try_iter().last() {
            self.picture = frame;
        }

        // Gymnasium's picture has no arrow for the torque. This adds one.
        let figure = Figure::new(self.env.unwrapped());
        let torque = self.env.unwrapped().params().torque(action) as f32;
        let Ok(()) =
            figure
                .with_torque(torque)
                .redraw(&figure, &mut self.picture, &Theme::GYMNASIUM);

        let step = self.env.elapsed();
        let time = f64::from(step) * self.env.unwrapped().params().dt;
        let numbers = format!(
            "step {step:3}   return {:4}   time {time:5.1} s",
            self.episode_return
        );
        self.write(10, &numbers);
        if let Some(End { text, .. }) = self.end {
            self.write(34, text);
        }
        self.write(480, "left, right: torque   R: reset   Esc: quit");
    }

    fn write(&mut self, top: i32, text: &str) {
        let style = MonoTextStyle::new(&FONT_9X18_BOLD, INK);
        let text = Text::with_baseline(text, Point::new(10, top), style, Baseline::Top);
        let Ok(_) = text.draw(&mut self.picture);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ended_episode_pauses_and_the_next_begins() {
        let mut game = Game::new(SeedSequence::new(42), Dynamics::Book).unwrap();
        for _ in 0..500 {
            assert!(game.end.is_none());
            game.tick(Action::Zero);
        }
        assert!(game.end.is_some());

        for _ in 0..PAUSE {
            game.tick(Action::Zero);
            assert_eq!((game.env.elapsed(), game.episode_return), (500, -500.0));
        }
        game.tick(Action::Zero);
        assert!(game.end.is_none());
        assert_eq!((game.env.elapsed(), game.episode_return), (0, 0.0));
    }
}
