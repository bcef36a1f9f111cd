//! Single acrobots: the class `Acrobot` of the package.

use acrobot::arithmetic::Damped;
use acrobot::numpy::{Pcg64, uniform};
use acrobot::physics::Pendulum;
use acrobot::task::{Gymnasium, Swingup, Task};
use acrobot::{Acrobot, Action, Fast, Step};

use crate::memory::{self, set_numbers};
use crate::{Tasks, with_task};

/// An acrobot under a limit of steps.
pub struct One {
    acrobot: Tasks<Acrobot<Fast>, Acrobot<Damped<Fast>, Swingup>>,
    max_steps: u32,
    elapsed: u32,
    /// Draws random actions.
    action_space: Pcg64,
}

/// Makes an acrobot that JavaScript resets. A limit of 0 steps stands for the task's. Returns 0
/// without memory.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_new(max_steps: u32, task: u32) -> Option<Box<One>> {
    let (acrobot, limit) = match task {
        0 => (Tasks::Acrobot(Acrobot::hanging(Pcg64::UNSEEDED)), Gymnasium::LIMIT),
        _ => (Tasks::Swingup(Acrobot::hanging(Pcg64::UNSEEDED)), Swingup::LIMIT),
    };
    let max_steps = if max_steps > 0 { max_steps } else { limit.get() };
    memory::keep(One { acrobot, max_steps, elapsed: 0, action_space: Pcg64::UNSEEDED })
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_free(one: Box<One>) {
    drop(one);
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_reset(one: &mut One, words: usize) {
    let seed = (words > 0).then(|| memory::seed(words).into());
    one.elapsed = 0;
    with_task!(&mut one.acrobot, acrobot => {
        if let Some(seed) = seed {
            *acrobot.rng_mut() = seed;
        }
        set_numbers(acrobot.reset());
    });
}

/// Writes the observation and the reward. In the result, bit 0 says that the step reached the goal,
/// and bit 1 that the episode was truncated.
fn results(one: &mut One, step: Step) -> u32 {
    let [a, b, c, d, e, f] = step.observation;
    set_numbers([a, b, c, d, e, f, step.reward]);
    one.elapsed = one.elapsed.saturating_add(1);
    u32::from(step.terminated) | u32::from(one.elapsed >= one.max_steps) << 1
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

/// Writes the state, the energy and the tip's height.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_read(one: &One) {
    with_task!(&one.acrobot, acrobot => {
        let pendulum = acrobot.pendulum();
        let [a, b, c, d] = pendulum.state().into();
        set_numbers([a, b, c, d, pendulum.energy(), pendulum.tip_height()]);
    });
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_set_state(one: &mut One) -> usize {
    memory::reason(with_task!(&mut one.acrobot, acrobot => acrobot.set_state(memory::get_state())))
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_params(one: &One) {
    memory::save(with_task!(&one.acrobot, acrobot => acrobot.params()));
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_set_params(one: &mut One) -> usize {
    memory::reason(
        with_task!(&mut one.acrobot, acrobot => acrobot.set_params(memory::get_params())),
    )
}

/// Draws a number between the bounds from the acrobot's generator.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_uniform(one: &mut One, _: usize, low: f64, high: f64) -> f64 {
    with_task!(&mut one.acrobot, acrobot => uniform(acrobot.rng_mut(), low, high))
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_max_steps(one: &One) -> u32 {
    one.max_steps
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_elapsed(one: &One) -> u32 {
    one.elapsed
}

/// Writes what follows the header in a snapshot of a `TimeLimit<Acrobot<_>>`, in the format of
/// postcard, and returns its length.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_save(one: &One) -> usize {
    let (params, state, rng) =
        with_task!(&one.acrobot, acrobot => (acrobot.params(), acrobot.state(), acrobot.rng()));
    memory::save(&(params, state, rng, one.max_steps, one.elapsed))
}

/// Loads what `acrobot_save` writes from the first `len` bytes. Returns false and changes nothing
/// if it is invalid.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_load(one: &mut One, len: usize) -> bool {
    let Some(((params, state, rng, max_steps, elapsed), used)) = memory::load(len) else {
        return false;
    };
    let valid = used == len
        && max_steps > 0
        && with_task!(&mut one.acrobot, acrobot => {
            let pendulum = Pendulum::new(params, state);
            pendulum.map(|pendulum| *acrobot = Acrobot::from_pendulum(pendulum, rng)).is_ok()
        });
    if valid {
        (one.max_steps, one.elapsed) = (max_steps, elapsed);
    }
    valid
}
