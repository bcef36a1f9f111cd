//! One acrobot in arithmetic `Fast`, with Gymnasium's limit of 500 steps.

use acrobot::numpy::{Pcg64, SeedSequence};
use acrobot::physics::Dynamics;
use acrobot::{Acrobot, Action, Error, Fast, Params, ResetOptions, State, TimeLimit};

use crate::memory::{BUFFER, Shared};

pub struct Simulation {
    pub env: TimeLimit<Acrobot<Fast>>,
    /// Gymnasium's `action_space` with the same seed.
    action_space: Pcg64,
    /// The state before the last step, and its torque in N m.
    pub before: State<f32>,
    pub torque: f32,
}

/// The acrobot hangs at rest until the first [`reset`].
static SIMULATION: Shared<Simulation> = Shared::new(Simulation {
    env: TimeLimit::v1(Acrobot::hanging(Pcg64::new(0))),
    action_space: Pcg64::new(0),
    before: State::HANGING,
    torque: 0.0,
});

/// Calls `f` with the simulation.
pub fn with<R>(f: impl FnOnce(&mut Simulation) -> R) -> R {
    f(&mut SIMULATION.borrow())
}

/// Reads a seed from the first `words` 32-bit words of the buffer. The lowest word is first.
pub fn seed_in_buffer(words: usize) -> SeedSequence {
    let mut seed = [0; 64];
    let buffer = BUFFER.borrow();
    let (bytes, _) = buffer.as_chunks();
    let mut len = 0;
    for (word, &bytes) in seed.iter_mut().zip(bytes).take(words) {
        *word = u32::from_le_bytes(bytes);
        len += 1;
    }
    SeedSequence::from_words(seed.get(..len).unwrap_or(&seed))
}

/// Gymnasium's `reset(seed=seed)` and `action_space.seed(seed)`. The seed is in the buffer and has at most 64 words.
#[unsafe(no_mangle)]
pub extern "C" fn reset(words: usize) {
    let seed = seed_in_buffer(words);
    with(|simulation| {
        simulation.action_space = seed.clone().into();
        simulation.env.reset_with(ResetOptions {
            seed: Some(seed),
            ..ResetOptions::default()
        });
        simulation.before = simulation.env.state();
        simulation.torque = 0.0;
    });
}

/// Steps with the action of this number. In the result, bit 0 says that the step reached the goal, bit 1 that the episode was
/// truncated, and bit 2 that there is no such action, so nothing was stepped.
#[unsafe(no_mangle)]
pub extern "C" fn step(action: u32) -> u32 {
    let number = u8::try_from(action).unwrap_or(u8::MAX);
    let Ok(action) = Action::try_from(number) else {
        return 4;
    };
    with(|simulation| {
        simulation.before = simulation.env.state();
        simulation.torque = simulation.env.params().torque(action);
        let step = simulation.env.step(action);
        u32::from(step.terminated) | u32::from(step.truncated) << 1
    })
}

/// Draws a random action: Gymnasium's `action_space.sample()`.
#[unsafe(no_mangle)]
pub extern "C" fn random() -> u8 {
    with(|simulation| Action::sample(&mut simulation.action_space).into())
}

/// θ1 and θ2 in rad, θ̇1 and θ̇2 in rad/s, the energy in J and the tip's height in m.
#[unsafe(no_mangle)]
pub extern "C" fn numbers() -> *const [f32; 6] {
    static NUMBERS: Shared<[f32; 6]> = Shared::new([0.0; 6]);
    with(|simulation| {
        let pendulum = simulation.env.inner().pendulum();
        let [theta1, theta2, dtheta1, dtheta2] = pendulum.state().into();
        let (energy, height) = (pendulum.energy(), pendulum.tip_height());
        *NUMBERS.borrow() = [theta1, theta2, dtheta1, dtheta2, energy, height];
    });
    NUMBERS.address()
}

/// Sets parameters in SI units, and the equations: those of the book if `nips` is 0. All other parameters get Gymnasium's
/// values. Returns 0, or, if a parameter is rejected, the length of the reason in the buffer. Then nothing changes.
#[unsafe(no_mangle)]
pub extern "C" fn set_params(
    nips: u32,
    dt: f32,
    mass1: f32,
    mass2: f32,
    length1: f32,
    length2: f32,
    gravity: f32,
) -> usize {
    let params = Params {
        length1,
        length2,
        mass1,
        mass2,
        gravity,
        dt,
        dynamics: if nips != 0 {
            Dynamics::Nips
        } else {
            Dynamics::Book
        },
        ..Params::DEFAULT
    };
    let set = with(|simulation| simulation.env.set_params(params));
    set.map_or_else(reason, |()| 0)
}

/// Writes the parts of an error message into the buffer: the value in 8 bytes, then name, unit and rule on a line each.
/// JavaScript composes the message, because Rust's formatting of floats would add 16 KB to the module.
fn reason(error: Error) -> usize {
    let Error::OutOfRange {
        name,
        value,
        unit,
        rule,
    } = error
    else {
        return 0;
    };
    let mut buffer = BUFFER.borrow();
    let value = value.to_le_bytes();
    let parts = [
        value.as_slice(),
        name.as_bytes(),
        b"\n",
        unit.as_bytes(),
        b"\n",
        rule.as_bytes(),
    ];
    let mut len = 0;
    for (to, &byte) in buffer.iter_mut().zip(parts.into_iter().flatten()) {
        *to = byte;
        len += 1;
    }
    len
}
