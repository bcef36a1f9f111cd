//! One acrobot in `Fast` with Gymnasium's limit of 500 steps.

use acrobot::{
    Acrobot, Action, Dynamics, Error, Fast, Params, Pcg64, SeedSequence, State, TimeLimit,
};

use crate::memory::{BUFFER, Shared};

pub struct Simulation {
    pub env: TimeLimit<Acrobot<Fast>>,
    /// Gymnasium's `action_space` of the same seed.
    action_space: Pcg64,
    /// The state before the last step, and its torque in N m.
    pub before: State<f32>,
    pub torque: f32,
}

impl Simulation {
    fn new(seed: SeedSequence, params: Params<f32>) -> Self {
        let mut acrobot = Acrobot::<Fast>::new(seed.clone());
        // They are those of an acrobot, or the default: valid.
        let _ = acrobot.set_params(params);
        Self {
            before: acrobot.state(),
            env: TimeLimit::v1(acrobot),
            action_space: Pcg64::new(seed),
            torque: 0.0,
        }
    }

    fn params(&self) -> Params<f32> {
        *self.env.inner().params()
    }
}

static SIMULATION: Shared<Option<Simulation>> = Shared::new(None);

/// Calls `f` with the simulation: of seed 0 before the first [`reset`].
pub fn with<R>(f: impl FnOnce(&mut Simulation) -> R) -> R {
    f(SIMULATION
        .borrow()
        .get_or_insert_with(|| Simulation::new(0.into(), Params::default())))
}

/// The seed in the buffer: so many words of 32 bits, the lowest first.
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

/// Gymnasium's `reset(seed=seed)` and `action_space.seed(seed)`, for the seed in the buffer of up to 64 words.
#[unsafe(no_mangle)]
pub extern "C" fn reset(words: usize) {
    let seed = seed_in_buffer(words);
    with(|simulation| *simulation = Simulation::new(seed, simulation.params()));
}

/// Steps by an action's number. Bit 0 says whether the goal was reached, bit 1 whether it was the last step of the
/// limit; bit 2 refuses the action.
#[unsafe(no_mangle)]
pub extern "C" fn step(action: u32) -> u32 {
    let number = u8::try_from(action).unwrap_or(u8::MAX);
    let Ok(action) = Action::try_from(number) else {
        return 4;
    };
    with(|simulation| {
        simulation.before = simulation.env.inner().state();
        simulation.torque = simulation.params().torque(action);
        let step = simulation.env.step(action);
        u32::from(step.terminated) | u32::from(step.truncated) << 1
    })
}

/// A random action: Gymnasium's `action_space.sample()`.
#[unsafe(no_mangle)]
pub extern "C" fn random() -> u8 {
    with(|simulation| Action::sample(&mut simulation.action_space).into())
}

/// θ1 and θ2 in rad, θ̇1 and θ̇2 in rad/s, the energy in J and the tip's height in m.
#[unsafe(no_mangle)]
pub extern "C" fn numbers() -> *const [f32; 6] {
    static NUMBERS: Shared<[f32; 6]> = Shared::new([0.0; 6]);
    with(|simulation| {
        let acrobot = simulation.env.inner();
        let [theta1, theta2, dtheta1, dtheta2] = acrobot.state().into();
        let (energy, height) = (acrobot.energy(), acrobot.tip_height());
        *NUMBERS.borrow() = [theta1, theta2, dtheta1, dtheta2, energy, height];
    });
    NUMBERS.address()
}

/// Sets the equations, those of the book where `nips` is 0, and parameters in SI units; all others are Gymnasium's. Not 0 where they are refused: the length of the reason,
/// which is in the buffer. Nothing is changed then.
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
        ..Params::default()
    };
    let set = with(|simulation| simulation.env.inner_mut().set_params(params));
    set.map_or_else(reason, |()| 0)
}

/// Writes the parts of a message into the buffer, for JavaScript to put together: the value in 8 bytes, then its name,
/// its unit and what is allowed, a line each. Rust's own way of writing a float would take 16 KB.
fn reason(error: Error) -> usize {
    let Error::OutOfRange {
        name,
        value,
        unit,
        allowed,
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
        allowed.as_bytes(),
    ];
    let mut len = 0;
    for (to, &byte) in buffer.iter_mut().zip(parts.into_iter().flatten()) {
        *to = byte;
        len += 1;
    }
    len
}
