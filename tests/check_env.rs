//! `check_env` finds every violation of the contract of `Env`. `cargo test -p properties` finds
//! none in our environments.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use acrobot::env::{AcrobotEnv, Env, Error, Info, Rendering, Violation, check_env, make};
use acrobot::{Action, ResetOptions, Step, TimeLimit};

#[derive(Clone)]
struct Broken {
    env: TimeLimit<AcrobotEnv>,
    /// How it breaks the contract: a text of the test below.
    flaw: &'static str,
    count: u32,
    shared_count: Arc<AtomicU32>,
}

impl Env for Broken {
    fn inner(&self) -> &dyn Env {
        &self.env
    }

    fn inner_mut(&mut self) -> &mut dyn Env {
        &mut self.env
    }

    fn reset_with(&mut self, mut options: ResetOptions) -> Vec<f32> {
        match self.flaw {
            "the seed is ignored" => options.seed = None,
            "a reset without a seed does not restart the count" if options.seed.is_some() => {
                self.count = 0;
            }
            "clones share a count that each reset restarts" => self.shared_count.store(0, Relaxed),
            _ => {}
        }
        let mut observation = self.env.reset_with(options);
        match self.flaw {
            "the first observation is outside" => observation[1] = -1.5,
            "the first observation depends on the number of resets" => {
                self.count += 1;
                observation[4] = self.count as f32;
            }
            _ => {}
        }
        observation
    }

    fn step(&mut self, action: Action) -> Step<Vec<f32>, Info> {
        let mut step = self.env.step(action);
        match self.flaw {
            "observations are outside" => step.observation[0] += 1.0,
            "a reward is NaN" => step.reward = f32::NAN,
            "a reset does not restart the count"
            | "a reset without a seed does not restart the count" => {
                self.count += 1;
                step.truncated = self.count >= 500;
            }
            "clones share a count" | "clones share a count that each reset restarts" => {
                step.reward -= (self.shared_count.fetch_add(1, Relaxed) % 7) as f32;
            }
            _ => {}
        }
        step
    }

    fn render(&mut self) -> Result<Rendering, Error> {
        if self.flaw == "rendering moves the acrobot" {
            self.unwrapped_mut().step(Action::Zero);
        }
        Err(Error::NoRenderMode)
    }
}

#[test]
fn every_violation_is_found() {
    let check = |flaw| {
        let env = make("Acrobot-v1").unwrap();
        check_env(&Broken { env, flaw, count: 0, shared_count: Arc::default() }, 1)
    };
    assert_eq!(check("none"), Ok(()));
    let in_space = "observations are in the observation space";
    let repeats = "the same seed and actions give the same episode";
    let restarts = "a reset after the end begins a full new episode";
    for (flaw, rule) in [
        ("observations are outside", in_space),
        ("the first observation is outside", in_space),
        ("a reward is NaN", "rewards are finite"),
        ("the seed is ignored", repeats),
        ("the first observation depends on the number of resets", repeats),
        ("clones share a count", repeats),
        ("clones share a count that each reset restarts", "a clone behaves like its original"),
        ("a reset does not restart the count", restarts),
        ("a reset without a seed does not restart the count", restarts),
        ("rendering moves the acrobot", "rendering changes nothing"),
    ] {
        let violation = check(flaw).expect_err(flaw);
        let Violation { rule: broken, found } = &violation;
        assert_eq!(*broken, rule, "{found}");
        assert!(!found.is_empty());
        assert_eq!(violation.to_string(), format!("{rule}: {found}"));
    }
}
