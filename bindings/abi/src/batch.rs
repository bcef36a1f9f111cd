//! A batch in the caller's memory: its header, then its blocks, their own parameters, if any, and
//! the generators.

use core::ffi::{c_int, c_void};
use core::{ptr, slice};

use acrobot::Fast;
use acrobot::arithmetic::Damped;
use acrobot::batch::StepBuffers;
use acrobot::batch::{Batch, BatchMemory, Block, Input, LaneParams, OwnParams};
use acrobot::numpy::Pcg64;
use acrobot::task::Task;

use crate::data::acrobot_observation_t;
use crate::memory::{Holder, Span, array, change, check, check_apart, get, read};
use crate::status::{Rejected, acrobot_error_t, acrobot_status_t, acrobot_status_t::*, status};
use crate::task::{BatchTask, acrobot_reset_options_t, any_task, read_options, task_of};

/// Alignment of a batch's memory.
pub const ACROBOT_BATCH_ALIGN: usize = 64;

// The header has these numbers, too: ACROBOT_BATCH_SIZE.
pub const HEADER: usize = if cfg!(feature = "instruments") { 896 } else { 704 };
/// What the task remembers of an acrobot.
pub const MEMORY: usize = if cfg!(feature = "instruments") { 224 } else { 0 };
const GENERATOR: usize = size_of::<Pcg64>();
/// Acrobots that are stepped side by side. Microcontrollers have no SIMD for floats.
const LANES: usize = if cfg!(target_family = "wasm") {
    4
} else if usize::BITS == 64 {
    16
} else {
    1
};
const BLOCK: usize = size_of::<LanesBlock>();
const OWN: usize = size_of::<Own>();

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

/// What all acrobots of a batch share.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_batch_settings_t {
    /// The number of acrobots, above 0.
    pub count: usize,
    /// An ACROBOT_TASK.
    pub task: c_int,
    /// Whether each acrobot has its own parameters.
    pub own_params: bool,
    /// When acrobots are reset whose episode has ended: an ACROBOT_AUTORESET.
    pub autoreset: c_int,
    /// Episodes are truncated after so many steps.
    pub max_steps: u32,
}

/// Where acrobot_batch_step writes.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct acrobot_batch_results_t {
    /// As in acrobot_step_t; 0 if the acrobot was only reset.
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

type LanesBlock = Block<Damped<Fast>, LANES, <BatchTask as Task>::Memory>;

type Own = LaneParams<Damped<Fast>, LANES>;

/// `Own` is empty where acrobots share their parameters.
pub type Memory =
    BatchMemory<&'static mut [LanesBlock], &'static mut [Pcg64], OwnParams<&'static mut [Own]>>;

pub type AnyBatch = Batch<Damped<Fast>, Memory, BatchTask, LANES>;

pub struct Placed {
    /// Where `acrobot_batch_init` put it.
    address: usize,
    pub batch: AnyBatch,
}

impl Holder for acrobot_batch_t {
    type Value = Placed;

    const TAG: u32 = u32::from_le_bytes(*b"bats");

    unsafe fn span(this: *const Self) -> Result<Span, Rejected> {
        Ok(memory_of(this, &Self::value(this)?.batch))
    }

    fn check_address(placed: &Placed, this: *const Self) -> Result<(), Rejected> {
        if placed.address == this.addr() { Ok(()) } else { Err(ACROBOT_ERROR_MOVED.into()) }
    }
}

const _: () = {
    assert!(align_of::<acrobot_batch_t>() == ACROBOT_BATCH_ALIGN);
    assert!(align_of::<LanesBlock>() <= ACROBOT_BATCH_ALIGN);
    // cbindgen.toml has these numbers for the header. An error of the compiler shows both.
    const SIZES: [usize; 3] = match LANES {
        1 => [64, 192, 40],
        4 => [192, 576, 80],
        _ => [640, 2240, 80],
    };
    let _: [(); (SIZES[0] + LANES * MEMORY).next_multiple_of(64)] = [(); BLOCK];
    let _: [(); SIZES[1]] = [(); OWN];
    let _: [(); SIZES[2]] = [(); GENERATOR];
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

fn memory_of(this: *const acrobot_batch_t, batch: &AnyBatch) -> Span {
    Span::new(this.cast::<u8>(), acrobot_batch_size(batch.len(), batch.has_own_params()))
}

/// ACROBOT_BATCH_SIZE(count), or with `own_params` ACROBOT_BATCH_OWN_SIZE(count), but at most
/// SIZE_MAX.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_batch_size(count: usize, own_params: bool) -> usize {
    let blocks = count.div_ceil(LANES);
    blocks
        .saturating_mul(if own_params { BLOCK + OWN } else { BLOCK })
        .saturating_add(count.saturating_mul(GENERATOR))
        .saturating_add(HEADER)
}

/// Puts a batch, which `make` returns, into the caller's memory.
pub unsafe fn place(
    memory: *mut c_void,
    size: usize,
    (count, own_params): (usize, bool),
    batch: *mut *mut acrobot_batch_t,
    make: impl FnOnce(Memory) -> Result<AnyBatch, Rejected>,
) -> Result<(), Rejected> {
    let to: *mut acrobot_batch_t = memory.cast();
    check(to)?;
    check(batch)?;
    if count == 0 {
        return Err(ACROBOT_ERROR_WRONG_COUNT.into());
    }
    let needed = acrobot_batch_size(count, own_params);
    if size < needed {
        return Err(ACROBOT_ERROR_BUFFER_TOO_SMALL.into());
    }
    check_apart(&[Span::new(to.cast::<u8>(), needed), Span::new(batch, 1)])?;
    let block_count = count.div_ceil(LANES);
    let own_count = if own_params { block_count } else { 0 };
    let blocks: *mut LanesBlock = to.add(1).cast();
    let own: *mut Own = blocks.add(block_count).cast();
    let generators: *mut Pcg64 = own.add(own_count).cast();
    for index in 0..block_count {
        blocks.add(index).write(Block::EMPTY);
    }
    for index in 0..own_count {
        own.add(index).write(LaneParams::default());
    }
    for index in 0..count {
        generators.add(index).write(Pcg64::UNSEEDED);
    }
    let blocks = slice::from_raw_parts_mut(blocks, block_count);
    let own = OwnParams::new(slice::from_raw_parts_mut(own, own_count));
    let generators = slice::from_raw_parts_mut(generators, count);
    let value =
        Placed { address: to.addr(), batch: make(BatchMemory { blocks, generators, own })? };
    Holder::init(to, value)?;
    batch.write(to);
    Ok(())
}

/// Makes a batch of an ACROBOT_TASK in `memory`, which has `size` bytes, with the task's
/// parameters, in initial states. Acrobot `i` is seeded with NumPy's
/// `SeedSequence(seed).spawn(count)[i]`. `batch` receives the batch's address. With `own_params`
/// acrobots can have different parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_init(
    memory: *mut c_void,
    size: usize,
    count: usize,
    task: c_int,
    own_params: bool,
    seed: u64,
    batch: *mut *mut acrobot_batch_t,
) -> acrobot_status_t {
    status(|| {
        let task = task_of(task)?;
        #[allow(clippy::useless_conversion, reason = "with instruments it is another type")]
        place(memory, size, (count, own_params), batch, |memory| {
            Ok(Batch::with_task(seed, task.into(), memory)?)
        })
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
    step(batch, actions, results, count)
}

/// As acrobot_batch_step, with any finite torques, N m.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_step_torque(
    batch: *mut acrobot_batch_t,
    torques: *const f32,
    results: *const acrobot_batch_results_t,
    count: usize,
) -> acrobot_status_t {
    step(batch, torques, results, count)
}

/// An array that the caller may omit: null and without elements then.
fn optional<T>(start: *mut T, count: usize) -> Result<*mut [T], Rejected> {
    if start.is_null() {
        return Ok(ptr::slice_from_raw_parts_mut(start, 0));
    }
    array(start, count)
}

unsafe fn step<I: Input<f32>>(
    batch: *mut acrobot_batch_t,
    inputs: *const I,
    results: *const acrobot_batch_results_t,
    count: usize,
) -> acrobot_status_t {
    status(|| {
        let placed = counted(batch, count)?;
        let pointers = Span::new(results, 1);
        let results = read(results)?;
        let inputs = array(inputs.cast_mut(), count)?;
        let rewards = array(results.rewards, count)?;
        let terminated = array(results.terminated, count)?;
        let truncated = array(results.truncated, count)?;
        let observations = optional(results.observations.cast(), count)?;
        let finals = optional(results.final_observations.cast(), count)?;
        check_apart(&[
            memory_of(batch, &placed.batch),
            pointers,
            Span::of(inputs),
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
        placed.batch.step_into(&*inputs, buffers)?;
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
        check_apart(&[memory_of(batch, &placed.batch), Span::of(observations)])?;
        Ok(placed.batch.observe(&mut *observations)?)
    })
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_settings(
    batch: *const acrobot_batch_t,
    settings: *mut acrobot_batch_settings_t,
) -> acrobot_status_t {
    get(batch, settings, |placed| {
        let batch = &placed.batch;
        Ok(acrobot_batch_settings_t {
            count: batch.len(),
            task: any_task(batch.task()) as c_int,
            own_params: batch.has_own_params(),
            autoreset: batch.autoreset() as c_int,
            max_steps: batch.max_steps().get(),
        })
    })
}

/// As acrobot_reset, for each acrobot.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_reset(batch: *mut acrobot_batch_t) -> acrobot_status_t {
    status(|| {
        Holder::value_mut(batch)?.batch.reset();
        Ok(())
    })
}

/// As acrobot_reset_with, for each acrobot, seeded as acrobot_batch_init does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_reset_with(
    batch: *mut acrobot_batch_t,
    options: *const acrobot_reset_options_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(batch, ptr::null_mut(), error, |placed| {
        let options = read_options(options, memory_of(batch, &placed.batch))?;
        placed.batch.reset_with(options);
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
        check_apart(&[memory_of(batch, &placed.batch), Span::of(seeds)])?;
        for (generator, seed) in placed.batch.generators_mut().iter_mut().zip(&*seeds) {
            *generator = Pcg64::new(*seed);
        }
        placed.batch.reset();
        Ok(())
    })
}

/// As acrobot_batch_reset_with, where `mask` is true. A byte that is neither true nor false is
/// rejected.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn acrobot_batch_reset_masked(
    batch: *mut acrobot_batch_t,
    mask: *const bool,
    count: usize,
    options: *const acrobot_reset_options_t,
    error: *mut acrobot_error_t,
) -> acrobot_status_t {
    change(batch, ptr::null_mut(), error, |placed| {
        counted(batch, count)?;
        let bytes = array(mask.cast::<u8>().cast_mut(), count)?;
        check_apart(&[memory_of(batch, &placed.batch), Span::of(bytes)])?;
        if let Some(byte) = (*bytes).iter().find(|byte| **byte > 1) {
            return Err(Rejected::number("mask", (*byte).into(), "", "true or false"));
        }
        let options = read_options(options, memory_of(batch, &placed.batch))?;
        Ok(placed.batch.reset_masked(slice::from_raw_parts(mask, count), options)?)
    })
}
