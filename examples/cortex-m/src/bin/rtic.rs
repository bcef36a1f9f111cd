//! An RTIC app. SysTick's task owns the acrobot and steps it five times a second; a task of lower
//! priority decides on the next action.

#![no_std]
#![no_main]

use cortex_m_rt as _;

/// What RTIC asks of the chip. On a board this is its PAC.
mod device {
    pub const NVIC_PRIO_BITS: u8 = 3;
}

#[rtic::app(device = crate::device, peripherals = false)]
mod app {
    use acrobot::numpy::Pcg64;
    use acrobot::task::{Gymnasium, Task as _};
    use acrobot::{Acrobot, Action, Fast, TimeLimit};
    use cortex_m::peripheral::SCB;
    use cortex_m::peripheral::syst::SystClkSource;
    use semihosting::{println, process};

    /// SysTick counts per 0.2 s at the core's 25 MHz on QEMU's mps2-an386.
    const PERIOD: u32 = 5_000_000;

    #[shared]
    struct Shared {
        /// What the last tick saw.
        observation: [f32; 6],
        /// The controller's last decision, which each tick applies.
        action: Action,
    }

    #[local]
    struct Local {}

    #[init]
    fn init(cx: init::Context) -> (Shared, Local) {
        let mut syst = cx.core.SYST;
        syst.set_clock_source(SystClkSource::Core);
        syst.set_reload(PERIOD - 1);
        syst.clear_current();
        syst.enable_interrupt();
        syst.enable_counter();
        let shared = Shared {
            // Hanging at rest.
            observation: [1.0, 0.0, 1.0, 0.0, 0.0, 0.0],
            action: Action::Positive,
        };
        (shared, Local {})
    }

    /// Sleeps between ticks. Without it RTIC spins.
    #[idle]
    fn idle(_: idle::Context) -> ! {
        loop {
            cortex_m::asm::wfi();
        }
    }

    /// Steps the acrobot, which stands for the machine. Only this task can reach it, so it needs no
    /// lock.
    #[task(binds = SysTick, priority = 2, shared = [observation, action], local = [
        // The compiler makes it, seed included.
        acrobot: TimeLimit<Acrobot<Fast>> =
            TimeLimit::new(Acrobot::hanging(Pcg64::new(42)), Gymnasium::MAX_STEPS),
    ])]
    fn machine(mut cx: machine::Context) {
        let action = cx.shared.action.lock(|action| *action);
        let step = cx.local.acrobot.step(action);
        cx.shared.observation.lock(|seen| *seen = step.observation);
        if step.is_done() {
            println!("the episode ended after {} steps", cx.local.acrobot.elapsed_steps());
            process::exit(0)
        }
        SCB::set_pendsv(); // runs `controller` after this task
    }

    #[task(binds = PendSV, priority = 1, shared = [observation, action])]
    fn controller(mut cx: controller::Context) {
        let observation = cx.shared.observation.lock(|seen| *seen);
        // Torque against the velocity of link 1, without a lock: a tick need not wait.
        let next = if observation[4] > 0.0 { Action::Negative } else { Action::Positive };
        cx.shared.action.lock(|action| *action = next);
    }
}
