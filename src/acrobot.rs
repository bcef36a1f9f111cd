//! The environment: a pendulum, a generator, and the rules of a step and a reset.

use rand_core::Rng;

use crate::action::Action;
use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::math::{Real, SinCos, Zeros};
use crate::numpy::{Pcg64, SeedSequence};
use crate::physics::{Params, Pendulum, State, check_torque, default_model};
use crate::task::{
    Draws, Gymnasium, Observation, Pose, Remembered, ResetBounds, ResetOptions, Task, episode,
};

/// Gymnasium's `reward_threshold`: the mean return of 100 episodes that solves `Acrobot-v1`.
pub const REWARD_THRESHOLD: f32 = -100.0;

/// The result of a step. `O` is the type of the observation.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Step<O = [f32; 6]> {
    /// The observation of the new state.
    pub observation: O,
    /// The task's reward: −1, or 0 if `terminated`; of `Swingup` and `Balance` from 0 to 1.
    pub reward: f32,
    /// Whether the task ended the episode, in Gymnasium's where −cos θ1 − cos(θ1 + θ2) > 1. Never
    /// in `Swingup` and `Balance`.
    pub terminated: bool,
    /// Whether a [`TimeLimit`](crate::TimeLimit) ended the episode.
    pub truncated: bool,
}

impl<O> Step<O> {
    /// Whether the episode is over: `terminated` or `truncated`.
    #[must_use]
    #[inline]
    pub fn is_done(&self) -> bool {
        self.terminated || self.truncated
    }
}

/// One Acrobot: Gymnasium's environment without its wrappers.
///
/// `A` is the [arithmetic](crate::arithmetic), which determines every bit. `R` is the generator for
/// initial states and torque noise. The state [is always
/// finite](Pendulum#results-that-are-not-finite). [`TimeLimit`](crate::TimeLimit) adds truncation:
/// [an example](crate).
///
/// # Snapshots
///
/// With the `serde` feature an acrobot can be saved and loaded; the loaded one continues
/// bit-identically. A snapshot has only numbers of up to 64 bits and no optional field, so any
/// serde format can hold it, also in flattened structs and in tagged enums.
///
/// The first field holds the type, the version, the names of the [task](Task::NAME) and of the
/// [arithmetic](Arithmetic::NAME), with or without friction. Loading rejects another one, and what
/// the setters reject; postcard's errors do not say why. `MAX_SNAPSHOT_SIZE`, also of a
/// [`TimeLimit`](crate::TimeLimit), is the size of a buffer for postcard.
///
/// `Params`, `State` and [`Pcg64`] can also be saved alone, without a version. [An
/// example](crate::guide::embedded_topics#through-a-reset).
#[derive(Clone, Debug, PartialEq)]
pub struct Acrobot<A: Arithmetic, T: Task = Gymnasium, R = Pcg64> {
    pendulum: Pendulum<A>,
    rng: R,
    task: T,
    memory: Remembered<T, A::Scalar>,
}

impl<A: Arithmetic, T: Task> Acrobot<A, T> {
    /// An acrobot with the default parameters, in the initial state of Gymnasium's
    /// `reset(seed=seed)`.
    #[must_use]
    pub fn new(seed: impl Into<SeedSequence>) -> Self {
        Self::with_rng(seed.into().into())
    }

    /// As [`new`](Self::new), with other parameters, and the errors of
    /// [`set_params`](Self::set_params). They change no initial state.
    pub fn with_params(
        seed: impl Into<SeedSequence>,
        params: Params<A::Scalar>,
    ) -> Result<Self, Error> {
        let mut acrobot = Self::new(seed);
        acrobot.set_params(params)?;
        Ok(acrobot)
    }

    /// As [`new`](Self::new), for this task with its parameters, and the errors of
    /// [`set_params`](Self::set_params).
    pub fn with_task(seed: impl Into<SeedSequence>, task: T) -> Result<Self, Error> {
        let mut acrobot = Self::with_rng(Pcg64::UNSEEDED);
        acrobot.task = task;
        acrobot.set_params(task.params().cast())?;
        acrobot.reset_with_seed(seed);
        Ok(acrobot)
    }

    /// Gymnasium's `reset(seed=seed)`: seeds the generator and draws an initial state from it.
    pub fn reset_with_seed(&mut self, seed: impl Into<SeedSequence>) -> T::Observation {
        self.rng = seed.into().into();
        self.reset()
    }

    /// Gymnasium's `reset(seed=…, options=…)`.
    pub fn reset_with(&mut self, options: ResetOptions) -> T::Observation {
        if let Some(seed) = options.seed {
            self.rng = seed.into();
        }
        self.begin(options.bounds.unwrap_or(self.task.reset_bounds()))
    }
}

impl<A: Arithmetic, T: Task, R: Rng> Acrobot<A, T, R> {
    /// Applies the torque of `action` for one dt.
    #[inline]
    pub fn step(&mut self, action: Action) -> Step<T::Observation> {
        self.advance(self.params().torque(action))
    }

    /// Applies a torque, N m, for one dt as [`Pendulum::step`] does, with its errors.
    #[inline]
    pub fn step_torque(&mut self, torque: A::Scalar) -> Result<Step<T::Observation>, Error> {
        check_torque(torque)?;
        Ok(self.advance(torque))
    }

    #[inline]
    fn advance(&mut self, torque: A::Scalar) -> Step<T::Observation> {
        let Self { pendulum, task, memory, .. } = self;
        let torque = task.act::<A, A::Scalar>(memory, pendulum.params(), torque);
        let noise = pendulum.params().torque_noise;
        let torque = episode::disturb(torque, noise, core::iter::once(Some(&mut self.rng)));
        let (model, y, sin_cos) = pendulum.parts();
        let (reward, terminated) =
            episode::step::<A, T, A::Scalar>(model, y, sin_cos, torque, task, memory);
        let sin_cos = *sin_cos;
        Step { observation: self.observe(sin_cos), reward, terminated, truncated: false }
    }

    /// Draws a new initial state from the task's [bounds](Task::reset_bounds) and returns its
    /// observation.
    pub fn reset(&mut self) -> T::Observation {
        self.begin(self.task.reset_bounds())
    }

    /// Draws parameters for the next steps from the generator: call it after a reset.
    ///
    /// # Errors
    ///
    /// Those of [`set_params`](Self::set_params), for what the draws can make of the parameters.
    pub fn draw_params(&mut self, draws: &Draws<A::Scalar>) -> Result<(), Error> {
        draws.check::<A>(self.params())?;
        let params = draws.draw(self.pendulum.params(), &mut self.rng);
        self.set_params(params)
    }

    fn begin(&mut self, bounds: ResetBounds) -> T::Observation {
        let state = self.task.draw(bounds, &mut self.rng).cast();
        let sin_cos = self.pendulum.set_state_unchecked(state);
        let pose = Pose::new(state, sin_cos);
        self.task.begin::<A, R>(&mut self.memory, &pose, Some(&mut self.rng));
        self.observe(sin_cos)
    }

    /// An acrobot with the default parameters, in an initial state drawn from `rng`: a generator of
    /// [`rand_core`](crate::rand_core) 0.10, as those of rand 0.10. One of rand 0.9 needs [an
    /// adapter](crate::guide::rust#generators).
    #[must_use]
    pub fn with_rng(mut rng: R) -> Self {
        const { default_model::<A, T>() };
        let state = T::DEFAULT.draw(T::RESET_BOUNDS, &mut rng).cast();
        // Built field by field: see `Params::default`.
        let params = T::PARAMS.cast();
        let pendulum = Pendulum::new_unchecked(params, state);
        let (mut memory, pose) = (Zeros::ZEROS, Pose::new(state, pendulum.sin_cos()));
        T::DEFAULT.begin::<A, R>(&mut memory, &pose, Some(&mut rng));
        Self { pendulum, rng, task: T::DEFAULT, memory }
    }
}

impl<A: Arithmetic, T: Task, R> Acrobot<A, T, R> {
    /// The observation of the state.
    #[must_use]
    #[inline]
    pub fn observation(&self) -> T::Observation {
        self.observe(self.pendulum.sin_cos())
    }

    #[inline]
    fn observe(&self, sin_cos: [SinCos<A::Scalar>; 2]) -> T::Observation {
        let pose = Pose::new(self.state(), sin_cos).with(&self.memory);
        let mut observation = T::Observation::ZEROS;
        observation.write::<_, A::Scalar>(&self.task.observe::<A, _>(&pose), 0);
        observation
    }

    /// The task.
    #[must_use]
    #[inline]
    pub const fn task(&self) -> &T {
        &self.task
    }

    /// Sets the task for the next steps and resets, such as another point to reach. What it
    /// remembers stays.
    pub fn set_task(&mut self, task: T) {
        self.task = task;
    }

    /// What the task remembers.
    #[must_use]
    #[inline]
    pub const fn memory(&self) -> &Remembered<T, A::Scalar> {
        &self.memory
    }

    /// Sets what the task remembers.
    ///
    /// # Errors
    ///
    /// Those of [`Task::check_memory`]: [`Error::NotFinite`], and the task's own.
    pub fn set_memory(&mut self, memory: Remembered<T, A::Scalar>) -> Result<(), Error> {
        self.task.check_memory(&memory)?;
        self.memory = memory;
        Ok(())
    }

    /// The state.
    #[must_use]
    #[inline]
    pub fn state(&self) -> State<A::Scalar> {
        self.pendulum.state()
    }

    /// Sets the state as [`Pendulum::set_state`] does, with its errors. A task that remembers
    /// [begins](Task::begin) there, without a draw.
    pub fn set_state(&mut self, state: State<A::Scalar>) -> Result<(), Error> {
        self.pendulum.set_state(state)?;
        let pose = Pose::new(state, self.pendulum.sin_cos());
        self.task.begin::<A, Pcg64>(&mut self.memory, &pose, None);
        Ok(())
    }

    /// The parameters.
    #[must_use]
    #[inline]
    pub fn params(&self) -> &Params<A::Scalar> {
        self.pendulum.params()
    }

    /// Sets the parameters for the next steps, with the errors of [`Pendulum::set_params`]. The
    /// state and the generator do not change.
    pub fn set_params(&mut self, params: Params<A::Scalar>) -> Result<(), Error> {
        self.pendulum.set_params(params)
    }

    /// The pendulum. Its clone is a model of this acrobot without noise.
    #[must_use]
    #[inline]
    pub const fn pendulum(&self) -> &Pendulum<A> {
        &self.pendulum
    }

    /// The generator.
    #[must_use]
    #[inline]
    pub fn rng(&self) -> &R {
        &self.rng
    }

    /// The generator, to draw from it or to replace it.
    #[must_use]
    #[inline]
    pub fn rng_mut(&mut self) -> &mut R {
        &mut self.rng
    }

    /// An acrobot with the default parameters that hangs at rest, also in a
    /// [`static`](crate::guide::embedded#a-first-program). What a task remembers is 0 until a reset.
    #[must_use]
    pub const fn hanging(rng: R) -> Self {
        let model = const { default_model::<A, T>() };
        Self::from_pendulum(Pendulum::from_model(model, [A::Scalar::ZERO; 4]), rng)
    }

    /// An acrobot with the parameters and the state of `pendulum`, which [`Params::pendulum`] makes
    /// [in a `const`](crate::guide::embedded_topics).
    #[must_use]
    pub const fn from_pendulum(pendulum: Pendulum<A>, rng: R) -> Self {
        Self { pendulum, rng, task: T::DEFAULT, memory: Zeros::ZEROS }
    }
}

#[cfg(feature = "serde")]
impl<A: Arithmetic, T: Task> Acrobot<A, T> {
    /// The largest size of a snapshot in postcard's format, bytes, without a checksum.
    pub const MAX_SNAPSHOT_SIZE: usize = crate::snapshot::Header::<A, T, false>::SIZE
        + (crate::physics::NUMBERS + 4) * size_of::<A::Scalar>() // the parameters and the state
        + 1 // the dynamics
        + <T::Memory as crate::task::Memory>::LEN * size_of::<A::Scalar>()
        + Pcg64::MAX_SNAPSHOT_SIZE;
}

#[cfg(feature = "defmt")]
impl<A: Arithmetic, T: Task, R: defmt::Format> defmt::Format for Acrobot<A, T, R> {
    fn format(&self, f: defmt::Formatter<'_>) {
        let (params, state, rng) = (self.params(), self.state(), &self.rng);
        defmt::write!(f, "Acrobot {{ params: {}, state: {}, rng: {} }}", params, state, rng);
    }
}

#[cfg(feature = "serde")]
mod snapshot {
    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::{Serialize, Serializer};

    use super::Acrobot;
    use crate::arithmetic::Arithmetic;
    use crate::physics::{Params, Pendulum, State};
    use crate::snapshot::{Header, numbers};
    use crate::task::{Remembered, Task};

    #[derive(serde::Serialize, serde::Deserialize)]
    #[serde(rename = "Acrobot", bound(serialize = "T: Serialize, R: Serialize"))]
    #[serde(bound(deserialize = "T: Deserialize<'de>, R: Deserialize<'de>"))]
    struct Snapshot<A: Arithmetic, T: Task, R> {
        snapshot: Header<A, T, false>,
        params: Params<A::Scalar>,
        state: State<A::Scalar>,
        rng: R,
        #[serde(
            skip_serializing_if = "numbers::is_empty::<A::Scalar, T::Memory>",
            default = "numbers::missing::<A::Scalar, T::Memory>",
            serialize_with = "numbers::serialize::<A::Scalar, T::Memory, _>",
            deserialize_with = "numbers::deserialize::<A::Scalar, T::Memory, _>"
        )]
        memory: Remembered<T, A::Scalar>,
    }

    impl<A: Arithmetic, T: Task + Serialize, R: Serialize> Serialize for Acrobot<A, T, R> {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            Snapshot {
                snapshot: Header::<A, _, _>::of(self.task),
                params: *self.params(),
                state: self.state(),
                rng: &self.rng,
                memory: self.memory,
            }
            .serialize(serializer)
        }
    }

    impl<'de, A: Arithmetic, T, R: Deserialize<'de>> Deserialize<'de> for Acrobot<A, T, R>
    where
        T: Task + Deserialize<'de>,
    {
        /// Rejects what `set_params` and `set_state` reject.
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            let Snapshot { snapshot, params, state, rng, memory } =
                Snapshot::<A, T, R>::deserialize(deserializer)?;
            let task = snapshot.task;
            task.check_memory(&memory).map_err(D::Error::custom)?;
            let pendulum = Pendulum::new(params, state).map_err(D::Error::custom)?;
            Ok(Self { pendulum, rng, task, memory })
        }
    }
}
