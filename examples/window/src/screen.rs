//! The window, and the copy of a frame into its pixels.

use std::error::Error;
use std::num::NonZeroU32;
use std::rc::Rc;

use acrobot::render::Frame;
use softbuffer::{Context, SoftBufferError, Surface};
use winit::dpi::LogicalSize;
use winit::event_loop::{ActiveEventLoop, OwnedDisplayHandle};
use winit::window::Window;

pub struct Screen {
    window: Rc<Window>,
    surface: Surface<OwnedDisplayHandle, Rc<Window>>,
}

impl Screen {
    pub fn open(event_loop: &ActiveEventLoop) -> Result<Self, Box<dyn Error>> {
        let attributes = Window::default_attributes()
            .with_title("Acrobot")
            .with_inner_size(LogicalSize::new(500, 500));
        let window = Rc::new(event_loop.create_window(attributes)?);
        let context = Context::new(event_loop.owned_display_handle())?;
        let surface = Surface::new(&context, Rc::clone(&window))?;
        Ok(Self { window, surface })
    }

    pub fn request_redraw(&self) {
        self.window.request_redraw();
    }

    /// Shows the picture in the middle of the window, as large as fits. The rest is white.
    pub fn show(&mut self, picture: &Frame) -> Result<(), SoftBufferError> {
        let size = self.window.inner_size();
        let (Some(width), Some(height)) =
            (NonZeroU32::new(size.width), NonZeroU32::new(size.height))
        else {
            return Ok(()); // minimized
        };
        self.surface.resize(width, height)?;
        let mut pixels = self.surface.buffer_mut()?;
        pixels.fill(0xff_ffff);

        let [width, height] = [size.width, size.height].map(|pixels| pixels as usize);
        let (columns, rows) = (picture.width() as usize, picture.height() as usize);
        let side = width.min(height);
        let (left, top) = ((width - side) / 2, (height - side) / 2);
        for (y, line) in pixels
            .chunks_exact_mut(width)
            .skip(top)
            .take(side)
            .enumerate()
        {
            let row = y * rows / side;
            for (x, pixel) in line[left..left + side].iter_mut().enumerate() {
                let start = 3 * (row * columns + x * columns / side);
                let [red, green, blue] = [0, 1, 2].map(|i| u32::from(picture.bytes()[start + i]));
                *pixel = red << 16 | green << 8 | blue;
            }
        }
        self.window.pre_present_notify();
        pixels.present()
    }
}
