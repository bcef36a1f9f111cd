//! The environment: parameters, a state, a generator, and what a step does to them.

use rand_core::Rng;

use crate::action::Action;
use crate::arithmetic::{Arithmetic, Portable, Real};
use crate::bounds::{is_settled, settle};
use crate::dynamics::{Driven, Model, SinCos, reaches_goal, sin_cos};
use crate::error::{Allowed, Error};
use crate::observation::Observation;
use crate::params::Params;
use crate::rk4::rk4_from;
use crate::rng::{Pcg64, uniform};
use crate::seed::SeedSequence;
use crate::state::{StartBounds, State};

/// The mean return of 100 episodes from which on Gymnasium calls `Acrobot-v1` solved.
pub const REWARD_THRESHOLD: f32 = -100.0;

/// What a step returns.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Step {
    /// What the agent sees of the new state.
    pub observation: Observation,
    /// −1, or 0 for the step that reaches the goal.
    pub reward: f32,
    /// Whether the new state is in the goal: −cos θ1 − cos(θ1 + θ2) > 1.
    pub terminated: bool,
}

/// One Acrobot: Gymnasium's environment without its wrappers.
///
/// `A` fixes the bits, see [`Arithmetic`]; name it always, since a default does not drive
/// inference. `R` is the generator that starts and torque noise are drawn from.
///
/// It always has a valid state. Stepping on past the goal goes on, as in Gymnasium;
/// [`TimeLimit`](crate::TimeLimit) adds truncation.
///
/// ```
/// use acrobot::{Acrobot, Action, Fast};
///
/// let mut acrobot = Acrobot::<Fast>::new(42); // the start of Gymnasium's reset(seed=42)
/// let mut steps = 0;
/// while !acrobot.step(Action::Positive).terminated && steps < 500 {
///     steps += 1;
/// }
/// acrobot.reset(); // the next start of the same stream
/// ```
///
/// # What cannot be represented
///
/// Extreme but valid parameters, starts and torques can take a step's result out of the range of
/// the scalar. A step whose result is not finite keeps the angles and sets both velocities to 0.
/// Starts far outside of ±π are valid: the first step wraps the angles and bounds the velocities.
/// No step, reset or observation hangs, panics or turns into NaN.
///
/// # Snapshots
///
/// With the `serde` feature an acrobot is stored in any format of serde's, and goes on to the same bits. The
/// first field says what is stored, its version (1) and its scalar. Loading refuses any other, with both
/// in the reason, which postcard drops; parameters and states that the setters refuse; and an even
/// increment of a [`Pcg64`]. A [`TimeLimit`](crate::TimeLimit) has the version of what it wraps. What
/// snapshots consist of (`Params`, `State`, `Pcg64`) can be stored alone, without a version and, but for
/// the generator, unchecked.
///
/// ```
/// use acrobot::{Acrobot, Fast, Portable};
///
/// let acrobot = Acrobot::<Portable>::new(42);
/// let text = serde_json::to_string(&acrobot)?;
/// assert!(text.starts_with(r#"{"snapshot":{"of":"acrobot","version":1,"scalar":"f64"}"#));
/// assert_eq!(serde_json::from_str::<Acrobot<Portable>>(&text)?, acrobot);
///
/// let error = serde_json::from_str::<Acrobot<Fast>>(&text).unwrap_err().to_string();
/// assert!(error.contains("version 1, in f64; allowed is \"acrobot\", version 1, in f32"));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Acrobot<A: Arithmetic = Portable, R = Pcg64> {
    model: Model<A::Scalar>,
    state: State<A::Scalar>,
    /// Of the state's θ1 and θ2: the observation needs them, and so does the next step.
    sin_cos: [SinCos<A::Scalar>; 2],
    rng: R,
}

/// What firmware counts on, checked wherever the crate is built. `u128` is aligned to 8 bytes on ARM.
const _: () = {
    let limit = if cfg!(target_arch = "arm") { 184 } else { 192 };
    assert!(size_of::<Acrobot<crate::Fast>>() <= limit);
};

impl<A: Arithmetic> Acrobot<A> {
    /// An acrobot with the default parameters, at the start of Gymnasium's `reset(seed=seed)`.
    #[must_use]
    pub fn new(seed: impl Into<SeedSequence>) -> Self {
        Self::with_rng(Pcg64::new(seed))
    }

    /// Gymnasium's `reset(seed=seed)`: seeds the generator anew and draws a start from it.
    pub fn reset_seeded(&mut self, seed: impl Into<SeedSequence>) -> Observation {
        self.reseed(seed);
        self.reset()
    }

    /// Seeds the generator anew and changes nothing else: for a seeded reset within other bounds.
    pub fn reseed(&mut self, seed: impl Into<SeedSequence>) {
        self.rng = Pcg64::new(seed);
    }
}

impl<A: Arithmetic, R: Rng> Acrobot<A, R> {
    /// An acrobot with the default parameters, at a start drawn from `rng`.
    #[must_use]
    pub fn with_rng(mut rng: R) -> Self {
        let start = StartBounds::DEFAULT.draw(&mut rng).cast();
        Self::assemble(Params::default(), start, rng)
    }

    /// Draws a new start from [`StartBounds::DEFAULT`] and returns what the agent sees of it.
    pub fn reset(&mut self) -> Observation {
        self.reset_within(StartBounds::DEFAULT)
    }

    /// Draws a new start from `bounds`, as Gymnasium's
    /// `reset(options={"low": low, "high": high})`.
    pub fn reset_within(&mut self, bounds: StartBounds) -> Observation {
        let start = bounds.draw(&mut self.rng).cast();
        self.place(start);
        self.observation()
    }

    /// Applies the torque of `action` for one `dt`.
    #[inline]
    pub fn step(&mut self, action: Action) -> Step {
        self.advance(self.model.params.torque(action))
    }

    /// Applies a torque in N m, of any size, for one `dt`: for controllers.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a torque that is not finite; nothing is stepped then.
    #[inline]
    pub fn step_torque(&mut self, torque: A::Scalar) -> Result<Step, Error> {
        Allowed::Finite.check("torque", torque, "N m")?;
        Ok(self.advance(torque))
    }

    #[inline]
    fn advance(&mut self, torque: A::Scalar) -> Step {
        let torque = if self.model.params.torque_noise > A::Scalar::ZERO {
            let noise = self.model.params.torque_noise.to_f64();
            torque + A::Scalar::from_f64(uniform(&mut self.rng, -noise, noise))
        } else {
            torque
        };
        let terminated = transition::<A>(&self.model, &mut self.state, &mut self.sin_cos, torque);
        Step {
            observation: self.observation(),
            reward: if terminated { 0.0 } else { -1.0 },
            terminated,
        }
    }
}

impl<A: Arithmetic, R> Acrobot<A, R> {
    /// What the agent sees of the state.
    #[must_use]
    #[inline]
    pub fn observation(&self) -> Observation {
        let [(sin1, cos1), (sin2, cos2)] = self.sin_cos;
        let f32 = |x: A::Scalar| x.to_f64() as f32;
        let State {
            dtheta1, dtheta2, ..
        } = self.state;
        Observation([cos1, sin1, cos2, sin2, dtheta1, dtheta2].map(f32))
    }

    /// The state.
    #[must_use]
    #[inline]
    pub fn state(&self) -> State<A::Scalar> {
        self.state
    }

    /// Sets the state; angles and velocities may lie outside of their bounds until the next step.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a number that is not finite; the state stays as it was.
    pub fn set_state(&mut self, state: State<A::Scalar>) -> Result<(), Error> {
        state.validate()?;
        self.place(state);
        Ok(())
    }

    /// The parameters.
    #[must_use]
    #[inline]
    pub fn params(&self) -> &Params<A::Scalar> {
        &self.model.params
    }

    /// Sets the parameters, from the next step on; the state and the generator stay.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] with the first field that [`Params::validate`] refuses; the parameters
    /// stay as they were.
    pub fn set_params(&mut self, params: Params<A::Scalar>) -> Result<(), Error> {
        params.validate()?;
        self.model = Model::new::<A>(params);
        Ok(())
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

    /// The mass matrix at the state, kg m²; see [`mass_matrix`](crate::mass_matrix).
    #[must_use]
    pub fn mass_matrix(&self) -> [[A::Scalar; 2]; 2] {
        self.model.mass_matrix::<A>(&self.state)
    }

    /// The total energy of the state, J; see [`energy`](crate::energy).
    #[must_use]
    pub fn energy(&self) -> A::Scalar {
        self.model.energy::<A>(&self.state)
    }

    /// The height of the tip above the fixed joint, m; see [`tip_height`](crate::tip_height).
    #[must_use]
    pub fn tip_height(&self) -> A::Scalar {
        self.model.tip_height::<A>(&self.state)
    }

    /// Of valid parts.
    fn assemble(params: Params<A::Scalar>, state: State<A::Scalar>, rng: R) -> Self {
        Self {
            model: Model::new::<A>(params),
            state,
            sin_cos: sin_cos::<A>(&state),
            rng,
        }
    }

    fn place(&mut self, state: State<A::Scalar>) {
        self.state = state;
        self.sin_cos = sin_cos::<A>(&state);
    }
}

/// A state after one `dt` under a torque, the sines and cosines of its angles, and whether it is in
/// the goal.
#[inline(always)]
pub(crate) fn transition<A: Arithmetic>(
    model: &Model<A::Scalar>,
    state: &mut State<A::Scalar>,
    sin_cos: &mut [SinCos<A::Scalar>; 2],
    torque: A::Scalar,
) -> bool {
    let driven = Driven::<A, _>::new(model, torque);
    let y: [A::Scalar; 4] = (*state).into();
    let k1 = driven.with_sin_cos(y, *sin_cos);
    let next = rk4_from(A::FORM, y, k1, model.dts, &driven);

    *state = next.into();
    if !is_settled(state, &model.params) {
        settle::<A>(state, [y[0], y[1]], &model.params);
    }
    *sin_cos = [A::sin_cos_near(state.theta1), A::sin_cos_near(state.theta2)];
    reaches_goal::<A>(state, *sin_cos)
}

impl<A: Arithmetic, R: PartialEq> PartialEq for Acrobot<A, R> {
    /// Parameters, state and generator; of what is derived from them extreme parameters make NaN, which
    /// is not equal to itself.
    fn eq(&self, other: &Self) -> bool {
        self.params() == other.params() && self.state == other.state && self.rng == other.rng
    }
}

#[cfg(feature = "defmt")]
impl<A: Arithmetic<Scalar: defmt::Format>, R: defmt::Format> defmt::Format for Acrobot<A, R> {
    /// Parameters, state and generator; the rest is derived from them.
    fn format(&self, f: defmt::Formatter<'_>) {
        let (params, state, rng) = (self.params(), self.state, &self.rng);
        defmt::write!(
            f,
            "Acrobot {{ params: {}, state: {}, rng: {} }}",
            params,
            state,
            rng
        );
    }
}

#[cfg(feature = "serde")]
mod snapshot {
    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::{Serialize, Serializer};

    use super::{Acrobot, Arithmetic, Params, State};
    use crate::snapshot::{Header, Subject};

    impl<A: Arithmetic, R> Subject for Acrobot<A, R> {
        const NAME: &'static str = "acrobot";
        type Scalar = A::Scalar;
    }

    /// What of an acrobot cannot be derived.
    #[derive(serde::Serialize, serde::Deserialize)]
    #[serde(rename = "Acrobot")]
    struct Snapshot<H, S, R> {
        snapshot: H,
        params: Params<S>,
        state: State<S>,
        rng: R,
    }

    impl<A: Arithmetic<Scalar: Serialize>, R: Serialize> Serialize for Acrobot<A, R> {
        fn serialize<T: Serializer>(&self, serializer: T) -> Result<T::Ok, T::Error> {
            Snapshot {
                snapshot: Header::<Self>::NEW,
                params: *self.params(),
                state: self.state,
                rng: &self.rng,
            }
            .serialize(serializer)
        }
    }

    impl<'de, A, R> Deserialize<'de> for Acrobot<A, R>
    where
        A: Arithmetic<Scalar: Deserialize<'de>>,
        R: Deserialize<'de>,
    {
        /// Refuses what `set_params` and `set_state` refuse.
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            let Snapshot::<Header<Self>, _, _> {
                params, state, rng, ..
            } = Snapshot::deserialize(deserializer)?;
            params.validate().map_err(D::Error::custom)?;
            state.validate().map_err(D::Error::custom)?;
            Ok(Self::assemble(params, state, rng))
        }
    }
}
