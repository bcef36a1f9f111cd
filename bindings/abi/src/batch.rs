//! A batch in the caller's memory: its header, then its blocks, then its generators.

use core::ffi::{c_int, c_void};
use core::{ptr, slice};

use acrobot::batch::{Autoreset, Batch, BatchMemory, Block, StepBuffers};
use acrobot::numpy::Pcg64;
use acrobot::task::Gymnasium;
use acrobot::{Fast, Params, ResetOptions};

use crate::data::{acrobot_observation_t, acrobot_params_t, acrobot_state_t};
use crate::memory::{Holder, Span, array, change, check, check_apart, get, optional, read};
use crate::single::check_max_steps;
use crate::status::{Rejected, acrobot_error_t, acrobot_status_t, acrobot_status_t::*, status};

/// Alignment of a batch's memory.
pub const ACROBOT_BATCH_ALIGN: usize = 64;

// The header has these numbers, too: ACROBOT_BATCH_SIZE.
const HEADER: usize = 256;
const GENERATOR: usize = 48;
/// Acrobots that are stepped side by side. Microcontrollers have no SIMD for floats.
const LANES: usize = if usize::BITS == 64 { 16 } else { 1 };
const BLOCK: usize = if usize::BITS == 64 { 640 } else { 64 };

/// The default: the step after an episode's end resets the acrobot. It ignores the action and
/// returns the initial observation and a reward of 0.
pub const ACROBOT_AUTORESET_NEXT_STEP: c_int = 0;

/// The step that ends an episode resets the acrobot. It returns the initial observation, and the
/// last one in `final_observations`.
pub const ACROBOT_AUTORESET_SAME_STEP: c_int = 1;

/// The acrobots step on until acrobot_batch_reset_masked or another reset.
pub const ACROBOT_AUTORESET_DISABLED: c_int = 2;

/// Acrobots in the memory of acrobot_batch_init. It contains pointers into this memory, so do not
/// move or copy it.
#[repr(align(64))]
pub struct acrobot_batch_t {
    _header: [u8; HEADER],
}

/// Where acrobot_batch_step writes.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_batch_results_t {
    /// −1, or 0 if the acrobot terminated or was only reset.
    pub rewards: *mut f32,
    /// As in acrobot_step_t.
    pub terminated: *mut bool,
    pub truncated: *mut bool,
    /// Of the new states; null if you do not need them.
    pub observations: *mut acrobot_observation_t,
    /// With ACROBOT_AUTORESET_SAME_STEP, those of the episodes that this step ended; other elements
    /// are not written. Null if you do not need them.
    pub final_observations: *mut acrobot_observation_t,
}

type LanesBlock = Block<Fast, LANES>;

type Memory = BatchMemory<&'static mut [LanesBlock], &'static mut [Pcg64]>;

pub struct Placed {
    /// Where `acrobot_batch_init` put it.
    address: usize,
    batch: Batch<Fast, Memory, Gymnasium, LANES>,
}

impl Holder for acrobot_batch_t {
    type Value = Placed;

    const TAG: u32 = u32::from_le_bytes(*b"bats");

    unsafe fn span(this: *const Self) -> Result<Span, Rejected> {
        Ok(memory_of(this, Self::value(this)?.batch.len()))
    }

    fn check_address(placed: &Placed, this: *const Self) -> Result<(), Rejected> {
        if placed.address == this.addr() { Ok(()) } else { Err(ACROBOT_ERROR_MOVED.into()) }
    }
}

const _: () = {
    assert!(align_of::<acrobot_batch_t>() == ACROBOT_BATCH_ALIGN);
    assert!(align_of::<LanesBlock>() <= ACROBOT_BATCH_ALIGN);
    assert!(size_of::<LanesBlock>() == BLOCK);
    assert!(size_of::<Pcg64>() <= GENERATOR);
    // The batch writes an observation as six floats.
    assert!(align_of::<[f32; 6]>() == align_of::<acrobot_observation_t>());
};

/// The batch, if arrays of `count` elements have one for each acrobot.
unsafe fn counted<'a>(
    batch: *const acrobot_batch_t,
    count: usize,
) -> Result<&'a mut Placed, Rejected> {
    let placed = Holder::value_mut(batch.cast_mut())?;
    if placed.batch.len() == count { Ok(placed) } else { Err(ACROBOT_ERROR_WRONG_COUNT.into()) }
}

fn memory_of(batch: *const acrobot_batch_t, count: usize) -> Span {
    Span::new(batch.cast::<u8>(), acrobot_batch_size(count))
}

/// ACROBOT_BATCH_SIZE(count), but at most SIZE_MAX.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_batch_size(count: usize) -> usize {
    let blocks = count.div_ceil(LANES);
    blocks
        .saturating_mul(BLOCK)
        .saturating_add(count.saturating_mul(GENERATOR))
        .saturating_add(HEADER)
}

/// Makes a batch in `memory`, which has `size` bytes, with default parameters, in initial states.
/// Acrobot `i` is seeded with NumPy's `SeedSequence(seed).spawn(count)[i]`. `batch` receives the
/// batch's address.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_init(
    memory: *mut c_void,
    size: usize,
    count: usize,
    seed: u64,
    batch: *mut *mut acrobot_batch_t,
) -> acrobot_status_t {
    status(|| {
        let to: *mut acrobot_batch_t = memory.cast();
        check(to)?;
        check(batch)?;
        if count == 0 {
            return Err(ACROBOT_ERROR_WRONG_COUNT.into());
        }
        if size < acrobot_batch_size(count) {
            return Err(ACROBOT_ERROR_BUFFER_TOO_SMALL.into());
        }
        check_apart(&[memory_of(to, count), Span::new(batch, 1)])?;
        let blocks: *mut LanesBlock = to.add(1).cast();
        let block_count = count.div_ceil(LANES);
        let generators: *mut Pcg64 = blocks.add(block_count).cast();
        for index in 0..block_count {
            blocks.add(index).write(Block::EMPTY);
        }
        for index in 0..count {
            generators.add(index).write(Pcg64::UNSEEDED);
        }
        let blocks = slice::from_raw_parts_mut(blocks, block_count);
        let generators = slice::from_raw_parts_mut(generators, count);
        let batch_memory = BatchMemory { blocks, generators, own: () };
        let value = Placed { address: to.addr(), batch: Batch::new(seed, batch_memory)? };
        Holder::init(to, value)?;
        batch.write(to);
        Ok(())
    })
}

/// Applies an action to each acrobot for one dt. If one is rejected, no acrobot steps, but
/// `terminated` and `truncated` become false.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_step(
    batch: *mut acrobot_batch_t,
    actions: *const u8,
    results: *const acrobot_batch_results_t,
    count: usize,
) -> acrobot_status_t {
    status(|| {
        let placed = counted(batch, count)?;
        let pointers = Span::new(results, 1);
        let results = read(results)?;
        let actions = array(actions.cast_mut(), count)?;
        let rewards = array(results.rewards, count)?;
        let terminated = array(results.terminated, count)?;
        let truncated = array(results.truncated, count)?;
        let observations = optional(results.observations.cast(), count)?;
        let finals = optional(results.final_observations.cast(), count)?;
        check_apart(&[
            memory_of(batch, count),
            pointers,
            Span::of(actions),
            Span::of(rewards),
            Span::of(terminated),
            Span::of(truncated),
            Span::of(observations),
            Span::of(finals),
        ])?;
        // They may contain bytes that no `bool` has.
        results.terminated.write_bytes(0, count);
        results.truncated.write_bytes(0, count);
        let mut buffers = StepBuffers::new(&mut *rewards, &mut *terminated, &mut *truncated);
        buffers.observations = observations.as_mut();
        buffers.final_observations = finals.as_mut();
        placed.batch.step_into(&*actions, buffers)?;
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_observe(
    batch: *const acrobot_batch_t,
    observations: *mut acrobot_observation_t,
    count: usize,
) -> acrobot_status_t {
    status(|| {
        let placed = counted(batch, count)?;
        let observations = array(observations.cast(), count)?;
        check_apart(&[memory_of(batch, count), Span::of(observations)])?;
        Ok(placed.batch.observe(&mut *observations)?)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_count(
    batch: *const acrobot_batch_t,
    count: *mut usize,
) -> acrobot_status_t {
    get(batch, count, |placed| Ok(placed.batch.len()))
}

/// As acrobot_reset, for each acrobot.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_reset(batch: *mut acrobot_batch_t) -> acrobot_status_t {
    status(|| {
        Holder::value_mut(batch)?.batch.reset();
        Ok(())
    })
}

/// As acrobot_batch_reset, after seeding each acrobot as acrobot_batch_init does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_reset_with_seed(
    batch: *mut acrobot_batch_t,
    seed: u64,
) -> acrobot_status_t {
    status(|| {
        Holder::value_mut(batch)?.batch.reset_with_seed(seed);
        Ok(())
    })
}

/// As acrobot_batch_reset, after seeding acrobot `i` as acrobot_reset_with_seed does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_reset_with_seeds(
    batch: *mut acrobot_batch_t,
    seeds: *const u64,
    count: usize,
) -> acrobot_status_t {
    status(|| {
        let placed = counted(batch, count)?;
        let seeds = array(seeds.cast_mut(), count)?;
        check_apart(&[memory_of(batch, count), Span::of(seeds)])?;
        for (generator, seed) in placed.batch.generators_mut().iter_mut().zip(&*seeds) {
            *generator = Pcg64::new(*seed);
        }
        placed.batch.reset();
        Ok(())
    })
}

/// As acrobot_batch_reset, where `mask` is true. A byte that is neither true nor false is rejected.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_reset_masked(
    batch: *mut acrobot_batch_t,
    mask: *const bool,
    count: usize,
) -> acrobot_status_t {
    status(|| {
        let placed = counted(batch, count)?;
        let bytes = array(mask.cast::<u8>().cast_mut(), count)?;
        check_apart(&[memory_of(batch, count), Span::of(bytes)])?;
        if (*bytes).iter().any(|byte| *byte > 1) {
            return Err(ACROBOT_ERROR_OUT_OF_RANGE.into());
        }
        let mask = slice::from_raw_parts(mask, count);
        Ok(placed.batch.reset_masked(mask, ResetOptions::default())?)
    })
}

/// When acrobots are reset whose episode has ended: an ACROBOT_AUTORESET.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_set_autoreset(
    batch: *mut acrobot_batch_t,
    autoreset: c_int,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(batch, ptr::null_mut(), error, |placed| {
        placed.batch.set_autoreset(match autoreset {
            ACROBOT_AUTORESET_NEXT_STEP => Autoreset::NextStep,
            ACROBOT_AUTORESET_SAME_STEP => Autoreset::SameStep,
            ACROBOT_AUTORESET_DISABLED => Autoreset::Disabled,
            other => return Err(Rejected::number("autoreset", other.into(), "", "0, 1 or 2")),
        });
        Ok(())
    })
}

/// As acrobot_set_max_steps, for all acrobots.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_set_max_steps(
    batch: *mut acrobot_batch_t,
    max_steps: u32,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(batch, ptr::null_mut(), error, |placed| {
        placed.batch.set_max_steps(check_max_steps(max_steps)?);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_state(
    batch: *const acrobot_batch_t,
    index: usize,
    state: *mut acrobot_state_t,
) -> acrobot_status_t {
    get(batch, state, |placed| Ok(placed.batch.state(index)?.into()))
}

/// The number of its steps stays.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_set_state(
    batch: *mut acrobot_batch_t,
    index: usize,
    state: *const acrobot_state_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(batch, ptr::null_mut(), error, |placed| {
        Ok(placed.batch.set_state(index, read(state)?.into())?)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_params(
    batch: *const acrobot_batch_t,
    params: *mut acrobot_params_t,
) -> acrobot_status_t {
    get(batch, params, |placed| Ok(placed.batch.params(0).unwrap_or(Params::DEFAULT).into()))
}

/// As acrobot_set_params, for all acrobots.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_set_params(
    batch: *mut acrobot_batch_t,
    params: *const acrobot_params_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(batch, ptr::null_mut(), error, |placed| {
        Ok(placed.batch.set_all_params(read(params)?.try_into()?)?)
    })
}
