//! Counts instructions. Under QEMU's `-icount shift=0` one instruction takes one virtual nanosecond, and SysTick, at
//! 25 MHz, ticks once in 40.

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;

/// SysTick counts down from 2²⁴ − 1: 671 million instructions, longer than any measurement.
pub struct Counter(SYST);

impl Counter {
    pub fn start(mut syst: SYST) -> Self {
        syst.set_clock_source(SystClkSource::Core);
        syst.set_reload(0xff_ffff);
        Self(syst)
    }

    /// The mean instructions of `times` runs.
    pub fn count(&mut self, times: u32, mut run: impl FnMut()) -> u32 {
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
