//! `check_env` finds every violation of the contract of `Env`. `cargo test -p properties` finds
//! none in our environments.

use std::cell::Cell;
use std::rc::Rc;

use acrobot::env::{
    AcrobotEnv, BoxSpace, DiscreteSpace, Env, Error, Info, Rendering, Space, Violation, check_env,
};
use acrobot::{Acrobot, Action, Fast, Observation, ResetOptions, Step, TimeLimit};
use rand_core::Rng;

/// How an environment can break the contract.
#[derive(Clone)]
enum Flaw {
    /// No flaw: the wrapper itself keeps the contract.
    None,
    /// Observations leave their space.
    Outside,
    /// The first observation is outside its space.
    OutsideAtReset,
    /// A reward is NaN.
    Reward,
    /// The first observation depends on the number of resets.
    Resets(Cell<u32>),
    /// The seed is ignored.
    Seed,
    /// A reset does not restart the time limit's count, so truncation is reported again.
    Count(Cell<u32>),
    /// As `Count`, but a reset with a seed restarts the count.
    Unseeded(Cell<u32>),
    /// Clones share a count.
    Shared(Rc<Cell<u32>>),
    /// Clones share a count that each reset restarts.
    SharedInEpisode(Rc<Cell<u32>>),
    /// Rendering moves the acrobot.
    Render,
    /// A space does not contain its samples.
    ObservationSamples,
    ActionSamples,
}

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
    env: TimeLimit<AcrobotEnv<Fast, Observation>>,
    flaw: Flaw,
}

impl Env for Broken {
    type Observation = Observation;
    type Action = Action;
    type ObservationSpace = Altered<BoxSpace<Observation>>;
    type ActionSpace = Altered<DiscreteSpace<Action>>;
    type Unwrapped = Acrobot<Fast>;

    fn reset_with(&mut self, mut options: ResetOptions) -> (Observation, Info) {
        match &self.flaw {
            Flaw::Seed => options.seed = None,
            Flaw::Unseeded(count) if options.seed.is_some() => count.set(0),
            Flaw::SharedInEpisode(count) => count.set(0),
            _ => {}
        }
        let (mut observation, info) = self.env.reset_with(options);
        match &self.flaw {
            Flaw::OutsideAtReset => observation.as_mut()[1] = -1.5,
            Flaw::Resets(count) => {
                count.set(count.get() + 1);
                observation.as_mut()[4] = count.get() as f32;
            }
            _ => {}
        }
        (observation, info)
    }

    fn step(&mut self, action: Action) -> Step<Observation, Info> {
        let mut step = self.env.step(action);
        match &self.flaw {
            Flaw::Outside => step.observation.as_mut()[0] += 1.0,
            Flaw::Reward => step.reward = f32::NAN,
            Flaw::Count(count) | Flaw::Unseeded(count) => {
                count.set(count.get() + 1);
                step.truncated = count.get() >= 500;
            }
            Flaw::Shared(count) | Flaw::SharedInEpisode(count) => {
                count.set(count.get() + 1);
                step.reward -= (count.get() % 7) as f32;
            }
            _ => {}
        }
        step
    }

    fn action_space(&self) -> Altered<DiscreteSpace<Action>> {
        Altered {
            space: DiscreteSpace::new(&[Action::Negative, Action::Zero]).unwrap(),
            alter: match self.flaw {
                Flaw::ActionSamples => |_| Action::Positive,
                _ => |action| action,
            },
        }
    }

    fn observation_space(&self) -> Altered<BoxSpace<Observation>> {
        Altered {
            space: self.env.observation_space(),
            alter: match self.flaw {
                Flaw::ObservationSamples => |seen| seen.to_array().map(|x| x + 60.0).into(),
                _ => |seen| seen,
            },
        }
    }

    fn render(&mut self) -> Result<Rendering, Error> {
        if matches!(self.flaw, Flaw::Render) {
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
    let check = |flaw| check_env(&Broken { env: TimeLimit::v1(AcrobotEnv::default()), flaw }, 1);
    assert_eq!(check(Flaw::None), Ok(()));
    let in_space = "observations are in the observation space";
    let repeats = "the same seed and actions give the same episode";
    let restarts = "a reset after the end begins a full new episode";
    for (flaw, rule) in [
        (Flaw::Outside, in_space),
        (Flaw::OutsideAtReset, in_space),
        (Flaw::ObservationSamples, in_space),
        (Flaw::ActionSamples, "the action space contains its samples"),
        (Flaw::Reward, "rewards are finite"),
        (Flaw::Seed, repeats),
        (Flaw::Resets(Cell::default()), repeats),
        (Flaw::Shared(Rc::default()), repeats),
        (Flaw::SharedInEpisode(Rc::default()), "a clone behaves like its original"),
        (Flaw::Count(Cell::default()), restarts),
        (Flaw::Unseeded(Cell::default()), restarts),
        (Flaw::Render, "rendering changes nothing"),
    ] {
        let violation = check(flaw).expect_err(rule);
        let Violation { rule: broken, found } = &violation;
        assert_eq!(*broken, rule, "{found}");
        assert!(!found.is_empty());
        assert_eq!(violation.to_string(), format!("{rule}: {found}"));
    }
}
