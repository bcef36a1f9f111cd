//! The motor and the sensors of a real acrobot, and what each reset draws of them.

use rand_core::Rng;

use super::draws::Draw;
use crate::error::Error;
use crate::math::Real;
use crate::numpy::uniform;

/// The motor and the sensors of an acrobot: how each reset draws them, or with numbers for `D` what
/// it drew. `None` is ideal and takes no time; with [`Draw::Fixed`] each acrobot keeps its number,
/// which is 0 until it is [set](crate::batch::Batch::set_memory).
///
/// ```
/// use acrobot::task::{Draw, Instruments};
///
/// let instruments = Instruments {
///     action_delay: Some(Draw::Uniform { low: 0.0, high: 3.0 }), // steps
///     encoder_counts: Some(Draw::exactly(4096.0)),
///     ..Instruments::IDEAL
/// };
/// assert!(instruments.motor_lag.is_none());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Instruments<D = Option<Draw<f32>>> {
    /// How many steps later a torque acts: a whole number, each equally likely.
    pub action_delay: D,
    /// How many steps later an agent sees a reading: a whole number, each equally likely.
    pub observation_delay: D,
    /// The time constant of the motor, s, from 0 to 1000: the torque approaches the chosen one.
    pub motor_lag: D,
    /// The relative error of the motor's torque, from −1 to 1000: with 0.1 it is 10 % too large.
    pub torque_error: D,
    /// The standard deviation of a reading of an angle, rad, from 0 to 10.
    pub angle_noise: D,
    /// What encoder 1 reads where θ1 is 0, rad, from −π to π.
    pub encoder_zero1: D,
    /// What encoder 2 reads where θ2 is 0, rad, from −π to π.
    pub encoder_zero2: D,
    /// The counts of the encoders for a turn, from 1 to 2²²: readings are whole counts.
    pub encoder_counts: D,
    /// The time constant of a low-pass filter, s, from 0 to 1000. The agent sees filtered
    /// differences of readings as velocities, and not the true ones.
    pub velocity_filter: D,
}

/// How many they are.
pub(super) const COUNT: usize = 9;

/// The name, the unit, the least and the largest number, and a rule.
type Field = (&'static str, &'static str, f32, f32, &'static str);

const PI: f32 = core::f32::consts::PI;

/// The largest delay is a constant of the task.
const FIELDS: [Field; COUNT] = [
    ("action_delay", "steps", 0.0, 0.0, "drawn uniformly from whole numbers up to DELAY, in"),
    ("observation_delay", "steps", 0.0, 0.0, "drawn uniformly from whole numbers up to DELAY, in"),
    ("motor_lag", "s", 0.0, 1e3, "from 0 to 1000"),
    ("torque_error", "", -1.0, 1e3, "from -1 to 1000"),
    ("angle_noise", "rad", 0.0, 10.0, "from 0 to 10"),
    ("encoder_zero1", "rad", -PI, PI, "from -π to π"),
    ("encoder_zero2", "rad", -PI, PI, "from -π to π"),
    ("encoder_counts", "a turn", 1.0, 4_194_304.0, "from 1 to 2²²"),
    ("velocity_filter", "s", 0.0, 1e3, "from 0 to 1000"),
];

impl Instruments {
    /// A torque acts at once, and an agent sees the true state.
    pub const IDEAL: Self = Self {
        action_delay: None,
        observation_delay: None,
        motor_lag: None,
        torque_error: None,
        angle_noise: None,
        encoder_zero1: None,
        encoder_zero2: None,
        encoder_counts: None,
        velocity_filter: None,
    };

    /// Whether an agent sees the true state. A reading of it is wrapped, which rounds.
    pub(super) const fn has_ideal_sensors(&self) -> bool {
        self.observation_delay.is_none()
            && self.angle_noise.is_none()
            && self.encoder_zero1.is_none()
            && self.encoder_zero2.is_none()
            && self.encoder_counts.is_none()
            && self.velocity_filter.is_none()
    }

    /// Checks what resets may draw.
    pub(super) fn check(&self, delay: usize) -> Result<(), Error> {
        for ((name, draw), field) in self.numbers().into_iter().zip(FIELDS) {
            let (_, unit, ..) = field;
            match draw {
                None | Some(Draw::Fixed) => continue,
                Some(draw) => draw.check(name, unit)?,
            }
            let bounds = draw.map_or([0.0; 2], |draw| draw.bounds(0.0));
            let is_uniform = matches!(draw, Some(Draw::Uniform { .. }));
            if unit == "steps" && !is_uniform {
                return Err(out_of_range(field, bounds[0]));
            }
            bounds.into_iter().try_for_each(|number| check_number(field, delay, number))?;
        }
        Ok(())
    }

    /// Replaces the numbers of an acrobot by what a reset draws.
    pub(super) fn draw<S: Real, R: Rng + ?Sized>(&self, drawn: &mut [S; COUNT], rng: &mut R) {
        let draws = self.numbers().into_iter().zip(FIELDS);
        for (number, ((_, draw), (_, unit, ..))) in drawn.iter_mut().zip(draws) {
            *number = match draw {
                None => S::ZERO,
                Some(Draw::Fixed) => *number,
                Some(Draw::Uniform { low, high }) if unit == "steps" && low < high => {
                    let [low, high] = [low, high].map(f64::from);
                    S::from_f64(libm::floor(uniform(rng, low, high + 1.0)).min(high))
                }
                Some(draw) => S::from_f64(draw.draw(0.0, rng).into()),
            };
        }
    }
}

impl<D: Copy> Instruments<D> {
    /// The name and the draw, or the number, of each, in the order of the fields.
    #[must_use]
    pub fn numbers(&self) -> [(&'static str, D); COUNT] {
        let (mut numbers, mut fields) = (*self, FIELDS.into_iter());
        let name = |number: &mut D| (fields.next().map_or("", |(name, ..)| name), *number);
        numbers.numbers_mut().map(name)
    }

    /// Each draw or number, to change it, in the order of the fields.
    pub const fn numbers_mut(&mut self) -> [&mut D; COUNT] {
        [
            &mut self.action_delay,
            &mut self.observation_delay,
            &mut self.motor_lag,
            &mut self.torque_error,
            &mut self.angle_noise,
            &mut self.encoder_zero1,
            &mut self.encoder_zero2,
            &mut self.encoder_counts,
            &mut self.velocity_filter,
        ]
    }
}

/// Checks the numbers of one acrobot, of which ideal ones are 0.
pub(super) fn check_drawn<S: Real>(drawn: &[S; COUNT], delay: usize) -> Result<(), Error> {
    let drawn = drawn.iter().map(|x| x.to_f64() as f32).zip(FIELDS);
    drawn
        .filter(|(number, _)| *number != 0.0)
        .try_for_each(|(number, field)| check_number(field, delay, number))
}

fn check_number(field: Field, delay: usize, number: f32) -> Result<(), Error> {
    let (_, unit, least, largest, _) = field;
    let holds = match unit {
        "steps" => number <= delay as f32 && number == libm::floorf(number) && number >= least,
        _ => (least..=largest).contains(&number),
    };
    if holds { Ok(()) } else { Err(out_of_range(field, number)) }
}

fn out_of_range((name, unit, _, _, rule): Field, number: f32) -> Error {
    Error::OutOfRange { name, value: number.into(), unit, rule }
}
