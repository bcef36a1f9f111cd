//! Many acrobots at once: the class `Batch` of the package.

use std::num::NonZeroU32;

use acrobot::batch::{Autoreset, Batch, Block, LaneParams, Member, StepBuffers};
use acrobot::numpy::Pcg64;
use acrobot::{Fast, ResetOptions};

use crate::memory::{self, set_bytes, set_numbers};

/// As many as one vector of simd128 has. More take more code and more time.
const LANES: usize = 4;

/// Vectors for parameters of each acrobot, too, or for none. Compiling both takes 13 KB.
type Memory = (Vec<Block<Fast, LANES>>, Vec<Pcg64>, Vec<LaneParams<Fast, LANES>>);

/// A batch with its memory, and what JavaScript reads and writes.
pub struct Many {
    batch: Batch<Fast, Memory, LANES>,
    own_params: bool,
    /// JavaScript writes here before a step.
    actions: Vec<u8>,
    /// JavaScript writes here before a reset.
    mask: Vec<bool>,
    observations: Vec<[f32; 6]>,
    rewards: Vec<f32>,
    terminated: Vec<bool>,
    truncated: Vec<bool>,
    final_observations: Vec<[f32; 6]>,
    /// Whose episodes have ended: in this step, or with `Disabled` since the last reset.
    ended: Vec<bool>,
}

/// `count` copies of a value, or `None` if there is no memory for them.
fn fill<T: Clone>(value: T, count: usize) -> Option<Vec<T>> {
    let mut vec = Vec::new();
    vec.try_reserve_exact(count).ok()?;
    // Always true. With this check the compiler omits the growth in `resize`, and its panic.
    if count <= vec.capacity() {
        vec.resize(count, value);
    }
    Some(vec)
}

impl Many {
    fn new(words: usize, count: usize, own_params: bool) -> Option<Self> {
        let len = count.div_ceil(LANES);
        let blocks = fill(Block::EMPTY, len)?;
        let generators = fill(Pcg64::UNSEEDED, count)?;
        let params = fill(LaneParams::default(), if own_params { len } else { 0 })?;
        Some(Self {
            batch: Batch::new(memory::seed(words), (blocks, generators, params)).ok()?,
            own_params,
            actions: fill(0, count)?,
            mask: fill(false, count)?,
            observations: fill([0.0; 6], count)?,
            rewards: fill(0.0, count)?,
            terminated: fill(false, count)?,
            truncated: fill(false, count)?,
            final_observations: fill([0.0; 6], count)?,
            ended: fill(false, count)?,
        })
    }
}

/// Makes a batch of `count` acrobots with a seed of this many 32-bit words. Writes the addresses of
/// what JavaScript reads and writes. Returns the batch's address, or 0 if there is no memory for
/// it.
#[unsafe(no_mangle)]
pub extern "C" fn batch_new(
    count: usize,
    words: usize,
    max_steps: u32,
    autoreset: u32,
    own_params: bool,
) -> Option<Box<Many>> {
    let mut many = memory::keep(Many::new(words, count, own_params)?)?;
    many.batch.set_limit(NonZeroU32::new(max_steps).unwrap_or(NonZeroU32::MIN));
    many.batch.set_autoreset(match autoreset {
        0 => Autoreset::NextStep,
        1 => Autoreset::SameStep,
        _ => Autoreset::Disabled,
    });
    let addresses = [
        many.observations.as_ptr().addr(),
        many.rewards.as_ptr().addr(),
        many.terminated.as_ptr().addr(),
        many.truncated.as_ptr().addr(),
        many.ended.as_ptr().addr(),
        many.final_observations.as_ptr().addr(),
        many.actions.as_ptr().addr(),
        many.mask.as_ptr().addr(),
    ];
    set_bytes(addresses.into_iter().flat_map(usize::to_le_bytes));
    Some(many)
}

#[unsafe(no_mangle)]
pub extern "C" fn batch_free(many: Box<Many>) {
    drop(many);
}

/// Resets the acrobots in the mask, with a seed of this many 32-bit words. 0: the next draws.
#[unsafe(no_mangle)]
pub extern "C" fn batch_reset(many: &mut Many, words: usize) {
    let seed = (words > 0).then(|| memory::seed(words));
    let options = ResetOptions { seed, bounds: None };
    // The lengths are equal, so this cannot fail.
    let _ = many.batch.reset_masked(&many.mask, options);
    for (ended, reset) in many.ended.iter_mut().zip(&many.mask) {
        *ended &= !reset;
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn batch_observe(many: &mut Many) {
    // The lengths are equal, so this cannot fail.
    let _ = many.batch.observe(&mut many.observations);
}

/// Steps. Returns false if an action is above 2. Then nothing changes.
#[unsafe(no_mangle)]
pub extern "C" fn batch_step(many: &mut Many) -> bool {
    let buffers = StepBuffers::new(&mut many.rewards, &mut many.terminated, &mut many.truncated)
        .with_observations(&mut many.observations)
        .with_final_observations(&mut many.final_observations);
    let stepped = many.batch.step(&many.actions, buffers).is_ok();
    if stepped {
        let lasting = many.batch.autoreset() == Autoreset::Disabled;
        let flags = many.terminated.iter().zip(&many.truncated);
        for (ended, (terminated, truncated)) in many.ended.iter_mut().zip(flags) {
            *ended = (*ended & lasting) | terminated | truncated;
        }
    }
    stepped
}

/// Writes the state of acrobot `index`.
#[unsafe(no_mangle)]
pub extern "C" fn batch_state(many: &Many, index: usize) {
    if let Some(state) = many.batch.state(index) {
        set_numbers(state.into());
    }
}

/// Sets the state of acrobot `index`. Returns 0, or the length of the reason for a rejection.
#[unsafe(no_mangle)]
pub extern "C" fn batch_set_state(many: &mut Many, index: usize) -> usize {
    memory::reason(many.batch.set_state(index, memory::get_state()))
}

#[unsafe(no_mangle)]
pub extern "C" fn batch_elapsed(many: &Many, index: usize) -> u32 {
    many.batch.elapsed(index).unwrap_or_default()
}

#[unsafe(no_mangle)]
pub extern "C" fn batch_params(many: &Many, index: usize) {
    if let Some(params) = many.batch.params_of(index) {
        memory::save(&params);
    }
}

/// Sets the parameters. Returns 0, or the length of the reason for a rejection.
#[unsafe(no_mangle)]
pub extern "C" fn batch_set_params(many: &mut Many) -> usize {
    memory::reason(many.batch.set_params(memory::get_params()))
}

/// As [`batch_set_params`], for acrobot `index` in a batch with own parameters.
#[unsafe(no_mangle)]
pub extern "C" fn batch_set_params_of(many: &mut Many, index: usize) -> usize {
    memory::reason(many.batch.set_params_of(index, memory::get_params()))
}

/// Writes acrobot `index` in the format of postcard, and returns its length.
#[unsafe(no_mangle)]
pub extern "C" fn batch_save(many: &Many, index: usize) -> usize {
    let member = many.batch.member(index);
    member.map_or(0, |member| memory::save(&member))
}

/// Loads acrobot `index` from the first of `len` bytes. Returns their number, or 0 if invalid.
#[unsafe(no_mangle)]
pub extern "C" fn batch_load(many: &mut Many, index: usize, len: usize) -> usize {
    let Some((member, used)) = memory::load::<Member<Fast>>(len) else {
        return 0;
    };
    // The first brings the parameters, if all acrobots share them.
    let shared = index > 0 || many.own_params || many.batch.set_params(member.params).is_ok();
    if shared && many.batch.set_member(index, member).is_ok() { used } else { 0 }
}
