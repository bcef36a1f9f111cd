//! Single acrobots: the class `Acrobot` of the package.

use std::num::NonZeroU32;

use acrobot::{Acrobot, Action, Fast, ResetOptions, TimeLimit};

use crate::memory::{self, set_numbers};

type Env = TimeLimit<Acrobot<Fast>>;

/// Makes an acrobot that JavaScript resets. Returns its address, or 0 without memory.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_new(max_steps: u32) -> Option<Box<Env>> {
    let limit = NonZeroU32::new(max_steps).unwrap_or(NonZeroU32::MIN);
    memory::keep(TimeLimit::new(Acrobot::new(0), limit))
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_free(env: Box<Env>) {
    drop(env);
}

/// Resets, with a seed of this many 32-bit words. 0: the next draws.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_reset(env: &mut Env, words: usize) {
    let seed = (words > 0).then(|| memory::seed(words));
    let options = ResetOptions { seed, bounds: None };
    set_numbers(env.reset_with(options).to_array());
}

/// Steps with an action from 0 to 2. In the result, bit 0 says that the step reached the goal, and
/// bit 1 that the episode was truncated.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_step(env: &mut Env, action: u8) -> u32 {
    let step = env.step(Action::try_from(action).unwrap_or(Action::Zero));
    set_numbers(step.observation.to_array());
    u32::from(step.terminated) | u32::from(step.truncated) << 1
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_observe(env: &Env) {
    set_numbers(env.inner().observation().to_array());
}

/// Writes the state, the energy and the tip's height.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_read(env: &Env) {
    let pendulum = env.inner().pendulum();
    let [a, b, c, d] = pendulum.state().into();
    set_numbers([a, b, c, d, pendulum.energy(), pendulum.tip_height()]);
}

/// Sets the state. Returns 0, or the length of the reason for a rejection.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_set_state(env: &mut Env) -> usize {
    memory::reason(env.set_state(memory::get_state()))
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_params(env: &Env) {
    memory::save(env.params());
}

/// Sets the parameters. Returns 0, or the length of the reason for a rejection.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_set_params(env: &mut Env) -> usize {
    memory::reason(env.set_params(memory::get_params()))
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_max_steps(env: &Env) -> u32 {
    env.limit().get()
}

#[unsafe(no_mangle)]
pub extern "C" fn acrobot_elapsed(env: &Env) -> u32 {
    env.elapsed()
}

/// Writes a snapshot in the format of postcard, and returns its length.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_save(env: &Env) -> usize {
    memory::save(env)
}

/// Loads the snapshot in the first `len` bytes. Returns false and changes nothing if it is invalid.
#[unsafe(no_mangle)]
pub extern "C" fn acrobot_load(env: &mut Env, len: usize) -> bool {
    let loaded = memory::load(len).filter(|(_, used)| *used == len);
    loaded.map(|(loaded, _)| *env = loaded).is_some()
}
