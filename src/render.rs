//! Drawing an acrobot on any `embedded_graphics` target, from a 128×64 OLED to a window.
//!
//! Every pixel's colour is computed from the figure's geometry, topmost part first, so that a pixel
//! is written once. Two figures can be compared pixel by pixel, which is what makes
//! [`Figure::redraw`] write only where they differ.

use embedded_graphics_core::Pixel;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{Point, Size};
use embedded_graphics_core::pixelcolor::{BinaryColor, PixelColor, Rgb888};
use embedded_graphics_core::primitives::{PointsIter, Rectangle};

use crate::acrobot::Acrobot;
use crate::arithmetic::{Arithmetic, Real};

/// The colours of a drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Theme<C> {
    /// Behind everything.
    pub ground: C,
    /// The height that the tip has to reach.
    pub line: C,
    /// Both links.
    pub link: C,
    /// Both joints.
    pub joint: C,
    /// The arrow that shows a torque.
    pub torque: C,
}

impl Theme<Rgb888> {
    /// Gymnasium's colours: links of a greenish blue, olive joints and a black line on white. The
    /// arrow, which Gymnasium does not have, is red.
    pub const GYMNASIUM: Self = Self {
        ground: Rgb888::new(255, 255, 255),
        line: Rgb888::new(0, 0, 0),
        link: Rgb888::new(0, 204, 204),
        joint: Rgb888::new(204, 204, 0),
        torque: Rgb888::new(204, 0, 0),
    };
}

impl Theme<BinaryColor> {
    /// Lit on dark, with dark joints, for displays of one colour.
    pub const MONOCHROME: Self = Self {
        ground: BinaryColor::Off,
        line: BinaryColor::On,
        link: BinaryColor::On,
        joint: BinaryColor::Off,
        torque: BinaryColor::On,
    };
}

impl<C> Theme<C> {
    /// The same theme in another colour type, such as a display's `Rgb565`.
    #[must_use]
    pub fn map<D>(self, mut color: impl FnMut(C) -> D) -> Theme<D> {
        Theme {
            ground: color(self.ground),
            line: color(self.line),
            link: color(self.link),
            joint: color(self.joint),
            torque: color(self.torque),
        }
    }
}

/// Where the parts of an acrobot are: all that a drawing shows.
///
/// It is scaled to the target's bounding box as Gymnasium scales its window: both links and 0.2 m
/// more in each direction fit in the shorter side. Any target size is drawn, also 0×0, and nothing
/// outside of it.
///
/// ```
/// use acrobot::{Acrobot, Action, Fast, Figure, Theme};
/// use embedded_graphics::mock_display::MockDisplay;
///
/// let mut acrobot = Acrobot::<Fast>::new(42);
/// let mut display = MockDisplay::new();
/// # display.set_allow_overdraw(true);
///
/// let mut shown = Figure::new(&acrobot);
/// shown.draw(&mut display, &Theme::MONOCHROME)?;
/// acrobot.step(Action::Positive);
/// let next = Figure::new(&acrobot).with_torque(1.0);
/// next.redraw(&shown, &mut display, &Theme::MONOCHROME)?; // only the pixels that changed
/// # Ok::<(), core::convert::Infallible>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Figure {
    /// Sine and cosine of each link's angle against the vertical.
    directions: [(f32, f32); 2],
    /// Each link's length, and one metre, as parts of half the picture.
    lengths: [f32; 2],
    metre: f32,
    /// −1, 0 or 1.
    torque: i8,
}

impl Figure {
    /// The figure of an acrobot's state and its links' lengths, without a torque.
    #[must_use]
    pub fn new<A: Arithmetic, R>(acrobot: &Acrobot<A, R>) -> Self {
        let [cos1, sin1, cos2, sin2, _, _] = *acrobot.observation();
        let params = acrobot.params();
        let reach = params.length1 + params.length2 + A::Scalar::from_f64(0.2);
        let part = |x: A::Scalar| (x / reach).to_f64() as f32;
        Self {
            directions: [
                (sin1, cos1),
                (sin1 * cos2 + cos1 * sin2, cos1 * cos2 - sin1 * sin2),
            ],
            lengths: [part(params.length1), part(params.length2)],
            metre: part(A::Scalar::from_f64(1.0)),
            torque: 0,
        }
    }

    /// The same with an arrow around the middle joint in the direction of `torque`, if it is not 0
    /// and the target has at least 48 pixels in each direction.
    #[must_use]
    pub fn with_torque(mut self, torque: f32) -> Self {
        self.torque = i8::from(torque > 0.0) - i8::from(torque < 0.0);
        self
    }

    /// Draws the whole picture, each pixel of the target once.
    ///
    /// # Errors
    ///
    /// Those of the target.
    pub fn draw<D: DrawTarget>(
        &self,
        target: &mut D,
        theme: &Theme<D::Color>,
    ) -> Result<(), D::Error> {
        let area = target.bounding_box();
        let scene = Scene::new(self, area);
        target.fill_contiguous(&area, area.points().map(|point| scene.color(point, theme)))
    }

    /// Draws over a picture of `previous`: only the pixels that differ are written, and none where
    /// nothing moved.
    ///
    /// # Errors
    ///
    /// Those of the target.
    pub fn redraw<D: DrawTarget>(
        &self,
        previous: &Self,
        target: &mut D,
        theme: &Theme<D::Color>,
    ) -> Result<(), D::Error>
    where
        D::Color: PartialEq,
    {
        if self == previous {
            return Ok(());
        }
        let area = target.bounding_box();
        let (old, new) = (Scene::new(previous, area), Scene::new(self, area));
        // Where the line moved, it did so across the whole area.
        let changed = if old.line == new.line {
            old.bounds_with(&new).intersection(&area)
        } else {
            area
        };
        let moved = changed.points().filter_map(|point| {
            let color = new.color(point, theme);
            (color != old.color(point, theme)).then_some(Pixel(point, color))
        });
        target.draw_iter(moved)
    }
}

/// A figure in the pixels of one target. The parts overlap in the order of Gymnasium's, the lower
/// link over the upper.
struct Scene {
    /// Around all parts but the line: beyond it no part need be asked.
    bounds: Rectangle,
    /// The row of the line to reach.
    line: i32,
    links: [Bar; 2],
    joints: [Disc; 2],
    arrow: Option<[Bar; 8]>,
}

/// Targets of fewer pixels in one direction show no arrow.
const ROOM_FOR_ARROW: u32 = 48;

/// A pixel belongs to a part that comes within half a pixel of its centre, as in Gymnasium's
/// drawing, which truncates the corners of a link to whole pixels and fills them in.
const TOLERANCE: f32 = 0.5;

impl Scene {
    fn new(figure: &Figure, area: Rectangle) -> Self {
        let Size { width, height } = area.size;
        // Half the picture in pixels; the fixed joint is in the middle of the area.
        let half = width.min(height) as f32 / 2.0;
        let metre = figure.metre * half;
        let thickness = 0.1 * metre;
        let center = Vector {
            x: area.top_left.x as f32 + width as f32 / 2.0,
            y: area.top_left.y as f32 + height as f32 / 2.0,
        };

        let [(sin1, cos1), (sin2, cos2)] = figure.directions;
        let [length1, length2] = figure.lengths.map(|length| length * half);
        // Rows count downwards, as the cosine of an angle against the hanging vertical does.
        let elbow = center.plus(length1 * sin1, length1 * cos1);
        let tip = elbow.plus(length2 * sin2, length2 * cos2);

        let room = width.min(height) >= ROOM_FOR_ARROW && figure.torque != 0;
        // An arrow reaches 0.4 m from the elbow; a link's corner √2 of its half width.
        let margin = if room { 0.5 * metre } else { 1.5 * thickness } + 2.0;
        let corner = |pick: fn(f32, f32) -> f32, margin| {
            let x = pick(pick(center.x, elbow.x), tip.x) + margin;
            let y = pick(pick(center.y, elbow.y), tip.y) + margin;
            Point::new(x as i32, y as i32)
        };
        Self {
            bounds: Rectangle::with_corners(corner(f32::min, -margin), corner(f32::max, margin)),
            // Gymnasium counts its rows upwards and truncates: between two rows it is the upper.
            line: libm::ceilf(center.y - metre) as i32 - 1,
            links: [
                Bar::new(center, elbow, thickness),
                Bar::new(elbow, tip, thickness),
            ],
            joints: [Disc::new(center, thickness), Disc::new(elbow, thickness)],
            arrow: room.then(|| arrow(elbow, 0.3 * metre, f32::from(figure.torque))),
        }
    }

    /// Around the parts of both scenes.
    fn bounds_with(&self, other: &Self) -> Rectangle {
        let end = |scene: &Self| scene.bounds.top_left + scene.bounds.size;
        Rectangle::with_corners(
            self.bounds.top_left.component_min(other.bounds.top_left),
            end(self).component_max(end(other)),
        )
    }

    fn color<C: PixelColor>(&self, point: Point, theme: &Theme<C>) -> C {
        let [link1, link2] = &self.links;
        let [joint1, joint2] = &self.joints;
        let line_or_ground = if point.y == self.line {
            theme.line
        } else {
            theme.ground
        };
        if !self.bounds.contains(point) {
            line_or_ground
        } else if self.arrow.iter().flatten().any(|bar| bar.covers(point)) {
            theme.torque
        } else if joint2.covers(point) {
            theme.joint
        } else if link2.covers(point) {
            theme.link
        } else if joint1.covers(point) {
            theme.joint
        } else if link1.covers(point) {
            theme.link
        } else {
            line_or_ground
        }
    }
}

/// Three quarters of a turn around `center`, open below, and two barbs at the end that the torque
/// turns towards. Positive is counter-clockwise.
fn arrow(center: Vector, radius: f32, direction: f32) -> [Bar; 8] {
    const DIAGONAL: f32 = core::f32::consts::FRAC_1_SQRT_2;
    const END: (f32, f32) = (-DIAGONAL, DIAGONAL);
    [
        ((DIAGONAL, DIAGONAL), (1.0, 0.0)),
        ((1.0, 0.0), (DIAGONAL, -DIAGONAL)),
        ((DIAGONAL, -DIAGONAL), (0.0, -1.0)),
        ((0.0, -1.0), (-DIAGONAL, -DIAGONAL)),
        ((-DIAGONAL, -DIAGONAL), (-1.0, 0.0)),
        ((-1.0, 0.0), END),
        // Back along the last piece of the arc, 40° to either side.
        (END, (END.0 - 0.49, END.1 - 0.25)),
        (END, (END.0 + 0.17, END.1 - 0.52)),
    ]
    .map(|(from, to)| {
        let at = |(x, y)| center.plus(direction * radius * x, radius * y);
        Bar::new(at(from), at(to), radius / 12.0)
    })
}

/// A place on the target in pixels, to the right and downwards; pixel (0, 0) reaches to (1, 1).
#[derive(Clone, Copy)]
struct Vector {
    x: f32,
    y: f32,
}

impl Vector {
    fn plus(self, x: f32, y: f32) -> Self {
        Self {
            x: self.x + x,
            y: self.y + y,
        }
    }

    /// From here to the middle of a pixel.
    fn to(self, point: Point) -> Self {
        Self {
            x: point.x as f32 + 0.5 - self.x,
            y: point.y as f32 + 0.5 - self.y,
        }
    }
}

/// A rectangle along a line.
struct Bar {
    from: Vector,
    /// A unit vector.
    along: Vector,
    length: f32,
    half_width: f32,
}

impl Bar {
    fn new(from: Vector, to: Vector, half_width: f32) -> Self {
        let (x, y) = (to.x - from.x, to.y - from.y);
        let length = libm::sqrtf(x * x + y * y);
        // One without a length has no direction and covers nothing.
        let along = Vector {
            x: x / length,
            y: y / length,
        };
        Self {
            from,
            along,
            length,
            half_width,
        }
    }

    fn covers(&self, point: Point) -> bool {
        let Vector { x, y } = self.from.to(point);
        let along = x * self.along.x + y * self.along.y;
        let across = y * self.along.x - x * self.along.y;
        across.abs() <= self.half_width + TOLERANCE
            && -TOLERANCE <= along
            && along <= self.length + TOLERANCE
    }
}

/// A circle, its rim within the links' sides.
struct Disc {
    center: Vector,
    radius: f32,
}

impl Disc {
    fn new(center: Vector, radius: f32) -> Self {
        Self { center, radius }
    }

    fn covers(&self, point: Point) -> bool {
        let Vector { x, y } = self.center.to(point);
        x * x + y * y <= self.radius * self.radius
    }
}
