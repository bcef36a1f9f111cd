//! Many acrobots at once: the class `Batch` of the package.

use std::alloc::{Layout, alloc_zeroed};
use std::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Damped};
use acrobot::batch::{Autoreset, Batch, Block, LaneParams, Member, StepBuffers};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::task::{Gymnasium, Swingup, Task};
use acrobot::{Error, Fast, Params, ResetOptions};

use crate::memory::{self, set_bytes, set_numbers};
use crate::{Tasks, with_task};

/// As many as one vector of simd128 has. More take more code and more time.
const LANES: usize = 4;

/// Vectors for parameters of each acrobot, too, or for none. Compiling both takes 13 KB.
type Memory<A> = (Vec<Block<A, LANES>>, Vec<Pcg64>, Vec<LaneParams<A, LANES>>);

type Acrobots<A, T> = Batch<A, Memory<A>, T, LANES>;

/// A batch with its memory, and what JavaScript reads and writes.
pub struct Many {
    batch: Tasks<Acrobots<Fast, Gymnasium>, Acrobots<Damped<Fast>, Swingup>>,
    own_params: bool,
    /// Draws random actions.
    action_space: Pcg64,
    /// JavaScript writes here before a step.
    actions: Vec<u8>,
    torques: Vec<f32>,
    /// The torques of the actions of each acrobot, or of all.
    torques_of: Vec<[f32; 3]>,
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

/// `count` zeros, or `None` if there is no memory for them.
///
/// # Safety
///
/// A `T` may consist of zero bytes.
unsafe fn zeros<T>(count: usize) -> Option<Vec<T>> {
    if count == 0 {
        return Some(Vec::new());
    }
    let layout = Layout::array::<T>(count).ok()?;
    // SAFETY: the size of what is kept here is not 0, and a vector frees memory of this layout.
    unsafe {
        let memory: *mut T = alloc_zeroed(layout).cast();
        (!memory.is_null()).then(|| Vec::from_raw_parts(memory, count, count))
    }
}

fn make<A: Arithmetic, T: Task>(
    words: usize,
    count: usize,
    own_params: bool,
) -> Option<Acrobots<A, T>> {
    let len = count.div_ceil(LANES);
    // SAFETY: all are numbers and flags, which `Batch::new` writes.
    let memory = unsafe { (zeros(len)?, zeros(count)?, zeros(if own_params { len } else { 0 })?) };
    Batch::new(memory::seed(words), memory).ok()
}

impl Many {
    fn new(words: usize, count: usize, own_params: bool, task: u32) -> Option<Self> {
        Some(Self {
            batch: match task {
                0 => Tasks::Acrobot(make(words, count, own_params)?),
                _ => Tasks::Swingup(make(words, count, own_params)?),
            },
            own_params,
            action_space: Pcg64::UNSEEDED,
            // SAFETY: all are numbers and flags.
            actions: unsafe { zeros(count)? },
            torques: unsafe { zeros(count)? },
            torques_of: unsafe { zeros(if own_params { count } else { 1 })? },
            mask: unsafe { zeros(count)? },
            observations: unsafe { zeros(count)? },
            rewards: unsafe { zeros(count)? },
            terminated: unsafe { zeros(count)? },
            truncated: unsafe { zeros(count)? },
            final_observations: unsafe { zeros(count)? },
            ended: unsafe { zeros(count)? },
        })
    }
}

/// Writes the addresses of what JavaScript reads and writes, then the limit of steps, for which a 0
/// stands for the task's. Returns 0 without memory.
#[unsafe(no_mangle)]
pub extern "C" fn batch_new(
    count: usize,
    words: usize,
    max_steps: u32,
    autoreset: u32,
    own_params: bool,
    task: u32,
) -> Option<Box<Many>> {
    let mut many = memory::keep(Many::new(words, count, own_params, task)?)?;
    let autoreset = match autoreset {
        0 => Autoreset::NextStep,
        1 => Autoreset::SameStep,
        _ => Autoreset::Disabled,
    };
    let limit = with_task!(&mut many.batch, batch => {
        batch.set_limit(NonZeroU32::new(max_steps).unwrap_or(batch.limit()));
        batch.set_autoreset(autoreset);
        batch.limit()
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
        many.torques.as_ptr().addr(),
        limit.get() as usize,
    ];
    set_bytes(addresses.into_iter().flat_map(usize::to_le_bytes));
    Some(many)
}

#[unsafe(no_mangle)]
pub extern "C" fn batch_free(many: Box<Many>) {
    drop(many);
}

/// Resets the acrobots in the mask.
#[unsafe(no_mangle)]
pub extern "C" fn batch_reset(many: &mut Many, words: usize) {
    let seed = (words > 0).then(|| memory::seed(words));
    let options = ResetOptions { seed, bounds: None };
    // Here and below the lengths are equal, so that this cannot fail.
    let _ = with_task!(&mut many.batch, batch => batch.reset_masked(&many.mask, options));
    for (ended, reset) in many.ended.iter_mut().zip(&many.mask) {
        *ended &= !reset;
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn batch_observe(many: &mut Many) {
    let _ = with_task!(&many.batch, batch => batch.observe(&mut many.observations));
}

/// Draws the actions of Gymnasium's `MultiDiscrete`.
#[unsafe(no_mangle)]
pub extern "C" fn batch_sample(many: &mut Many, words: usize) {
    if words > 0 {
        many.action_space = memory::seed(words).into();
    }
    for action in &mut many.actions {
        *action = (3.0 * uniform(&mut many.action_space, 0.0, 1.0)) as u8;
    }
}

impl Many {
    /// Makes torques of the actions: steps of actions, too, would take 9 KB. Returns false if an
    /// action is above 2.
    fn act(&mut self) -> bool {
        if self.actions.iter().any(|action| *action > 2) {
            return false;
        }
        let torques = self.torques.iter_mut().zip(&self.actions);
        match *self.torques_of {
            // No branch, so that the compiler vectorizes the loop.
            [[negative, zero, positive]] => torques.for_each(|(torque, action)| {
                *torque = match action {
                    0 => negative,
                    1 => zero,
                    _ => positive,
                };
            }),
            ref each => torques.zip(each).for_each(|((torque, action), of)| {
                *torque = of.get(usize::from(*action)).copied().unwrap_or_default();
            }),
        }
        true
    }

    fn set_params(&mut self, index: usize, params: Params<f32>) -> Result<(), Error> {
        let own_params = self.own_params;
        with_task!(&mut self.batch, batch => match own_params {
            true => batch.set_params_of(index, params),
            false => batch.set_params(params),
        })?;
        if let Some(of) = self.torques_of.get_mut(index) {
            *of = params.torques;
        }
        Ok(())
    }
}

/// Steps with the torques, or with the actions. Returns false if an action is above 2 or a torque
/// not finite. Then nothing changes.
#[unsafe(no_mangle)]
pub extern "C" fn batch_step(many: &mut Many, given_torques: bool) -> bool {
    if !given_torques && !many.act() {
        return false;
    }
    let buffers = StepBuffers::new(&mut many.rewards, &mut many.terminated, &mut many.truncated)
        .with_observations(&mut many.observations)
        .with_final_observations(&mut many.final_observations);
    let (stepped, autoreset) = with_task!(&mut many.batch, batch => {
        (batch.step(&many.torques, buffers).is_ok(), batch.autoreset())
    });
    if stepped {
        let lasting = autoreset == Autoreset::Disabled;
        let flags = many.terminated.iter().zip(&many.truncated);
        for (ended, (terminated, truncated)) in many.ended.iter_mut().zip(flags) {
            *ended = (*ended & lasting) | terminated | truncated;
        }
    }
    stepped
}

#[unsafe(no_mangle)]
pub extern "C" fn batch_state(many: &Many, index: usize) {
    if let Some(state) = with_task!(&many.batch, batch => batch.state(index)) {
        set_numbers(state.into());
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn batch_set_state(many: &mut Many, index: usize) -> usize {
    let state = memory::get_state();
    memory::reason(with_task!(&mut many.batch, batch => batch.set_state(index, state)))
}

#[unsafe(no_mangle)]
pub extern "C" fn batch_elapsed(many: &Many, index: usize) -> u32 {
    with_task!(&many.batch, batch => batch.elapsed(index)).unwrap_or_default()
}

#[unsafe(no_mangle)]
pub extern "C" fn batch_params(many: &Many, index: usize) {
    if let Some(params) = with_task!(&many.batch, batch => batch.params_of(index)) {
        memory::save(&params);
    }
}

/// Sets the parameters of acrobot `index`, or, with 0, those that all acrobots share.
#[unsafe(no_mangle)]
pub extern "C" fn batch_set_params(many: &mut Many, index: usize) -> usize {
    memory::reason(many.set_params(index, memory::get_params()))
}

/// Draws a number between the bounds from the generator of acrobot `index`.
#[unsafe(no_mangle)]
pub extern "C" fn batch_uniform(many: &mut Many, index: usize, low: f64, high: f64) -> f64 {
    let rng = with_task!(&mut many.batch, batch => batch.generators_mut().get_mut(index));
    rng.map_or(low, |rng| uniform(rng, low, high))
}

/// Writes acrobot `index` in the format of postcard, and returns its length.
#[unsafe(no_mangle)]
pub extern "C" fn batch_save(many: &Many, index: usize) -> usize {
    with_task!(&many.batch, batch => {
        batch.member(index).map_or(0, |Member { params, state, elapsed, reset_pending, rng }| {
            memory::save(&(params, state, elapsed, reset_pending, rng))
        })
    })
}

/// Loads acrobot `index` from the first of `len` bytes. Returns their number, or 0 if invalid.
#[unsafe(no_mangle)]
pub extern "C" fn batch_load(many: &mut Many, index: usize, len: usize) -> usize {
    let Some(((params, state, elapsed, reset_pending, rng), used)) = memory::load(len) else {
        return 0;
    };
    // The first brings the parameters, if all acrobots share them.
    let set = index > 0 && !many.own_params || many.set_params(index, params).is_ok();
    let loaded = with_task!(&mut many.batch, batch => {
        let member = Member { params, state, elapsed, reset_pending, rng };
        batch.set_member(index, member).is_ok()
    });
    if set && loaded { used } else { 0 }
}
