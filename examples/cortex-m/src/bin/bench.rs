//! Counts instructions: under QEMU's `-icount shift=0` one instruction is one virtual nanosecond,
//! and SysTick, at 25 MHz, ticks once in 40. Prints one figure a line, `arithmetic figure value`.

#![no_std]
#![no_main]

use core::hint::black_box;

use acrobot::{Acrobot, Action, Arithmetic, Fast, Micro, Pcg64, Portable, Real, TimeLimit};
use acrobot_cortex_m::end;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::entry;
use cortex_m_semihosting::hprintln;

#[entry]
fn main() -> ! {
    let Some(peripherals) = cortex_m::Peripherals::take() else {
        end(false)
    };
    let mut counter = Counter::start(peripherals.SYST);
    measure::<Fast>("fast", &mut counter);
    measure::<Micro>("micro", &mut counter);
    measure::<Portable>("portable", &mut counter);
    end(true)
}

/// SysTick runs down from 2²⁴ − 1, which is 671 million instructions: longer than any figure takes.
struct Counter(SYST);

impl Counter {
    fn start(mut syst: SYST) -> Self {
        syst.set_clock_source(SystClkSource::Core);
        syst.set_reload(0xff_ffff);
        Self(syst)
    }

    /// Instructions of one of `times` runs.
    fn count(&mut self, times: u32, mut run: impl FnMut()) -> u32 {
        self.0.clear_current();
        self.0.enable_counter();
        for _ in 0..times {
            run();
        }
        let ticks = 0xff_ffff - SYST::get_current();
        self.0.disable_counter();
        ticks * 40 / times
    }
}

fn measure<A: Arithmetic>(name: &str, counter: &mut Counter) {
    const STEPS: u32 = 4000;
    let mut acrobot = TimeLimit::v1(Acrobot::<A>::new(42));
    let mut action_space = Pcg64::new(42);
    let actions = [(); 64].map(|()| Action::sample(&mut action_space));
    let mut taken = 0;
    let step = counter.count(STEPS, || {
        taken = (taken + 1) % actions.len();
        if black_box(acrobot.step(black_box(actions[taken]))).ended() {
            black_box(acrobot.reset());
        }
    });
    hprintln!("{} step {}", name, step);

    let mut angle = A::Scalar::ZERO;
    let delta = A::Scalar::from_f64(0.001);
    let sin_cos = counter.count(10_000, || {
        angle = angle + delta;
        black_box(A::sin_cos(black_box(angle)));
    });
    hprintln!("{} sin_cos {}", name, sin_cos);

    let reset = counter.count(1000, || {
        black_box(acrobot.reset());
    });
    hprintln!("{} reset {}", name, reset);
}
