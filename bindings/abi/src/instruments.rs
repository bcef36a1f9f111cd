//! The motors and sensors of a batch, in a library that is compiled with the feature `instruments`.

use core::mem::transmute;
use core::ptr;

use acrobot::task::{Draw, Instruments};

use crate::batch::{AnyBatch, acrobot_batch_t};
use crate::data::acrobot_draw_t;
use crate::memory::{change, get, read};
use crate::status::{Rejected, acrobot_error_t, acrobot_status_t};
use crate::task::{BatchTask, any_task};

/// The longest delay, steps.
pub const ACROBOT_LONGEST_DELAY: usize = 8;

/// The motor and the sensors of an acrobot. Zeros are ideal: a torque acts at once, and the
/// observation is that of the true state.
// derive.py writes the fields of these structs.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_instruments_t {
    /// How many steps later a torque acts: a whole number, each equally likely.
    pub action_delay: f32,
    /// How many steps later an agent sees a reading: a whole number, each equally likely.
    pub observation_delay: f32,
    /// The time constant of the motor, s, from 0 to 1000: the torque approaches the chosen one.
    pub motor_lag: f32,
    /// The relative error of the motor's torque, from −1 to 1000: with 0.1 it is 10 % too large.
    pub torque_error: f32,
    /// The standard deviation of a reading of an angle, rad, from 0 to 10.
    pub angle_noise: f32,
    /// What encoder 1 reads where θ1 is 0, rad, from −π to π.
    pub encoder_zero1: f32,
    /// What encoder 2 reads where θ2 is 0, rad, from −π to π.
    pub encoder_zero2: f32,
    /// The counts of the encoders for a turn, from 1 to 2²²: readings are whole counts.
    pub encoder_counts: f32,
    /// The time constant of a low-pass filter, s, from 0 to 1000. The agent sees filtered
    /// differences of readings as velocities, and not the true ones.
    pub velocity_filter: f32,
}

/// How resets draw the instruments, in the order of acrobot_instruments_t. Zeros draw nothing:
/// the numbers stay.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_instrument_draws_t {
    pub action_delay: acrobot_draw_t,
    pub observation_delay: acrobot_draw_t,
    pub motor_lag: acrobot_draw_t,
    pub torque_error: acrobot_draw_t,
    pub angle_noise: acrobot_draw_t,
    pub encoder_zero1: acrobot_draw_t,
    pub encoder_zero2: acrobot_draw_t,
    pub encoder_counts: acrobot_draw_t,
    pub velocity_filter: acrobot_draw_t,
}

const COUNT: usize = size_of::<acrobot_instruments_t>() / size_of::<f32>();

/// From now on each reset draws the instruments of each acrobot, after the initial state and from
/// the same random numbers. A delay is a whole number up to ACROBOT_LONGEST_DELAY, drawn uniformly.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_set_instrument_draws(
    batch: *mut acrobot_batch_t,
    draws: *const acrobot_instrument_draws_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(batch, ptr::null_mut(), error, |placed| {
        // SAFETY: both are `repr(C)` and have so many draws.
        let draws: [acrobot_draw_t; COUNT] = transmute(read(draws)?);
        let mut instruments = *placed.batch.task().instruments();
        for (to, draw) in instruments.numbers_mut().into_iter().zip(draws) {
            let draw = Draw::try_from(draw)?;
            *to = to.map_or(Some(draw).filter(|draw| *draw != Draw::Fixed), |_| Some(draw));
        }
        set(&mut placed.batch, instruments)
    })
}

fn set(batch: &mut AnyBatch, instruments: Instruments) -> Result<(), Rejected> {
    batch.set_task(BatchTask::new(any_task(batch.task()), instruments)?);
    Ok(())
}

/// The instruments of an acrobot: those that the last reset drew, or that were set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_instruments(
    batch: *const acrobot_batch_t,
    index: usize,
    instruments: *mut acrobot_instruments_t,
) -> acrobot_status_t {
    get(batch, instruments, |placed| {
        let numbers = BatchTask::drawn(&placed.batch.memory(index)?).numbers();
        // SAFETY: both have so many numbers.
        Ok(transmute::<[f32; COUNT], acrobot_instruments_t>(numbers.map(|(_, number)| number)))
    })
}

/// Sets the instruments of an acrobot, until a reset draws them. All acrobots of a batch have the
/// kinds of instruments that one has, so with a `velocity_filter` all see differences of readings,
/// which are not filtered where it is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_set_instruments(
    batch: *mut acrobot_batch_t,
    index: usize,
    instruments: *const acrobot_instruments_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(batch, ptr::null_mut(), error, |placed| {
        let mut draws = *placed.batch.task().instruments();
        let drawn = numbers(read(instruments)?);
        for (draw, (_, number)) in draws.numbers_mut().into_iter().zip(drawn.numbers()) {
            if number != 0.0 {
                draw.get_or_insert(Draw::Fixed);
            }
        }
        remember(&mut placed.batch, index, drawn)?;
        set(&mut placed.batch, draws)
    })
}

/// As acrobot_batch_set_instruments, for all acrobots. Where a number is 0 and resets draw none,
/// all are ideal.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_set_all_instruments(
    batch: *mut acrobot_batch_t,
    instruments: *const acrobot_instruments_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(batch, ptr::null_mut(), error, |placed| {
        let mut draws = *placed.batch.task().instruments();
        let drawn = numbers(read(instruments)?);
        for (draw, (_, number)) in draws.numbers_mut().into_iter().zip(drawn.numbers()) {
            if matches!(draw, None | Some(Draw::Fixed)) {
                *draw = Some(Draw::Fixed).filter(|_| number != 0.0);
            }
        }
        // The first rejects what any would.
        for index in 0..placed.batch.len() {
            remember(&mut placed.batch, index, drawn)?;
        }
        set(&mut placed.batch, draws)
    })
}

fn numbers(instruments: acrobot_instruments_t) -> Instruments<f32> {
    // SAFETY: both have so many numbers.
    let numbers: [f32; COUNT] = unsafe { transmute(instruments) };
    let mut drawn = Instruments::default();
    drawn.numbers_mut().into_iter().zip(numbers).for_each(|(to, number)| *to = number);
    drawn
}

fn remember(
    batch: &mut AnyBatch,
    index: usize,
    instruments: Instruments<f32>,
) -> Result<(), Rejected> {
    let mut memory = batch.memory(index)?;
    BatchTask::set_drawn(&mut memory, instruments)?;
    Ok(batch.set_memory(index, memory)?)
}
