//! A task whose motor and sensors are those of a real acrobot.

use core::num::NonZeroU32;

use rand_core::Rng;

use super::encoders::{approach, differentiate, scale};
use super::instruments::{COUNT, Instruments, check_drawn};
use super::memory::check_finite;
use super::noise::{self, Noise};
use super::reset_bounds::ResetBounds;
use super::{Observation, Pose, Remembered, Task};
use crate::arithmetic::{Arithmetic, Numbers, Real};
use crate::error::Error;
use crate::physics::{Params, State, wrap_each};

/// Another task through the motor and the sensors of a real acrobot: an agent's torque comes later
/// and wrong, and what it sees does, too. Rewards and ends use the true state. `DELAY` is the
/// longest delay, steps: [an example](crate::guide::tasks#instruments).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Measured<T, const DELAY: usize = 4> {
    task: T,
    instruments: Instruments,
}

/// The torque that acted, without its error, and the chosen ones before, the newest first.
type Motor<const DELAY: usize> = (f32, [f32; DELAY]);
/// The newest reading of the angles and velocities, and those before, the newest first.
type Sensors<const DELAY: usize> = ([f32; 4], [[f32; DELAY]; 4]);
/// What resets drew, and what the instruments remember.
type Own<const DELAY: usize> = (([f32; COUNT], Noise), (Motor<DELAY>, Sensors<DELAY>));

/// A task with ideal instruments.
impl<T: Task, const DELAY: usize> From<T> for Measured<T, DELAY> {
    fn from(task: T) -> Self {
        Self { task, instruments: Instruments::IDEAL }
    }
}

impl<T: Task, const DELAY: usize> Measured<T, DELAY> {
    /// A task with these instruments.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a draw of a number outside of its range, for a delay that is not
    /// whole, not drawn uniformly or longer than `DELAY`, and for what
    /// [`Draws::new`](super::Draws::new) rejects.
    pub fn new(task: T, instruments: Instruments) -> Result<Self, Error> {
        instruments.check(DELAY)?;
        Ok(Self { task, instruments })
    }

    /// The task without instruments.
    #[must_use]
    pub const fn task(&self) -> &T {
        &self.task
    }

    /// How resets draw the instruments.
    #[must_use]
    pub const fn instruments(&self) -> &Instruments {
        &self.instruments
    }

    /// The instruments of an acrobot that remembers this, as a critic may see them.
    #[must_use]
    pub fn drawn<S: Real>(memory: &Remembered<Self, S>) -> Instruments<S> {
        let mut drawn = Instruments::default();
        drawn.numbers_mut().into_iter().zip(memory.0.0.0).for_each(|(to, number)| *to = number);
        drawn
    }

    /// Replaces the instruments that an acrobot remembers. Those that the task draws are replaced
    /// again by the next reset.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a number outside of its range, unless it is 0.
    pub fn set_drawn<S: Real>(
        memory: &mut Remembered<Self, S>,
        drawn: Instruments<S>,
    ) -> Result<(), Error> {
        let numbers = drawn.numbers().map(|(_, number)| number);
        check_drawn(&numbers, DELAY)?;
        memory.0.0.0 = numbers;
        Ok(())
    }

    /// What the sensors read in a pose: angles within ±π, and true velocities.
    #[inline(always)]
    fn read<S: Real, V: Numbers<S>>(
        &self,
        drawn: &[V; COUNT],
        noise: &mut [V; 2],
        state: State<V>,
    ) -> [V; 4] {
        let [.., deviation, zero1, zero2, counts, _] = *drawn;
        let mut angles = [state.theta1, state.theta2];
        if self.instruments.encoder_zero1.is_some() || self.instruments.encoder_zero2.is_some() {
            angles = [angles[0] + zero1, angles[1] + zero2];
        }
        // Loops, because LLVM keeps `array::map` out of line.
        if self.instruments.angle_noise.is_some() {
            for angle in &mut angles {
                *angle = *angle + deviation * noise::normal::<S, V>(noise);
            }
        }
        for angle in &mut angles {
            *angle = wrap_each::<S, V>(*angle);
        }
        if self.instruments.encoder_counts.is_some() {
            let (of_a_radian, resolution) = scale::<S, V>(counts);
            for angle in &mut angles {
                let counted = (*angle * of_a_radian).map(S::round_small) * resolution;
                *angle = counts.select_abs_le(S::ZERO, *angle, counted);
            }
        }
        let [theta1, theta2] = angles;
        [theta1, theta2, state.dtheta1, state.dtheta2]
    }
}

impl<T: Task, const DELAY: usize> Task for Measured<T, DELAY> {
    const NAME: &'static str = "measured";
    const DEFAULT: Self = Self { task: T::DEFAULT, instruments: Instruments::IDEAL };
    const MAX_STEPS: NonZeroU32 = T::MAX_STEPS;
    const RESET_BOUNDS: ResetBounds = T::RESET_BOUNDS;
    const PARAMS: Params = T::PARAMS;

    type Observation = T::Observation;
    type Memory = (Own<DELAY>, T::Memory);

    fn max_steps(&self) -> NonZeroU32 {
        self.task.max_steps()
    }

    fn reset_bounds(&self) -> ResetBounds {
        self.task.reset_bounds()
    }

    fn params(&self) -> Params {
        self.task.params()
    }

    fn draw<R: Rng + ?Sized>(&self, bounds: ResetBounds, rng: &mut R) -> State<f32> {
        self.task.draw(bounds, rng)
    }

    fn begin<A: Arithmetic, R: Rng + ?Sized>(
        &self,
        ((constants, (motor, sensors)), inner): &mut Remembered<Self, A::Scalar>,
        pose: &Pose<A::Scalar>,
        mut rng: Option<&mut R>,
    ) {
        let (drawn, noise) = constants;
        if let Some(rng) = rng.as_deref_mut() {
            self.instruments.draw(drawn, rng);
            if self.instruments.angle_noise.is_some() {
                *noise = noise::seed(rng);
            }
        }
        *motor = (A::Scalar::ZERO, [A::Scalar::ZERO; DELAY]);
        let reading = self.read(drawn, noise, pose.state);
        *sensors = (reading, reading.map(|x| [x; DELAY]));
        self.task.begin::<A, R>(inner, pose, rng);
    }

    #[inline(always)]
    fn act<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        (((drawn, _), ((acting, chosen), _)), inner): &mut Remembered<Self, V>,
        params: &Params<V>,
        mut torque: V,
    ) -> V {
        let [delay, _, lag, error, ..] = *drawn;
        if self.instruments.action_delay.is_some() {
            let newest = torque;
            torque = delayed(delay, newest, chosen);
            push(newest, chosen);
        }
        if self.instruments.motor_lag.is_some() {
            torque = approach(*acting, torque, lag, params.dt);
        }
        *acting = torque;
        if self.instruments.torque_error.is_some() {
            torque = torque + torque * error;
        }
        self.task.act::<A, V>(inner, params, torque)
    }

    #[inline(always)]
    fn remember<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        (((drawn, noise), (_, (newest, past))), inner): &mut Remembered<Self, V>,
        pose: &Pose<V>,
        params: &Params<V>,
        torque: V,
    ) {
        let [.., filter] = *drawn;
        let before = *newest;
        if self.instruments.observation_delay.is_some() {
            past.iter_mut().zip(before).for_each(|(past, before)| push(before, past));
        }
        *newest = self.read(drawn, noise, pose.state);
        if self.instruments.velocity_filter.is_some() {
            differentiate::<A::Scalar, V>(newest, before, filter, params.dt);
        }
        self.task.remember::<A, V>(inner, pose, params, torque);
    }

    #[inline(always)]
    fn observe<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        pose: &Pose<V, Remembered<Self, V>>,
    ) -> <T::Observation as Observation>::Of<V> {
        let (((drawn, _), (_, (newest, past))), inner) = pose.memory;
        if self.instruments.has_ideal_sensors() {
            return self.task.observe::<A, V>(&pose.with(inner));
        }
        let [_, delay, ..] = *drawn;
        let mut seen = *newest;
        if self.instruments.observation_delay.is_some() {
            for (seen, past) in seen.iter_mut().zip(past) {
                *seen = delayed(delay, *seen, past);
            }
        }
        let [theta1, theta2, ..] = seen;
        let sin_cos = [A::sin_cos_near(theta1), A::sin_cos_near(theta2)];
        self.task.observe::<A, V>(&Pose::new(seen.into(), sin_cos).with(inner))
    }

    /// Differences of readings can be half a turn a step.
    fn observation_high(&self, params: &Params<f32>) -> T::Observation {
        let mut params = *params;
        if self.instruments.velocity_filter.is_some() {
            let highest = 1.000_01 * core::f32::consts::PI / params.dt; // with its rounding
            params.max_velocity1 = params.max_velocity1.max(highest);
            params.max_velocity2 = params.max_velocity2.max(highest);
        }
        self.task.observation_high(&params)
    }

    #[inline(always)]
    fn terminated<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        pose: &Pose<V, Remembered<Self, V>>,
    ) -> V::Mask {
        self.task.terminated::<A, V>(&pose.with(&pose.memory.1))
    }

    #[inline(always)]
    fn reward<A: Arithmetic, V: Numbers<A::Scalar>>(
        &self,
        pose: &Pose<V, Remembered<Self, V>>,
        params: &Params<V>,
        torque: V,
        terminated: V::Mask,
    ) -> V::Single {
        self.task.reward::<A, V>(&pose.with(&pose.memory.1), params, torque, terminated)
    }

    fn check_memory<S: Real>(&self, memory: &Remembered<Self, S>) -> Result<(), Error> {
        let (own, inner) = memory;
        let ((drawn, noise), (_, ([theta1, theta2, ..], [past1, past2, ..]))) = own;
        check_drawn(drawn, DELAY)?;
        check_finite::<Own<DELAY>, S>(own)?;
        let check = |name, x: S, least, limit, unit, rule| {
            let value = x.to_f64();
            let holds = (least..=limit).contains(&value);
            if holds { Ok(()) } else { Err(Error::OutOfRange { name, value, unit, rule }) }
        };
        for angle in [theta1, theta2].into_iter().chain(past1).chain(past2) {
            check("reading", *angle, -3.15, 3.15, "rad", "from -3.15 to 3.15")?; // rounded counts
        }
        for number in noise {
            check("noise", *number, 0.0, f64::from(noise::PERIOD - 1), "", "from 0 to 2²³ - 1")?;
        }
        self.task.check_memory(inner)
    }
}

/// The number that was pushed `delay` steps ago: `newest`, which is not yet pushed, for 0.
#[inline(always)]
fn delayed<S: Real, V: Numbers<S>>(delay: V, newest: V, past: &[V]) -> V {
    let (mut found, mut limit) = (newest, 0.5);
    for older in past {
        found = delay.select_abs_le(S::from_f64(limit), found, *older);
        limit += 1.0;
    }
    found
}

/// Puts a number in front of a line, whose last one is lost.
#[inline(always)]
#[expect(clippy::manual_swap, reason = "with a swap of lanes a step takes twice as long")]
fn push<V: Copy>(mut newest: V, line: &mut [V]) {
    for number in line {
        let older = *number;
        *number = newest;
        newest = older;
    }
}

#[cfg(feature = "serde")]
mod snapshot {
    use heapless::String;
    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::{Serialize, Serializer};

    use super::Measured;
    use crate::task::instruments::Instruments;
    use crate::task::{NAME_LIMIT, Task};

    #[derive(serde::Serialize, serde::Deserialize)]
    #[serde(rename = "Measured")]
    struct Data<Text, T> {
        /// The name of the task.
        task: Text,
        data: T,
        instruments: Instruments,
        longest_delay: u32,
    }

    impl<T: Task + Serialize, const DELAY: usize> Serialize for Measured<T, DELAY> {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            let Self { task, instruments } = *self;
            let longest_delay = DELAY as u32;
            Data { task: task.name(), data: task, instruments, longest_delay }.serialize(serializer)
        }
    }

    impl<'de, T, const DELAY: usize> Deserialize<'de> for Measured<T, DELAY>
    where
        T: Task + Deserialize<'de>,
    {
        /// Rejects another task, another `DELAY`, and what [`Measured::new`] rejects.
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            let Data { task, data, instruments, longest_delay } =
                Data::<String<NAME_LIMIT>, T>::deserialize(deserializer)?;
            let named = data.named(&task).filter(|_| longest_delay as usize == DELAY);
            let task = named.ok_or_else(|| {
                D::Error::custom(format_args!(
                    "the measured task must be {:?} with delays up to {DELAY}, got {task:?} with \
                    delays up to {longest_delay}",
                    T::DEFAULT.name(),
                ))
            })?;
            Self::new(task, instruments).map_err(D::Error::custom)
        }
    }
}
