//! `check_env` finds every violation of the contract of `Env`. `cargo test -p properties` finds
//! none in our environments.

use std::cell::Cell;
use std::rc::Rc;

use acrobot::env::{
    AcrobotEnv, BoxSpace, DiscreteSpace, Env, Error, Info, Options, Rendering, Space, Violation,
    acrobot_v1, check_env,
};
use acrobot::{Acrobot, Action, Fast, ResetOptions, Step, TimeLimit};
use rand_core::Rng;

/// A space that alters its samples.
struct Altered<S: Space> {
    space: S,
    alter: fn(S::Element) -> S::Element,
}

impl<S: Space> Space for Altered<S> {
    type Element = S::Element;

    fn contains(&self, element: &S::Element) -> bool {
        self.space.contains(element)
    }

    fn sample<R: Rng + ?Sized>(&self, rng: &mut R) -> S::Element {
        (self.alter)(self.space.sample(rng))
    }
}

#[derive(Clone)]
struct Broken {
    env: TimeLimit<AcrobotEnv<Fast, [f32; 6]>>,
    /// How it breaks the contract: a text of the test below.
    flaw: &'static str,
    count: Cell<u32>,
    shared_count: Rc<Cell<u32>>,
}

fn increase(count: &Cell<u32>) -> u32 {
    count.set(count.get() + 1);
    count.get()
}

impl Env for Broken {
    type Observation = [f32; 6];
    type Action = Action;
    type ObservationSpace = Altered<BoxSpace<[f32; 6]>>;
    type ActionSpace = Altered<DiscreteSpace<Action>>;
    type Unwrapped = Acrobot<Fast>;

    fn reset_with(&mut self, mut options: ResetOptions) -> ([f32; 6], Info) {
        match self.flaw {
            "the seed is ignored" => options.seed = None,
            "a reset without a seed does not restart the count" if options.seed.is_some() => {
                self.count.set(0);
            }
            "clones share a count that each reset restarts" => self.shared_count.set(0),
            _ => {}
        }
        let (mut observation, info) = self.env.reset_with(options);
        match self.flaw {
            "the first observation is outside" => observation.as_mut()[1] = -1.5,
            "the first observation depends on the number of resets" => {
                observation.as_mut()[4] = increase(&self.count) as f32;
            }
            _ => {}
        }
        (observation, info)
    }

    fn step(&mut self, action: Action) -> Step<[f32; 6], Info> {
        let mut step = self.env.step(action);
        match self.flaw {
            "observations are outside" => step.observation.as_mut()[0] += 1.0,
            "a reward is NaN" => step.reward = f32::NAN,
            "a reset does not restart the count"
            | "a reset without a seed does not restart the count" => {
                step.truncated = increase(&self.count) >= 500;
            }
            "clones share a count" | "clones share a count that each reset restarts" => {
                step.reward -= (increase(&self.shared_count) % 7) as f32;
            }
            _ => {}
        }
        step
    }

    fn action_space(&self) -> Altered<DiscreteSpace<Action>> {
        Altered {
            space: DiscreteSpace::new(&[Action::Negative, Action::Zero]).unwrap(),
            alter: match self.flaw {
                "samples of actions are outside" => |_| Action::Positive,
                _ => |action| action,
            },
        }
    }

    fn observation_space(&self) -> Altered<BoxSpace<[f32; 6]>> {
        Altered {
            space: self.env.observation_space(),
            alter: match self.flaw {
                "samples of observations are outside" => |seen| seen.map(|x| x + 60.0),
                _ => |seen| seen,
            },
        }
    }

    fn render(&mut self) -> Result<Rendering, Error> {
        if self.flaw == "rendering moves the acrobot" {
            self.unwrapped_mut().step(Action::Zero);
        }
        Err(Error::NoRenderMode)
    }

    fn unwrapped(&self) -> &Acrobot<Fast> {
        self.env.unwrapped()
    }

    fn unwrapped_mut(&mut self) -> &mut Acrobot<Fast> {
        self.env.unwrapped_mut()
    }
}

#[test]
fn every_violation_is_found() {
    let check = |flaw| {
        let env = acrobot_v1(Options::default()).unwrap();
        check_env(&Broken { env, flaw, count: Cell::default(), shared_count: Rc::default() }, 1)
    };
    assert_eq!(check("none"), Ok(()));
    let in_space = "observations are in the observation space";
    let repeats = "the same seed and actions give the same episode";
    let restarts = "a reset after the end begins a full new episode";
    for (flaw, rule) in [
        ("observations are outside", in_space),
        ("the first observation is outside", in_space),
        ("samples of observations are outside", in_space),
        ("samples of actions are outside", "the action space contains its samples"),
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
