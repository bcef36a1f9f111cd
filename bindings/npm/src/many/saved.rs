//! Snapshots of batches and of acrobots alone.

use std::mem;
use std::num::NonZeroU32;

use acrobot::Params;
use acrobot::batch::{Autoreset, Member};
use acrobot::numpy::Pcg64;
use acrobot::physics::State;
use acrobot::task::{Draw, Draws, ResetBounds};
use serde::Serialize;

use super::{Many, Tasks};
use crate::snapshot::{self, Reader, Rejected, read};

/// The fields of an acrobot's snapshot after the header and the parameters.
type Alone = (State<f32>, Pcg64, NonZeroU32, u32);

/// The fields of a batch's snapshot after the number of acrobots and one, and the header: the
/// bounds of initial states, the limit of steps, when resets are, and whether parameters are own.
type Settings = (f64, f64, NonZeroU32, Autoreset, bool);

/// The fields of each of its acrobots after the parameters.
type Fields = (State<f32>, u32, bool, Pcg64);

#[unsafe(no_mangle)]
pub extern "C" fn save(many: &Many) -> usize {
    let (count, task) = (many.actions.len(), many.batch.number());
    let (settings, draws): (Settings, _) = with_task!(&many.batch, batch => {
        let (bounds, draws) = (batch.reset_bounds(), *batch.draws().params());
        let (low, high, limit) = (bounds.low(), bounds.high(), batch.max_steps());
        ((low, high, limit, batch.autoreset(), batch.has_own_params()), draws)
    });
    // The settings have less than 512 bytes, each acrobot at most 151.
    snapshot::save(512 + count * 151, |writer| {
        if many.is_alone {
            snapshot::write_header("acrobot", task, writer)?;
        } else {
            (count as u32 + 1).serialize(&mut *writer)?;
            snapshot::write_header("batch", task, writer)?;
            settings.serialize(&mut *writer)?;
            snapshot::write_params(draws, writer)?;
        }
        for index in 0..count {
            let member = with_task!(&many.batch, batch => {
                batch.member(index).map(|Member { params, state, elapsed_steps, is_done, rng }| {
                    (params, (state, elapsed_steps, is_done, rng))
                })
            });
            if let Ok((params, fields)) = member {
                snapshot::write_params(params, writer)?;
                if many.is_alone {
                    let (state, elapsed_steps, _, rng) = fields;
                    let alone: Alone = (state, rng, settings.2, elapsed_steps);
                    return alone.serialize(writer);
                }
                fields.serialize(&mut *writer)?;
            }
        }
        Ok(())
    })
}

fn load(mut reader: Reader<'_>, len: usize, is_alone: bool) -> Result<Many, Rejected> {
    if is_alone {
        let task = snapshot::read_header(&mut reader, "acrobot")?;
        return load_alone(reader, task).ok_or(Rejected::Contents);
    }
    let count: u32 = read(&mut reader).ok_or(Rejected::Header)?;
    let task = snapshot::read_header(&mut reader, "batch")?;
    let count = count.saturating_sub(1) as usize;
    // Parameters and state have 89 bytes. Other numbers could take all memory.
    if count > len / 89 {
        return Err(Rejected::Contents);
    }
    load_batch(reader, count, task).ok_or(Rejected::Contents)
}

fn load_alone(mut reader: Reader<'_>, task: u32) -> Option<Many> {
    let mut many = Many::new(1, true, task, true)?;
    let params = snapshot::read_params(&mut reader, Params::DEFAULT)?;
    let (state, rng, max_steps, elapsed_steps) = read::<Alone>(&mut reader)?;
    many.set_limits(Some(max_steps), Autoreset::Disabled);
    many.load_member(0, params, (state, elapsed_steps, false, rng))?;
    many.note_torques();
    reader.finalize().ok()?.is_empty().then_some(many)
}

fn load_batch(mut reader: Reader<'_>, count: usize, task: u32) -> Option<Many> {
    let (low, high, max_steps, autoreset, own_params) = read::<Settings>(&mut reader)?;
    let draws: Params<Draw<f32>> = snapshot::read_params(&mut reader, Draws::FIXED)?;
    let mut many = Many::new(count, own_params, task, false)?;
    for index in 0..count {
        let params = snapshot::read_params(&mut reader, Params::DEFAULT)?;
        many.load_member(index, params, read(&mut reader)?)?;
    }
    many.set_limits(Some(max_steps), autoreset);
    with_task!(&mut many.batch, batch => {
        batch.set_draws(Draws::new(draws).ok()?).ok()?;
        batch.set_reset_bounds(ResetBounds::new(low, high).ok()?);
    });
    many.note_torques();
    reader.finalize().ok()?.is_empty().then_some(many)
}

impl Many {
    fn load_member(&mut self, index: usize, params: Params<f32>, fields: Fields) -> Option<()> {
        let (state, elapsed_steps, is_done, rng) = fields;
        with_task!(&mut self.batch, batch => {
            // The first brings the parameters, if all acrobots share them.
            if index == 0 {
                batch.set_all_params(params).ok()?;
            }
            let member = Member { params, state, elapsed_steps, is_done, rng };
            batch.set_member(index, member).ok()
        })
    }
}

/// Loads a snapshot of any task. If it is invalid, or without memory, nothing changes.
#[unsafe(no_mangle)]
pub extern "C" fn load_snapshot(many: &mut Many, address: *const u8, len: usize) -> u32 {
    let reader = snapshot::open(address, len);
    let loaded = reader.and_then(|reader| load(reader, len, many.is_alone));
    snapshot::code(loaded.map(|mut loaded| {
        mem::swap(&mut loaded.action_space, &mut many.action_space);
        *many = loaded;
    }))
}
