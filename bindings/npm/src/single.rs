//! Single acrobots: the class `Acrobot` of the package.

use std::num::NonZeroU32;

use acrobot::arithmetic::{Arithmetic, Damped};
use acrobot::numpy::Pcg64;
use acrobot::physics::{Pendulum, State};
use acrobot::task::{Balance, Draws, Gymnasium, Swingup, Task};
use acrobot::{Acrobot, Action, Error, Fast, Params, Step};
use serde::Serialize;

use crate::snapshot::{self, Reader, Rejected, read};
use crate::{Tasks, with_task, words};
use memory::set_numbers;

type AnyTask = Tasks<Acrobot<Fast>, Acrobot<Damped<Fast>, Swingup>, Acrobot<Damped<Fast>, Balance>>;

/// An acrobot under a limit of steps.
pub struct One {
    acrobot: AnyTask,
    max_steps: NonZeroU32,
    elapsed_steps: u32,
    /// What each reset draws of the parameters.
    draws: Draws<f32>,
    /// Draws random actions.
    action_space: Pcg64,
}

/// Makes an acrobot that JavaScript resets. A limit of 0 steps stands for the task's. Returns 0
/// without memory.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_new(max_steps: u32, task: u32) -> Option<Box<One>> {
    let (acrobot, limit) = match task {
        0 => (Tasks::Acrobot(Acrobot::hanging(Pcg64::UNSEEDED)), Gymnasium::MAX_STEPS),
        1 => (Tasks::Swingup(Acrobot::hanging(Pcg64::UNSEEDED)), Swingup::MAX_STEPS),
        _ => (Tasks::Balance(Acrobot::hanging(Pcg64::UNSEEDED)), Balance::MAX_STEPS),
    };
    memory::keep(One {
        acrobot,
        max_steps: NonZeroU32::new(max_steps).unwrap_or(limit),
        elapsed_steps: 0,
        draws: Draws::NONE,
        action_space: Pcg64::UNSEEDED,
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_free(one: Box<One>) {
    drop(one);
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_reset(one: &mut One, words: usize) {
    let seed = (words > 0).then(|| memory::seed(words).into());
    one.elapsed_steps = 0;
    with_task!(&mut one.acrobot, acrobot => {
        if let Some(seed) = seed {
            *acrobot.rng_mut() = seed;
        }
        set_numbers(acrobot.reset());
        // Draws and parameters have been checked together.
        let _ = acrobot.draw_params(&one.draws);
    });
}

/// Writes the observation and the reward. In the result, bit 0 says that the step reached the goal,
/// and bit 1 that the episode was truncated.
fn results(one: &mut One, step: Step) -> u32 {
    let [a, b, c, d, e, f] = step.observation;
    set_numbers([a, b, c, d, e, f, step.reward]);
    one.elapsed_steps = one.elapsed_steps.saturating_add(1);
    u32::from(step.terminated) | u32::from(one.elapsed_steps >= one.max_steps.get()) << 1
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_step(one: &mut One, action: u8) -> u32 {
    let action = Action::try_from(action).unwrap_or(Action::Zero);
    let step = with_task!(&mut one.acrobot, acrobot => acrobot.step(action));
    results(one, step)
}

/// The torque is finite.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_step_torque(one: &mut One, torque: f32) -> u32 {
    let step = with_task!(&mut one.acrobot, acrobot => acrobot.step_torque(torque));
    step.map_or(0, |step| results(one, step))
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_sample(one: &mut One, words: usize) -> u8 {
    if words > 0 {
        one.action_space = memory::seed(words).into();
    }
    Action::sample(&mut one.action_space).into()
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_observe(one: &One) {
    set_numbers(with_task!(&one.acrobot, acrobot => acrobot.observation()));
}

/// Writes the state, the energy, the tip's height, the steps, their limit and the task.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_read(one: &One) {
    let numbers = with_task!(&one.acrobot, acrobot => {
        let pendulum = acrobot.pendulum();
        let [a, b, c, d] = pendulum.state().into();
        [a, b, c, d, pendulum.energy(), pendulum.tip_height()]
    });
    let [a, b, c, d, e, f] = numbers.map(f32::to_bits);
    memory::set(&[a, b, c, d, e, f, one.elapsed_steps, one.max_steps.get(), one.acrobot.number()]);
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_set_state(one: &mut One) -> u32 {
    memory::reason(with_task!(&mut one.acrobot, acrobot => acrobot.set_state(words::get_state())))
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_params(one: &One) {
    words::set_params(with_task!(&one.acrobot, acrobot => acrobot.params()));
}

/// Checks parameters, and what draws can make of them.
fn check<A: Arithmetic, T: Task>(
    acrobot: &Acrobot<A, T>,
    params: Params<A::Scalar>,
    draws: &Draws<A::Scalar>,
) -> Result<(), Error> {
    let mut trial = acrobot.clone();
    trial.set_params(params)?;
    trial.draw_params(draws)
}

impl One {
    fn set_params(&mut self, mask: u32) -> Result<(), Error> {
        with_task!(&mut self.acrobot, acrobot => {
            let params = memory::changed(*acrobot.params(), mask);
            check(acrobot, params, &self.draws)?;
            acrobot.set_params(params)
        })
    }

    fn set_draws(&mut self) -> Result<(), Error> {
        let draws = words::get_draws()?;
        with_task!(&self.acrobot, acrobot => check(acrobot, *acrobot.params(), &draws))?;
        self.draws = draws;
        Ok(())
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_set_params(one: &mut One, mask: u32) -> u32 {
    memory::reason(one.set_params(mask))
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_set_draws(one: &mut One) -> u32 {
    memory::reason(one.set_draws())
}

/// The fields of an acrobot's snapshot after its header.
type Fields<R> = (State<f32>, R, NonZeroU32, u32);

/// Saves a snapshot of less than 256 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_save(one: &One) -> usize {
    let (params, state, rng) =
        with_task!(&one.acrobot, acrobot => (*acrobot.params(), acrobot.state(), acrobot.rng()));
    let fields: Fields<_> = (state, rng, one.max_steps, one.elapsed_steps);
    snapshot::save(256, |writer| {
        snapshot::write_header("acrobot", one.acrobot.number(), writer)?;
        snapshot::write_params(params, writer)?;
        fields.serialize(writer)
    })
}

fn load<A: Arithmetic<Scalar = f32>, T: Task>(
    params: Params<f32>,
    state: State<f32>,
    rng: Pcg64,
) -> Option<Acrobot<A, T>> {
    Some(Acrobot::from_pendulum(Pendulum::new(params, state).ok()?, rng))
}

impl One {
    fn load(&mut self, mut reader: Reader<'_>, any_task: bool) -> Result<(), Rejected> {
        let task = snapshot::read_header(&mut reader, "acrobot")?;
        if !any_task && task != self.acrobot.number() {
            return Err(Rejected::Header);
        }
        self.load_fields(reader, task).ok_or(Rejected::Contents)
    }

    fn load_fields(&mut self, mut reader: Reader<'_>, task: u32) -> Option<()> {
        let mut params = Params::DEFAULT;
        snapshot::read_params(&mut reader, &mut params)?;
        let (state, rng, max_steps, elapsed_steps) = read::<Fields<Pcg64>>(&mut reader)?;
        if !reader.finalize().ok()?.is_empty() {
            return None;
        }
        self.acrobot = match task {
            0 => Tasks::Acrobot(load(params, state, rng)?),
            1 => Tasks::Swingup(load(params, state, rng)?),
            _ => Tasks::Balance(load(params, state, rng)?),
        };
        (self.max_steps, self.elapsed_steps) = (max_steps, elapsed_steps);
        self.draws = Draws::NONE;
        Some(())
    }
}

/// Loads a snapshot, of any task or of the same. If it is invalid, nothing changes.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_load(
    one: &mut One,
    address: *const u8,
    len: usize,
    any_task: bool,
) -> u32 {
    let reader = snapshot::open(address, len);
    snapshot::code(reader.and_then(|reader| one.load(reader, any_task)))
}
