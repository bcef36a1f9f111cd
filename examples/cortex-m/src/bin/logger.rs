//! Logs an episode of two steps through defmt. `./logger` decodes it.

#![no_std]
#![no_main]

use core::num::NonZeroU32;
use core::sync::atomic::{AtomicU32, Ordering};

use acrobot::task::ResetBounds;
use acrobot::{Acrobot, Action, Fast, Params, TimeLimit};
use cortex_m_rt::entry;
use semihosting::process;
// The transport, and the critical section that it needs.
use {cortex_m as _, defmt_semihosting as _};

const STEPS: NonZeroU32 = NonZeroU32::new(2).unwrap();

/// The log's clock: steps taken.
static CLOCK: AtomicU32 = AtomicU32::new(0);
defmt::timestamp!("{=u32}", CLOCK.load(Ordering::Relaxed));

#[entry]
fn main() -> ! {
    let mut acrobot = TimeLimit::new(Acrobot::<Fast>::new(42), STEPS);
    defmt::info!("start {}", acrobot.state());

    let rejected = Params { dt: 0.0, ..Params::DEFAULT };
    if let Err(error) = acrobot.inner_mut().set_params(rejected) {
        defmt::warn!("{}", error);
    }
    if let Err(error) = ResetBounds::new(0.1, -0.1) {
        defmt::warn!("{}", error);
    }

    loop {
        let action = match acrobot.state().dtheta1 > 0.0 {
            true => Action::Negative,
            false => Action::Positive,
        };
        let step = acrobot.step(action);
        CLOCK.store(acrobot.elapsed_steps(), Ordering::Relaxed);
        defmt::debug!("{} {}", action, step);
        if step.is_done() {
            defmt::info!("end {}", acrobot.inner());
            process::exit(0)
        }
    }
}
