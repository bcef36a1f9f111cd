//! A plan for Gymnasium's acrobot with a strong motor, and a digest of it and of following it.

use acrobot::control::plan::{Knot, Plan, Planner, Problem};
use acrobot::numpy::Pcg64;
use acrobot::physics::saturate;
use acrobot::{Acrobot, Error, Fast, Params, State};

use crate::Digest;

/// The largest torque of the compared plan, N m. With less, QEMU would plan for a minute.
pub const LIMIT: f32 = 7.0;
/// Its decisions per second.
pub const RATE: u32 = 100;
/// 48,400 bytes.
pub type Memory = [Knot<f32>; 1100];

pub const fn empty() -> Memory {
    [Knot::EMPTY; 1100]
}

/// Gymnasium's parameters, with so many decisions per second.
pub fn params(rate: u32) -> Params<f32> {
    Params { dt: 1.0 / rate as f32, ..Params::DEFAULT }
}

/// Plans from hanging at rest, with a largest torque, N m, and decisions per second.
pub fn plan(
    limit: f32,
    rate: u32,
    memory: &mut Memory,
) -> Result<Plan<f32, &mut [Knot<f32>]>, Error> {
    let mut planner = Planner::<Fast>::new(&Problem::swing_up(params(rate), limit)?)?;
    planner.plan_into(State::HANGING, 64, &mut Pcg64::new(0), memory)
}

/// A digest of every bit of the plan, and of the states of an acrobot that follows it.
pub fn digest(plan: &[Knot<f32>]) -> u64 {
    let mut digest = Digest::default();
    let mut acrobot = Acrobot::<Fast>::new(0);
    let set = acrobot.set_params(params(RATE));
    digest.add(u64::from(set.is_ok()));
    for step in plan {
        let stepped = acrobot.step_torque(saturate(step.follow(acrobot.state()), 10.0));
        digest.add(u64::from(stepped.is_ok()));
        let numbers = [step.state.into(), acrobot.state().into(), step.gain, [step.torque; 4]];
        for number in numbers.as_flattened() {
            digest.add(f32::to_bits(*number).into());
        }
    }
    digest.0
}

/// Plans and returns the digest; 0 if there is no plan.
pub fn planned() -> u64 {
    let mut memory = empty();
    plan(LIMIT, RATE, &mut memory).map_or(0, |plan| digest(plan.knots))
}

pub const PLAN: u64 = 0x875c_0dc9_e0fb_48ab;
