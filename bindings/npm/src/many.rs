//! The classes `Batch` and `Acrobot` of the package. An `Acrobot` is a batch of one.

use std::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Damped};
use acrobot::batch::{Autoreset, Batch, BatchMemory, Block, LaneParams, OwnParams, StepBuffers};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::Pendulum;
use acrobot::task::{Balance, Draw, Gymnasium, Swingup};
use acrobot::{Action, Error, Fast, ResetOptions};

use crate::words;
use memory::{set_numbers, zeros};

/// As many as one vector of simd128 has. More take more code and more time.
const LANES: usize = 4;

/// Vectors for parameters of each acrobot, too, or for none. Compiling both takes 13 KB.
type Own<A> = OwnParams<Vec<LaneParams<A, LANES>>, <A as Arithmetic>::Scalar>;
type Memory<A> = BatchMemory<Vec<Block<A, LANES>>, Vec<Pcg64>, Own<A>>;

type Acrobots<A, T> = Batch<A, Memory<A>, T, LANES>;

/// The batch, whose type has the task.
enum Tasks {
    Acrobot(Acrobots<Fast, Gymnasium>),
    Swingup(Acrobots<Damped<Fast>, Swingup>),
    Balance(Acrobots<Damped<Fast>, Balance>),
}

impl Tasks {
    fn number(&self) -> u32 {
        match self {
            Self::Acrobot(_) => 0,
            Self::Swingup(_) => 1,
            Self::Balance(_) => 2,
        }
    }
}

macro_rules! with_task {
    ($tasks:expr, $batch:ident => $result:expr) => {
        match $tasks {
            Tasks::Acrobot($batch) => $result,
            Tasks::Swingup($batch) => $result,
            Tasks::Balance($batch) => $result,
        }
    };
}

mod saved; // after the macro, which it uses

/// A batch with its memory, and what JavaScript reads and writes.
pub struct Many {
    batch: Tasks,
    /// Whether it is an `Acrobot`, whose seed, random actions and snapshots are not a batch's.
    is_alone: bool,
    /// Draws random actions.
    action_space: Pcg64,
    /// JavaScript writes here before a step.
    actions: Vec<u8>,
    torques: Vec<f32>,
    /// The torques of the actions.
    torques_of: Vec<[f32; 3]>,
    /// JavaScript writes here before a reset.
    mask: Vec<bool>,
    observations: Vec<[f32; 6]>,
    rewards: Vec<f32>,
    terminated: Vec<bool>,
    truncated: Vec<bool>,
    final_observations: Vec<[f32; 6]>,
    /// Whose episodes have ended: in this step, or with `Disabled` since the last reset.
    done: Vec<bool>,
}

fn memory<A: Arithmetic>(count: usize, own_params: bool) -> Option<Memory<A>> {
    let len = count.div_ceil(LANES);
    let own = if own_params { len } else { 0 };
    // SAFETY: all are numbers and flags, which `Batch::new` writes.
    let (blocks, generators, own) = unsafe { (zeros(len)?, zeros(count)?, zeros(own)?) };
    Some(BatchMemory { blocks, generators, own: OwnParams::new(own) })
}

impl Many {
    fn new(count: usize, own_params: bool, task: u32, is_alone: bool) -> Option<Self> {
        let batch = match task {
            0 => Tasks::Acrobot(Batch::new(0, memory(count, own_params)?).ok()?),
            1 => Tasks::Swingup(Batch::new(0, memory(count, own_params)?).ok()?),
            _ => Tasks::Balance(Batch::new(0, memory(count, own_params)?).ok()?),
        };
        // SAFETY: all are numbers and flags.
        let mut many = unsafe {
            Self {
                batch,
                is_alone,
                action_space: Pcg64::UNSEEDED,
                actions: zeros(count)?,
                torques: zeros(count)?,
                torques_of: zeros(count)?,
                mask: zeros(count)?,
                observations: zeros(count)?,
                rewards: zeros(count)?,
                terminated: zeros(count)?,
                truncated: zeros(count)?,
                final_observations: zeros(count)?,
                done: zeros(count)?,
            }
        };
        many.mask.fill(true);
        Some(many)
    }

    fn set_limits(&mut self, max_steps: Option<NonZeroU32>, autoreset: Autoreset) {
        with_task!(&mut self.batch, batch => {
            batch.set_max_steps(max_steps.unwrap_or(batch.max_steps()));
            batch.set_autoreset(autoreset);
        });
    }
}

/// Makes a batch that JavaScript resets, or an acrobot alone. A limit of 0 steps stands for the
/// task's. Returns 0 without memory.
#[unsafe(no_mangle)]
pub extern "C" fn make(
    count: usize,
    max_steps: u32,
    autoreset: u32,
    own_params: bool,
    task: u32,
    is_alone: bool,
) -> Option<Box<Many>> {
    let mut many = memory::keep(Many::new(count, own_params, task, is_alone)?)?;
    let autoreset = match autoreset {
        0 => Autoreset::NextStep,
        1 => Autoreset::SameStep,
        _ => Autoreset::Disabled,
    };
    many.set_limits(NonZeroU32::new(max_steps), autoreset);
    Some(many)
}

#[unsafe(no_mangle)]
pub extern "C" fn kept_free(many: Box<Many>) {
    drop(many);
}

/// Writes the settings, and the addresses of what JavaScript reads and writes.
#[unsafe(no_mangle)]
pub extern "C" fn settings(many: &Many) {
    let (max_steps, autoreset, own_params) = with_task!(&many.batch, batch => {
        (batch.max_steps(), batch.autoreset(), batch.has_own_params())
    });
    let addresses = [
        many.observations.as_ptr().addr(),
        many.rewards.as_ptr().addr(),
        many.terminated.as_ptr().addr(),
        many.truncated.as_ptr().addr(),
        many.done.as_ptr().addr(),
        many.final_observations.as_ptr().addr(),
        many.actions.as_ptr().addr(),
        many.mask.as_ptr().addr(),
        many.torques.as_ptr().addr(),
    ];
    let [a, b, c, d, e, f, g, h, i] = addresses.map(|address| address as u32);
    let (count, task) = (many.actions.len() as u32, many.batch.number());
    let (limit, own) = (max_steps.get(), own_params.into());
    memory::set(&[count, limit, autoreset as u32, own, task, a, b, c, d, e, f, g, h, i]);
}

/// Resets the acrobots in the mask, or the one alone.
#[unsafe(no_mangle)]
pub extern "C" fn reset(many: &mut Many, words: usize) {
    let seed = (words > 0).then(|| memory::seed(words));
    let mut options = ResetOptions { seed, bounds: None };
    // In a batch an acrobot has a child of the seed.
    if many.is_alone
        && let Some(seed) = options.seed.take()
    {
        with_task!(&mut many.batch, batch => batch.generators_mut().fill(seed.into()));
    }
    // Here and below the lengths are equal, so that this cannot fail.
    let _ = with_task!(&mut many.batch, batch => batch.reset_masked(&many.mask, options));
    for (torque, reset) in many.torques.iter_mut().zip(&many.mask) {
        *torque = if *reset { 0.0 } else { *torque };
    }
    many.note_drawn_torques();
    observe(many);
}

#[unsafe(no_mangle)]
pub extern "C" fn observe(many: &mut Many) {
    let _ = with_task!(&many.batch, batch => batch.observe(&mut many.observations));
    write_results(many);
}

/// Writes the observation and the reward of an acrobot alone.
fn write_results(many: &Many) {
    if let ([[a, b, c, d, e, f]], [reward]) = (&*many.observations, &*many.rewards) {
        set_numbers([*a, *b, *c, *d, *e, *f, *reward]);
    }
}

/// Draws the actions of Gymnasium's `MultiDiscrete`, or of its `Discrete` for an acrobot alone,
/// whose action it returns.
#[unsafe(no_mangle)]
pub extern "C" fn sample(many: &mut Many, words: usize) -> u8 {
    let rng = &mut many.action_space;
    if words > 0 {
        *rng = memory::seed(words).into();
    }
    for action in &mut many.actions {
        *action = match many.is_alone {
            true => Action::sample(rng).into(),
            false => (3.0 * uniform(rng, 0.0, 1.0)) as u8,
        };
    }
    many.actions.first().copied().unwrap_or_default()
}

impl Many {
    /// Makes torques of the actions: steps of actions, too, would take 17 KB. Returns false if an
    /// action is above 2.
    fn act(&mut self) -> bool {
        let actions = self.actions.iter().zip(&self.torques_of);
        for (torque, (action, torques)) in self.torques.iter_mut().zip(actions) {
            let [negative, zero, positive] = *torques;
            // Without a branch, so that the compiler vectorizes the loop.
            *torque = match action {
                0 => negative,
                1 => zero,
                _ => positive,
            };
        }
        self.actions.iter().all(|action| *action <= 2)
    }

    /// After a change of parameters.
    fn note_torques(&mut self) {
        with_task!(&self.batch, batch => {
            for (index, torques) in self.torques_of.iter_mut().enumerate() {
                *torques = batch.params(index).map_or(*torques, |params| params.torques);
            }
        });
    }

    /// After resets, which may draw torques.
    fn note_drawn_torques(&mut self) {
        let drawn = with_task!(&self.batch, batch => batch.draws().params().torques);
        if !matches!(drawn, [Draw::Fixed, Draw::Fixed, Draw::Fixed]) {
            self.note_torques();
        }
    }

    /// Of acrobot `index`, or of all without one.
    fn set_params(&mut self, index: Option<usize>, mask: u32) -> Result<(), Error> {
        let indices = index.map_or(0..self.actions.len(), |index| index..index + 1);
        with_task!(&mut self.batch, batch => {
            // All are tried before one changes.
            for is_trial in [true, false] {
                for each in indices.clone() {
                    let Ok(before) = batch.params(each) else {
                        break;
                    };
                    let params = memory::changed(before, mask);
                    if index.is_none() && !batch.has_own_params() {
                        return batch.set_all_params(params);
                    }
                    batch.set_params(each, params)?;
                    if is_trial {
                        batch.set_params(each, before)?;
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

/// Steps with the torques, or with the actions. Returns false if an action is above 2 or a torque
/// not finite. Then nothing changes.
#[unsafe(no_mangle)]
pub extern "C" fn step(many: &mut Many, given_torques: bool) -> bool {
    if !given_torques && !many.act() {
        return false;
    }
    let buffers = StepBuffers::new(&mut many.rewards, &mut many.terminated, &mut many.truncated)
        .with_observations(&mut many.observations)
        .with_final_observations(&mut many.final_observations);
    with_task!(&mut many.batch, batch => {
        if batch.step_into(&many.torques, buffers).is_err() {
            return false;
        }
        let lasts = batch.autoreset() == Autoreset::Disabled;
        let flags = many.terminated.iter().zip(&many.truncated);
        for (i, (done, (terminated, truncated))) in many.done.iter_mut().zip(flags).enumerate() {
            *done = terminated | truncated;
            if lasts {
                *done |= batch.is_done(i).unwrap_or_default();
            }
        }
    });
    many.note_drawn_torques();
    true
}

/// Steps an acrobot alone. In the result, bit 0 says that the step reached the goal, and bit 1 that
/// the episode was truncated.
#[unsafe(no_mangle)]
pub extern "C" fn step_torque(many: &mut Many, torque: f32) -> u32 {
    many.torques.fill(torque);
    step(many, true);
    write_results(many);
    let flags = many.terminated.iter().zip(&many.truncated);
    flags.fold(0, |_, (terminated, truncated)| u32::from(*terminated) | u32::from(*truncated) << 1)
}

/// As `step_torque`.
#[unsafe(no_mangle)]
pub extern "C" fn step_action(many: &mut Many, action: usize) -> u32 {
    let torque = many.torques_of.first().and_then(|torques| torques.get(action));
    step_torque(many, torque.copied().unwrap_or_default())
}

/// Writes the state of an acrobot, its energy, its tip's height, the torque of its last step, and
/// its steps.
#[unsafe(no_mangle)]
pub extern "C" fn read_one(many: &Many, index: usize) {
    let read = with_task!(&many.batch, batch => {
        (batch.params(index), batch.state(index), batch.elapsed_steps(index))
    });
    if let ((Ok(params), Ok(state), Ok(elapsed_steps)), Some(torque)) =
        (read, many.torques.get(index))
        && let Ok(pendulum) = Pendulum::<Damped<Fast>>::new(params, state)
    {
        let [a, b, c, d] = state.into();
        let numbers = [a, b, c, d, pendulum.energy(), pendulum.tip_height(), *torque];
        let [a, b, c, d, e, f, g] = numbers.map(f32::to_bits);
        memory::set(&[a, b, c, d, e, f, g, elapsed_steps]);
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn set_state(many: &mut Many, index: usize) -> u32 {
    let state = words::get_state();
    memory::reason(with_task!(&mut many.batch, batch => batch.set_state(index, state)))
}

#[unsafe(no_mangle)]
pub extern "C" fn params(many: &Many, index: usize) {
    if let Ok(params) = with_task!(&many.batch, batch => batch.params(index)) {
        words::set_params(&params);
    }
}

/// Changes the parameters in the mask, of acrobot `index` or of all.
#[unsafe(no_mangle)]
pub extern "C" fn set_params(many: &mut Many, mask: u32, of_one: bool, index: usize) -> u32 {
    let changed = many.set_params(of_one.then_some(index), mask);
    many.note_torques();
    memory::reason(changed)
}

#[unsafe(no_mangle)]
pub extern "C" fn set_draws(many: &mut Many) -> u32 {
    memory::reason(many.set_draws())
}
