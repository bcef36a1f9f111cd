//! Draws an episode on an SSD1306 through its driver and a bus that counts bytes. Compares the display's memory after each
//! frame with the digest of the crate's tests.

#![no_std]
#![no_main]

use core::cell::RefCell;

use acrobot_cortex_m::panel::{Bus, Panel};
use bits::{Digest, oled};
use cortex_m_rt::entry;
use semihosting::{println, process};
use ssd1306::mode::DisplayConfig;
use ssd1306::prelude::{DisplayRotation, DisplaySize128x64};
use ssd1306::{I2CDisplayInterface, Ssd1306};

#[entry]
fn main() -> ! {
    let panel = RefCell::new(Panel::default());
    let interface = I2CDisplayInterface::new(Bus(&panel));
    let mut display = Ssd1306::new(interface, DisplaySize128x64, DisplayRotation::Rotate0)
        .into_buffered_graphics_mode();
    let mut digest = Digest::default();
    let (mut frames, mut first, mut failed) = (0, 0, display.init().is_err());

    let drawn = oled::play(&mut display, oled::start(), oled::policy, |display| {
        let before = panel.borrow().received;
        failed |= display.flush().is_err();
        let panel = panel.borrow();
        if frames == 0 {
            first = panel.received - before;
        }
        frames += 1;
        for word in panel.memory.as_chunks().0 {
            digest.add(u64::from_le_bytes(*word));
        }
        failed |= panel.unknown;
    });

    let all = panel.borrow().received;
    let equal = !failed && drawn.is_ok() && (frames, digest.0) == (oled::FRAMES, oled::DIGEST);
    println!(
        "{frames} frames; bytes on the bus: {first} for the first, {} on average",
        all / frames
    );
    if !equal {
        println!(
            "the frames differ: expected {}, got digest {:#018x}",
            oled::FRAMES,
            digest.0
        );
    }
    process::exit(if equal { 0 } else { 1 })
}
