//! ST's Nucleo-F446RE, for a machine with a motor driver that takes a duty and a direction.
//!
//! | pins | names on the board | |
//! |---|---|---|
//! | PA0, PA1 | A0, A1 | encoder of joint 1, on timer 2 |
//! | PA6, PA7 | D12, D11 | encoder of joint 2, on timer 3 |
//! | PA8 | D7 | PWM of 20 kHz, by timer 1 |
//! | PA9 | D8 | direction: high for a positive torque |
//! | PA2, PA3 | USB of the ST-Link | serial line |
//!
//! PA8 needs a resistor to ground, because pins float during a reset.

use core::panic::PanicInfo;
use core::pin::pin;
use core::task::{Context, Waker};

use cortex_m_rt::{ExceptionFrame, exception};
use embassy_stm32::gpio::{Level, Output, OutputType, Speed};
use embassy_stm32::peripherals::{IWDG, TIM1, TIM2, TIM3, USART2};
use embassy_stm32::rcc;
use embassy_stm32::time::Hertz;
use embassy_stm32::timer::low_level::CountingMode;
use embassy_stm32::timer::qei::Qei;
use embassy_stm32::timer::simple_pwm::{PwmPin, SimplePwm};
use embassy_stm32::usart::{self, BufferedInterruptHandler, BufferedUart};
use embassy_stm32::wdg::IndependentWatchdog;
use embassy_stm32::{Config, bind_interrupts, pac};
use embedded_io_async::{Read, ReadReady, Write};

/// What RTIC asks of the chip.
pub const NVIC_PRIO_BITS: u8 = 4;
/// SysTick counts the core's cycles.
pub const COUNTS_PER_SECOND: f32 = 168e6;
pub const CYCLES_PER_COUNT: u32 = 1;
const BAUD: u32 = 1_000_000;
/// The motor's torque at a duty of 1, N m: change it.
const TORQUE: f32 = 6.0;

bind_interrupts!(struct Interrupts {
    USART2 => BufferedInterruptHandler<USART2>;
});

pub struct Board {
    encoders: (Qei<'static, TIM2>, Qei<'static, TIM3>),
    counts: [i32; 2],
    motor: SimplePwm<'static, TIM1>,
    direction: Output<'static>,
    line: BufferedUart<'static>,
    watchdog: IndependentWatchdog<'static, IWDG>,
}

impl Board {
    pub fn new() -> Self {
        let mut config = Config::default();
        // 8 MHz from the ST-Link / 4 * 168 / 2 = 168 MHz.
        config.rcc.hse = Some(rcc::Hse { freq: Hertz(8_000_000), mode: rcc::HseMode::Bypass });
        config.rcc.pll_src = rcc::PllSource::HSE;
        config.rcc.pll = Some(rcc::Pll {
            prediv: rcc::PllPreDiv::DIV4,
            mul: rcc::PllMul::MUL168,
            divp: Some(rcc::PllPDiv::DIV2),
            divq: None,
            divr: None,
        });
        config.rcc.apb1_pre = rcc::APBPrescaler::DIV4;
        config.rcc.apb2_pre = rcc::APBPrescaler::DIV2;
        config.rcc.sys = rcc::Sysclk::PLL1_P;
        let p = embassy_stm32::init(config);

        let pwm = PwmPin::new(p.PA8, OutputType::PushPull);
        let rate = Hertz(20_000);
        let mode = CountingMode::EdgeAlignedUp;
        let mut motor = SimplePwm::new(p.TIM1, Some(pwm), None, None, None, rate, mode);
        motor.ch1().set_duty_cycle(0);
        motor.ch1().enable();
        let mut config = usart::Config::default();
        config.baudrate = BAUD;
        // Six frames of samples, and the longest command.
        let sent = cortex_m::singleton!(: [u8; 128] = [0; 128]).unwrap();
        let received = cortex_m::singleton!(: [u8; 192] = [0; 192]).unwrap();
        let line =
            BufferedUart::new(p.USART2, p.PA3, p.PA2, sent, received, Interrupts, config).unwrap();
        let mut watchdog = IndependentWatchdog::new(p.IWDG, 100_000);
        watchdog.unleash();
        Self {
            encoders: (
                Qei::new(p.TIM2, p.PA0, p.PA1, Default::default()),
                Qei::new(p.TIM3, p.PA6, p.PA7, Default::default()),
            ),
            counts: [0; 2],
            motor,
            direction: Output::new(p.PA9, Level::Low, Speed::Low),
            line,
            watchdog,
        }
    }

    /// What both encoders count, from counters of 16 bits.
    pub fn counts(&mut self) -> Option<[i32; 2]> {
        let now = [self.encoders.0.count(), self.encoders.1.count()];
        for (count, now) in self.counts.iter_mut().zip(now) {
            let moved = now.wrapping_sub(*count as u16) as i16;
            *count = count.wrapping_add(moved.into());
        }
        Some(self.counts)
    }

    /// Lets the motor follow a torque, N m.
    pub fn set_torque(&mut self, torque: f32) {
        self.direction.set_level(Level::from(torque > 0.0));
        let most = self.motor.ch1().max_duty_cycle();
        let duty = (torque.abs() / TORQUE).min(1.0) * most as f32;
        self.motor.ch1().set_duty_cycle(duty as u32);
    }

    /// Sends a frame, without waiting. It is lost where the line is too slow.
    pub fn send(&mut self, frame: &[u8]) {
        let written = pin!(self.line.write(frame));
        let _ = written.poll(&mut Context::from_waker(Waker::noop()));
    }

    /// A byte, if one came. Without a call for 0.1 s the board is reset, and its motor is off.
    pub fn receive(&mut self) -> Option<u8> {
        self.watchdog.pet();
        let mut byte = [0];
        let is_ready = self.line.read_ready().unwrap_or(false);
        let mut context = Context::from_waker(Waker::noop());
        let is_read = is_ready && pin!(self.line.read(&mut byte)).poll(&mut context).is_ready();
        is_read.then_some(byte[0])
    }
}

/// The board does not measure its RAM.
pub fn ram() -> u32 {
    0
}

fn stop() -> ! {
    pac::TIM1.ccr(0).write(|duty| duty.set_ccr(0));
    loop {
        cortex_m::asm::nop(); // until the watchdog resets the board
    }
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    stop()
}

#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    stop()
}
