//! Many acrobots at once: the class `Batch` of the package.

use std::mem;
use std::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Damped};
use acrobot::batch::{Autoreset, Batch, Block, LaneParams, Member, StepBuffers};
use acrobot::numpy::{Pcg64, SeedSequence, uniform};
use acrobot::physics::State;
use acrobot::task::{Balance, Draw, Draws, Gymnasium, ResetBounds, Swingup};
use acrobot::{Error, Fast, Params, ResetOptions};
use serde::Serialize;

use crate::snapshot::{self, Reader, Rejected, read};
use crate::{Tasks, with_task, words};
use memory::{set_numbers, zeros};

/// As many as one vector of simd128 has. More take more code and more time.
const LANES: usize = 4;

/// Vectors for parameters of each acrobot, too, or for none. Compiling both takes 13 KB.
type Memory<A> =
    (Vec<Block<A, LANES>>, Vec<Pcg64>, Vec<LaneParams<A, LANES>>, Draws<<A as Arithmetic>::Scalar>);

type Acrobots<A, T> = Batch<A, Memory<A>, T, LANES>;

type AnyTask = Tasks<
    Acrobots<Fast, Gymnasium>,
    Acrobots<Damped<Fast>, Swingup>,
    Acrobots<Damped<Fast>, Balance>,
>;

/// A batch with its memory, and what JavaScript reads and writes.
pub struct Many {
    batch: AnyTask,
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

fn memory<A: Arithmetic>(count: usize, own_params: bool) -> Option<Memory<A>> {
    let len = count.div_ceil(LANES);
    let own = if own_params { len } else { 0 };
    // SAFETY: all are numbers and flags, which `Batch::new` writes.
    unsafe { Some((zeros(len)?, zeros(count)?, zeros(own)?, Draws::NONE)) }
}

impl Many {
    fn new(count: usize, own_params: bool, task: u32) -> Option<Self> {
        let seed = SeedSequence::new(0);
        let batch = match task {
            0 => Tasks::Acrobot(Batch::new(seed, memory(count, own_params)?).ok()?),
            1 => Tasks::Swingup(Batch::new(seed, memory(count, own_params)?).ok()?),
            _ => Tasks::Balance(Batch::new(seed, memory(count, own_params)?).ok()?),
        };
        // SAFETY: all are numbers and flags.
        unsafe {
            Some(Self {
                batch,
                action_space: Pcg64::UNSEEDED,
                actions: zeros(count)?,
                torques: zeros(count)?,
                torques_of: zeros(if own_params { count } else { 1 })?,
                mask: zeros(count)?,
                observations: zeros(count)?,
                rewards: zeros(count)?,
                terminated: zeros(count)?,
                truncated: zeros(count)?,
                final_observations: zeros(count)?,
                ended: zeros(count)?,
            })
        }
    }
}

/// Makes a batch that JavaScript resets. A limit of 0 steps stands for the task's. Returns 0
/// without memory.
#[unsafe(no_mangle)]
pub extern "C" fn batch_new(
    count: usize,
    max_steps: u32,
    autoreset: u32,
    own_params: bool,
    task: u32,
) -> Option<Box<Many>> {
    let mut many = memory::keep(Many::new(count, own_params, task)?)?;
    with_task!(&mut many.batch, batch => {
        batch.set_max_steps(NonZeroU32::new(max_steps).unwrap_or(batch.max_steps()));
        batch.set_autoreset(match autoreset {
            0 => Autoreset::NextStep,
            1 => Autoreset::SameStep,
            _ => Autoreset::Disabled,
        });
    });
    Some(many)
}

#[unsafe(no_mangle)]
pub extern "C" fn batch_free(many: Box<Many>) {
    drop(many);
}

/// Writes the settings.
#[unsafe(no_mangle)]
pub extern "C" fn batch_settings(many: &Many) {
    let (max_steps, autoreset, own_params) = with_task!(&many.batch, batch => {
        (batch.max_steps(), batch.autoreset(), batch.has_own_params())
    });
    let autoreset = match autoreset {
        Autoreset::SameStep => 1,
        Autoreset::Disabled => 2,
        _ => 0,
    };
    let count = many.actions.len() as u32;
    memory::set(&[count, max_steps.get(), autoreset, own_params.into(), many.batch.number()]);
}

/// Writes the addresses of what JavaScript reads and writes.
#[unsafe(no_mangle)]
pub extern "C" fn batch_arrays(many: &Many) {
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
    ];
    memory::set(&addresses.map(|address| address as u32));
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
    many.note_drawn_torques();
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
    /// Makes torques of the actions: steps of actions, too, would take 17 KB. Returns false if an
    /// action is above 2.
    fn act(&mut self) -> bool {
        if self.actions.iter().any(|action| *action > 2) {
            return false;
        }
        let torques = self.torques.iter_mut().zip(&self.actions);
        match *self.torques_of {
            [shared] => torques.for_each(|(torque, action)| *torque = torque_of(shared, *action)),
            ref each => torques.zip(each).for_each(|((torque, action), of)| {
                *torque = torque_of(*of, *action);
            }),
        }
        true
    }

    /// Notes the torques of the actions after a change of parameters.
    fn note_torques(&mut self) {
        with_task!(&self.batch, batch => {
            for (index, torques) in self.torques_of.iter_mut().enumerate() {
                *torques = batch.params_of(index).map_or(*torques, |params| params.torques);
            }
        });
    }

    /// Notes the torques of the actions after resets, which may draw them.
    fn note_drawn_torques(&mut self) {
        let drawn = with_task!(&self.batch, batch => batch.draws().params().torques);
        if !matches!(drawn, [Draw::Fixed, Draw::Fixed, Draw::Fixed]) {
            self.note_torques();
        }
    }

    /// Changes parameters of acrobot `index`, or of all without one.
    fn set_params(&mut self, index: Option<usize>, mask: u32) -> Result<(), Error> {
        let indices = index.map_or(0..self.actions.len(), |index| index..index + 1);
        with_task!(&mut self.batch, batch => {
            // All are tried before one changes.
            for is_trial in [true, false] {
                for each in indices.clone() {
                    let Some(before) = batch.params_of(each) else {
                        break;
                    };
                    let params = memory::changed(before, mask);
                    if index.is_none() && !batch.has_own_params() {
                        return batch.set_params(params);
                    }
                    batch.set_params_of(each, params)?;
                    if is_trial {
                        batch.set_params_of(each, before)?;
                    }
                }
            }
        });
        Ok(())
    }

    fn set_draws(&mut self) -> Result<(), Error> {
        let draws = words::get_draws()?;
        with_task!(&mut self.batch, batch => batch.set_draws(draws))
    }
}

/// Without a branch, so that the compiler vectorizes loops.
fn torque_of([negative, zero, positive]: [f32; 3], action: u8) -> f32 {
    match action {
        0 => negative,
        1 => zero,
        _ => positive,
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
        (batch.step_into(&many.torques, buffers).is_ok(), batch.autoreset())
    });
    if stepped {
        let lasting = autoreset == Autoreset::Disabled;
        let flags = many.terminated.iter().zip(&many.truncated);
        for (ended, (terminated, truncated)) in many.ended.iter_mut().zip(flags) {
            *ended = (*ended & lasting) | terminated | truncated;
        }
        many.note_drawn_torques();
    }
    stepped
}

#[unsafe(no_mangle)]
pub extern "C" fn batch_state(many: &Many, index: usize) {
    if let Some(state) = with_task!(&many.batch, batch => batch.state_of(index)) {
        set_numbers(state.into());
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn batch_set_state(many: &mut Many, index: usize) -> u32 {
    let state = words::get_state();
    memory::reason(with_task!(&mut many.batch, batch => batch.set_state_of(index, state)))
}

#[unsafe(no_mangle)]
pub extern "C" fn batch_elapsed_steps(many: &Many, index: usize) -> u32 {
    with_task!(&many.batch, batch => batch.elapsed_steps_of(index)).unwrap_or_default()
}

#[unsafe(no_mangle)]
pub extern "C" fn batch_params(many: &Many, index: usize) {
    if let Some(params) = with_task!(&many.batch, batch => batch.params_of(index)) {
        words::set_params(&params);
    }
}

/// Changes the parameters in the mask, of acrobot `index` or of all.
#[unsafe(no_mangle)]
pub extern "C" fn batch_set_params(many: &mut Many, mask: u32, of_one: bool, index: usize) -> u32 {
    let changed = many.set_params(of_one.then_some(index), mask);
    many.note_torques();
    memory::reason(changed)
}

#[unsafe(no_mangle)]
pub extern "C" fn batch_set_draws(many: &mut Many) -> u32 {
    memory::reason(many.set_draws())
}

/// The fields of a batch's snapshot after the number of acrobots and one, and the header: the
/// bounds of initial states, the limit of steps, when resets are, and whether parameters are own.
type Settings = (f64, f64, NonZeroU32, Autoreset, bool);

/// The fields of an acrobot.
type Fields = (State<f32>, u32, bool, Pcg64);

#[unsafe(no_mangle)]
pub extern "C" fn batch_save(many: &Many) -> usize {
    let count = many.actions.len();
    let (settings, draws): (Settings, _) = with_task!(&many.batch, batch => {
        let (bounds, draws) = (batch.reset_bounds(), *batch.draws().params());
        let (low, high, limit) = (bounds.low(), bounds.high(), batch.max_steps());
        ((low, high, limit, batch.autoreset(), batch.has_own_params()), draws)
    });
    // The settings have less than 512 bytes, each acrobot at most 151.
    snapshot::save(512 + count * 151, |writer| {
        (count as u32 + 1).serialize(&mut *writer)?;
        snapshot::write_header("batch", many.batch.number(), writer)?;
        settings.serialize(&mut *writer)?;
        snapshot::write_params(draws, writer)?;
        for index in 0..count {
            let fields: Option<(_, Fields)> = with_task!(&many.batch, batch => {
                batch.member(index).map(|Member { params, state, elapsed_steps, ended, rng }| {
                    (params, (state, elapsed_steps, ended, rng))
                })
            });
            if let Some((params, fields)) = fields {
                snapshot::write_params(params, writer)?;
                fields.serialize(&mut *writer)?;
            }
        }
        Ok(())
    })
}

fn load(mut reader: Reader<'_>, len: usize) -> Result<Many, Rejected> {
    let count: u32 = read(&mut reader).ok_or(Rejected::Header)?;
    let task = snapshot::read_header(&mut reader, "batch")?;
    let count = count.saturating_sub(1) as usize;
    // Parameters and state have 89 bytes. Other numbers could take all memory.
    if count > len / 89 {
        return Err(Rejected::Contents);
    }
    load_fields(reader, count, task).ok_or(Rejected::Contents)
}

fn load_fields(mut reader: Reader<'_>, count: usize, task: u32) -> Option<Many> {
    let (low, high, max_steps, autoreset, own_params) = read::<Settings>(&mut reader)?;
    let mut draws: Params<Draw<f32>> = Draws::FIXED;
    snapshot::read_params(&mut reader, &mut draws)?;
    let mut many = Many::new(count, own_params, task)?;
    for index in 0..count {
        let mut params = Params::DEFAULT;
        snapshot::read_params(&mut reader, &mut params)?;
        let (state, elapsed_steps, ended, rng) = read::<Fields>(&mut reader)?;
        with_task!(&mut many.batch, batch => {
            // The first brings the parameters, if all acrobots share them.
            if index == 0 {
                batch.set_params(params).ok()?;
            }
            let member = Member { params, state, elapsed_steps, ended, rng };
            batch.set_member(index, member).ok()?;
        });
        *many.ended.get_mut(index)? = ended;
    }
    with_task!(&mut many.batch, batch => {
        batch.set_draws(Draws::new(draws).ok()?).ok()?;
        batch.set_reset_bounds(ResetBounds::new(low, high).ok()?);
        batch.set_max_steps(max_steps);
        batch.set_autoreset(autoreset);
    });
    many.note_torques();
    reader.finalize().ok()?.is_empty().then_some(many)
}

/// Loads a snapshot. If it is invalid, or without memory, nothing changes.
#[unsafe(no_mangle)]
pub extern "C" fn batch_load(many: &mut Many, address: *const u8, len: usize) -> u32 {
    let loaded = snapshot::open(address, len).and_then(|reader| load(reader, len));
    snapshot::code(loaded.map(|mut loaded| {
        mem::swap(&mut loaded.action_space, &mut many.action_space);
        *many = loaded;
    }))
}
