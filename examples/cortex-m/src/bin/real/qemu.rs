//! QEMU's mps2-an386: its serial line. It has neither encoders nor a motor, so the desktop plays
//! the machine.

use acrobot_cortex_m::ram;

/// What RTIC asks of the chip.
pub const NVIC_PRIO_BITS: u8 = 3;

/// SysTick's counts: a tick of 2 ms has as many instructions as on an STM32F4 at 168 MHz, with 1.9
/// cycles an instruction.
pub const COUNTS_PER_SECOND: f32 = 2.21e6;
/// Instructions of a count under QEMU's `-icount shift=0`.
pub const CYCLES_PER_COUNT: u32 = 40;

/// CMSDK's UART: the registers for data, state, control, an interrupt, and the divisor of the rate.
const UART: *mut [u32; 5] = 0x4000_4000 as *mut [u32; 5];
const HAS_RECEIVED: u32 = 2;
const ENABLE_BOTH: u32 = 3;

pub struct Board(());

impl Board {
    pub fn new() -> Self {
        let board = Self(());
        board.write(4, 16);
        board.write(2, ENABLE_BOTH);
        board
    }

    fn read(&self, register: usize) -> u32 {
        // SAFETY: the machine has these registers, and only this struct uses them.
        unsafe { (&raw const (*UART)[register]).read_volatile() }
    }

    fn write(&self, register: usize, value: u32) {
        // SAFETY: as above.
        unsafe { (&raw mut (*UART)[register]).write_volatile(value) }
    }

    /// What both encoders count, on a board that has some.
    pub fn counts(&mut self) -> Option<[i32; 2]> {
        None
    }

    /// Lets the motor follow a torque, N m.
    pub fn set_torque(&mut self, _torque: f32) {}

    /// Sends a frame, without waiting. QEMU is always ready.
    pub fn send(&mut self, frame: &[u8]) {
        frame.iter().for_each(|&byte| self.write(0, byte.into()));
    }

    /// A byte, if one came.
    pub fn receive(&mut self) -> Option<u8> {
        (self.read(1) & HAS_RECEIVED != 0).then(|| self.read(0) as u8)
    }
}

/// Bytes of RAM in use.
pub fn ram() -> u32 {
    ram::used() as u32
}
