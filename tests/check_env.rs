//! `check_env` passes what keeps the contract of `Env`, and finds who breaks it.

use std::cell::Cell;
use std::fmt::Debug;
use std::rc::Rc;

use acrobot::env::{
    BoxSpace, Discrete, Env, EnvStep, Error, Info, Options, RecordEpisodeStatistics, RenderMode,
    Rendering, Space, Violation, acrobot_v0, acrobot_v1, check_env,
};
use acrobot::{
    Acrobot, Action, Fast, Host, Micro, Observation, Params, Portable, SeedSequence, StartBounds,
    TimeLimit,
};
use rand_core::Rng;

#[test]
fn our_environments_keep_the_contract() {
    fn check<E>(env: E)
    where
        E: Env<Observation: Clone + Debug + PartialEq, Action: Clone> + Clone,
    {
        for seed in 0..3 {
            check_env(&env, seed).unwrap();
        }
    }
    let options = || Options {
        render_mode: RenderMode::RgbArray,
        ..Options::default()
    };
    check(Acrobot::<Host>::new(0));
    check(Acrobot::<Micro>::new(0));
    check(TimeLimit::v1(Acrobot::<Portable>::new(0)));
    check(acrobot_v0::<Fast>(options()).unwrap());
    check(acrobot_v1::<Host>(options()).unwrap());
    check(RecordEpisodeStatistics::new(
        acrobot_v1::<Fast>(options()).unwrap(),
    ));
    let noisy = Params {
        torque_noise: 0.5,
        max_velocity1: 1.0,
        max_velocity2: 1.0,
        ..Params::DEFAULT
    };
    check(
        acrobot_v1::<Portable>(Options {
            params: noisy,
            ..options()
        })
        .unwrap(),
    );
}

/// How an environment can break the contract.
#[derive(Clone)]
enum Flaw {
    /// None: to see that the wrapper itself passes.
    None,
    /// Observations leave their space.
    Outside,
    /// The start is out of its space.
    OutsideAtStart,
    /// A reward is NaN.
    Reward,
    /// What is seen of the start hangs on how often it was reset.
    Start(Cell<u32>),
    /// The seed is ignored.
    Seed,
    /// The time limit's count goes on over a reset: truncation is reported again.
    Count(Cell<u32>),
    /// The same, with a count that only a seed restarts.
    Unseeded(Cell<u32>),
    /// Clones share what they should own.
    Shared(Rc<Cell<u32>>),
    /// Clones share it, and nobody notices from one reset to the next.
    SharedInEpisode(Rc<Cell<u32>>),
    /// Rendering moves the acrobot.
    Render,
    /// A space does not contain what it samples.
    ObservationSamples,
    ActionSamples,
}

/// A space that samples something else than what it is asked for.
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
    env: TimeLimit<Acrobot<Fast>>,
    flaw: Flaw,
}

impl Env for Broken {
    type Observation = Observation;
    type Action = Action;
    type ObservationSpace = Altered<BoxSpace<Observation>>;
    type ActionSpace = Altered<Discrete<Action>>;
    type Unwrapped = Acrobot<Fast>;

    fn reset(
        &mut self,
        seed: Option<SeedSequence>,
        bounds: Option<StartBounds>,
    ) -> (Observation, Info) {
        let seed = if matches!(self.flaw, Flaw::Seed) {
            None
        } else {
            seed
        };
        match &self.flaw {
            Flaw::Unseeded(count) if seed.is_some() => count.set(0),
            Flaw::SharedInEpisode(count) => count.set(0),
            _ => {}
        }
        let (mut start, info) = Env::reset(&mut self.env, seed, bounds);
        match &self.flaw {
            Flaw::OutsideAtStart => start.0[1] = -1.5,
            Flaw::Start(count) => {
                count.set(count.get() + 1);
                start.0[4] = count.get() as f32;
            }
            _ => {}
        }
        (start, info)
    }

    fn step(&mut self, action: Action) -> EnvStep<Observation> {
        let mut step = Env::step(&mut self.env, action);
        match &self.flaw {
            Flaw::Outside => step.observation.0[0] += 1.0,
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

    fn action_space(&self) -> Altered<Discrete<Action>> {
        match self.flaw {
            Flaw::ActionSamples => Altered {
                space: Discrete::new(&[Action::Negative, Action::Zero]).unwrap(),
                alter: |_| Action::Positive,
            },
            _ => Altered {
                space: self.env.action_space(),
                alter: |action| action,
            },
        }
    }

    fn observation_space(&self) -> Altered<BoxSpace<Observation>> {
        let space = self.env.observation_space();
        match self.flaw {
            Flaw::ObservationSamples => Altered {
                space,
                alter: |seen| Observation(seen.map(|x| x + 60.0)),
            },
            _ => Altered {
                space,
                alter: |seen| seen,
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
fn the_contracts_check_finds_who_breaks_it() {
    let check = |flaw| {
        check_env(
            &Broken {
                env: TimeLimit::v1(Acrobot::new(0)),
                flaw,
            },
            1,
        )
    };
    assert_eq!(check(Flaw::None), Ok(()));
    for (flaw, rule) in [
        (Flaw::Outside, "an observation is in the observation space"),
        (
            Flaw::OutsideAtStart,
            "an observation is in the observation space",
        ),
        (Flaw::Reward, "a reward is finite"),
        (
            Flaw::Seed,
            "the same seed and the same actions give the same episode",
        ),
        (
            Flaw::Start(Cell::new(0)),
            "the same seed and the same actions give the same episode",
        ),
        (
            Flaw::Count(Cell::new(0)),
            "a reset after an end starts a whole new episode",
        ),
        (
            Flaw::Unseeded(Cell::new(0)),
            "a reset after an end starts a whole new episode",
        ),
        (
            Flaw::Shared(Rc::new(Cell::new(0))),
            "the same seed and the same actions give the same episode",
        ),
        (
            Flaw::SharedInEpisode(Rc::new(Cell::new(0))),
            "a clone does what its original would have done",
        ),
        (
            Flaw::ObservationSamples,
            "an observation is in the observation space",
        ),
        (Flaw::ActionSamples, "the action space contains its samples"),
        (Flaw::Render, "rendering changes nothing"),
    ] {
        let violation = check(flaw).expect_err(rule);
        let Violation {
            rule: broken,
            found,
        } = &violation;
        assert_eq!(*broken, rule, "{found}");
        assert!(!found.is_empty());
        assert_eq!(violation.to_string(), format!("{rule}: {found}"));
    }
}
