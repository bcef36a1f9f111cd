//! Counts instructions under QEMU's `-icount shift=0`, where an instruction takes one virtual
//! nanosecond.

#[cfg(target_arch = "arm")]
use cortex_m::peripheral::{Peripherals, SYST, syst::SystClkSource};
#[cfg(target_arch = "riscv32")]
use riscv::register::minstret;
#[cfg(target_arch = "arm")]
use semihosting::process;

/// SysTick, with its frequency in MHz. It counts down from 2²⁴ − 1.
#[cfg(target_arch = "arm")]
pub struct Counter(SYST, u64);

#[cfg(target_arch = "arm")]
impl Counter {
    pub fn take() -> Self {
        let Some(mut peripherals) = Peripherals::take() else { process::exit(1) };
        peripherals.SYST.set_clock_source(SystClkSource::Core);
        peripherals.SYST.set_reload(0xff_ffff);
        // The core's part number tells which QEMU machine this is.
        let megahertz = match peripherals.CPUID.base.read() >> 4 & 0xfff {
            0xc20 => 16, // Cortex-M0: microbit
            0xd21 => 20, // Cortex-M33: mps2-an505
            _ => 25,     // Cortex-M3 and M4: mps2-an385 and mps2-an386
        };
        Self(peripherals.SYST, megahertz)
    }

    fn start(&mut self) {
        self.0.clear_current();
        self.0.enable_counter();
    }

    fn stop(&mut self) -> u64 {
        let ticks = 0xff_ffff - SYST::get_current();
        self.0.disable_counter();
        u64::from(ticks) * 1000 / self.1
    }
}

/// The instructions before counting.
#[cfg(target_arch = "riscv32")]
pub struct Counter(u64);

#[cfg(target_arch = "riscv32")]
impl Counter {
    pub fn take() -> Self {
        Self(0)
    }

    fn start(&mut self) {
        self.0 = minstret::read64();
    }

    fn stop(&mut self) -> u64 {
        minstret::read64() - self.0
    }
}

impl Counter {
    /// The mean number of instructions of `times` runs.
    pub fn count(&mut self, times: u32, mut run: impl FnMut()) -> u32 {
        self.start();
        for _ in 0..times {
            run();
        }
        (self.stop() / u64::from(times)) as u32
    }
}
