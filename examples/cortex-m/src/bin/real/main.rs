//! Measures a machine and controls it, at the command of a desktop: the program `rig`. SysTick's
//! interrupt ticks, and the main loop plans in between.
//!
//! A board differs in its file only: pins, timers, motor and serial line.

#![no_std]
#![no_main]

#[cfg(feature = "nucleo")]
mod nucleo;
#[cfg(not(feature = "nucleo"))]
mod qemu;
mod real;

#[cfg(feature = "nucleo")]
use nucleo as board;
#[cfg(not(feature = "nucleo"))]
use qemu as board;

use cortex_m_rt as _;

/// RTIC, because a critical section would also stop the interrupt of the serial line, which must
/// not wait while a plan is copied.
#[rtic::app(device = crate::board, peripherals = false)]
mod app {
    use acrobot::control::mpc::{Replanner, Settings};
    use rtic::Mutex;

    use crate::board::Board;
    use crate::real::Real;

    #[shared]
    struct Shared {
        real: Real,
    }

    #[local]
    struct Local {}

    #[init]
    fn init(cx: init::Context) -> (Shared, Local) {
        (Shared { real: Real::new(Board::new(), cx.core.SYST) }, Local {})
    }

    #[task(binds = SysTick, shared = [real])]
    fn tick(mut cx: tick::Context) {
        cx.shared.real.lock(Real::tick);
    }

    #[idle(shared = [real])]
    fn idle(mut cx: idle::Context) -> ! {
        loop {
            cortex_m::asm::wfi();
            if let Some(settings) = cx.shared.real.lock(Real::start) {
                plan(&mut cx.shared.real, settings);
            }
        }
    }

    /// Plans until the controller stops.
    fn plan(real: &mut impl Mutex<T = Real>, settings: Settings) {
        let Ok(mut replanner) = Replanner::new(settings) else {
            return real.lock(Real::reject);
        };
        while let Some(before) = real.lock(|real| real.exchange(&mut replanner)) {
            replanner.work();
            cortex_m::asm::wfi();
            if let Some(message) = real.lock(|real| real.estimate(before)) {
                real.lock(|real| real.send(&message));
            }
        }
    }
}
