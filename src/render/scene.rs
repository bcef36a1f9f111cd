//! Drawing: the geometry of a figure in pixels, and their colours.

use embedded_graphics_core::Pixel;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{Point, Size};
use embedded_graphics_core::pixelcolor::PixelColor;
use embedded_graphics_core::primitives::{PointsIter, Rectangle};
use micromath::F32Ext;

use super::{Figure, Theme};

impl Figure {
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
        let Some(scene) = Scene::new(self, area) else {
            return Ok(());
        };
        target.fill_contiguous(&area, area.points().map(|point| scene.color(point, theme)))
    }

    /// Draws over a drawing of `previous`. Only the pixels that differ are written.
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
        let (Some(old), Some(new)) = (Scene::new(previous, area), Scene::new(self, area)) else {
            return Ok(());
        };
        // If the line moved, pixels change across the whole width.
        let changed = if old.line == new.line {
            Rectangle::with_corners(
                old.corners[0].component_min(new.corners[0]),
                old.corners[1].component_max(new.corners[1]),
            )
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

/// A figure in the pixels of one target. The parts overlap as in Gymnasium, the lower link over the
/// upper.
struct Scene {
    /// Corners of a rectangle around all parts except the line.
    corners: [Point; 2],
    /// The row of the target height.
    line: i32,
    links: [Bar; 2],
    joints: [Vector; 2],
    /// That of the joints.
    radius: f32,
    arrow: Option<[Bar; 8]>,
}

/// Targets with fewer pixels than this in one direction show no arrow.
const ROOM_FOR_ARROW: u32 = 48;

/// A bar covers pixels with centres up to this far from it, pixels, as in Gymnasium, which
/// truncates the corners of a link to whole pixels and includes them.
const TOLERANCE: f32 = 0.5;

impl Scene {
    /// `None` for an area without pixels, and for an area beyond `i32::MAX`, where
    /// embedded-graphics would overflow.
    fn new(figure: &Figure, area: Rectangle) -> Option<Self> {
        let Size { width, height } = area.size;
        let last = |start: i32, side: u32| {
            let end = start.checked_add(side.try_into().ok()?)?;
            (end > start).then(|| end - 1)
        };
        let last = Point::new(last(area.top_left.x, width)?, last(area.top_left.y, height)?);
        // Half the shorter side in pixels; the fixed joint is in the middle of the area.
        let half = width.min(height) as f32 / 2.0;
        let metre = figure.metre * half;
        let thickness = 0.1 * metre;
        let [left, top] = [area.top_left.x, area.top_left.y].map(|x| x as f32);
        let center = [left + width as f32 / 2.0, top + height as f32 / 2.0];

        let [(sin1, cos1), (sin2, cos2)] = figure.directions;
        let [length1, length2] = figure.lengths.map(|length| length * half);
        // Rows count downwards, and so does the cosine of an angle from hanging down.
        let elbow = offset(center, length1, [sin1, cos1]);
        let tip = offset(elbow, length2, [sin2, cos2]);

        let room = width.min(height) >= ROOM_FOR_ARROW && figure.torque != 0;
        // An arrow reaches 0.4 m from the elbow, and a link's corner √2 of its half width.
        let margin = if room { 0.5 * metre } else { 1.5 * thickness } + 2.0;
        let corner = |pick: fn(f32, f32) -> f32, margin| {
            let x = pick(pick(center[0], elbow[0]), tip[0]) + margin;
            let y = pick(pick(center[1], elbow[1]), tip[1]) + margin;
            let corner = Point::new(x as i32, y as i32);
            corner.component_max(area.top_left).component_min(last)
        };
        Some(Self {
            corners: [corner(f32::min, -margin), corner(f32::max, margin)],
            // Gymnasium counts rows upwards and truncates: the upper row at the edge of two.
            line: (F32Ext::ceil(center[1] - metre) as i32).saturating_sub(1),
            links: [(center, elbow), (elbow, tip)].map(|(from, to)| Bar::new(from, to, thickness)),
            joints: [center, elbow],
            radius: thickness,
            arrow: room.then(|| arrow(elbow, 0.3 * metre, f32::from(figure.torque))),
        })
    }

    fn color<C: PixelColor>(&self, point: Point, theme: &Theme<C>) -> C {
        let [link1, link2] = &self.links;
        let [joint1, joint2] = self.joints;
        let is_on = |joint| {
            let [x, y] = to(joint, point);
            x * x + y * y <= self.radius * self.radius
        };
        let [first, last] = self.corners;
        let inside =
            first.x <= point.x && first.y <= point.y && point.x <= last.x && point.y <= last.y;
        match point.y == self.line {
            _ if inside && self.arrow.iter().flatten().any(|bar| bar.covers(point)) => theme.torque,
            _ if inside && is_on(joint2) => theme.joint,
            _ if inside && link2.covers(point) => theme.link,
            _ if inside && is_on(joint1) => theme.joint,
            _ if inside && link1.covers(point) => theme.link,
            true => theme.target,
            false => theme.background,
        }
    }
}

/// Three quarters of a turn around `center`, open below, with two barbs at the end. A positive
/// `direction` is counter-clockwise.
fn arrow(center: Vector, radius: f32, direction: f32) -> [Bar; 8] {
    const D: f32 = core::f32::consts::FRAC_1_SQRT_2;
    const END: Vector = [-D, D];
    let at = |[x, y]: Vector| offset(center, radius, [direction * x, y]);
    [
        ([D, D], [1.0, 0.0]),
        ([1.0, 0.0], [D, -D]),
        ([D, -D], [0.0, -1.0]),
        ([0.0, -1.0], [-D, -D]),
        ([-D, -D], [-1.0, 0.0]),
        ([-1.0, 0.0], END),
        // The barbs, 40° to either side of the last piece of the arc.
        (END, [END[0] - 0.49, END[1] - 0.25]),
        (END, [END[0] + 0.17, END[1] - 0.52]),
    ]
    .map(|(from, to)| Bar::new(at(from), at(to), radius / 12.0))
}

/// A position or a direction in pixels, to the right and downwards; pixel (0, 0) covers (0, 0) to
/// (1, 1).
type Vector = [f32; 2];

fn offset([x, y]: Vector, distance: f32, direction: Vector) -> Vector {
    [x + distance * direction[0], y + distance * direction[1]]
}

/// The vector to the centre of a pixel.
fn to([x, y]: Vector, point: Point) -> Vector {
    [point.x as f32 + 0.5 - x, point.y as f32 + 0.5 - y]
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
    #[inline(never)] // saves 400 bytes of flash: a drawing has ten bars
    fn new(from: Vector, to: Vector, half_width: f32) -> Self {
        let (x, y) = (to[0] - from[0], to[1] - from[1]);
        let length = libm::sqrtf(x * x + y * y);
        Self {
            from,
            // A bar of length 0 has an infinite or NaN direction and covers nothing.
            along: [x / length, y / length],
            length,
            half_width,
        }
    }

    fn covers(&self, point: Point) -> bool {
        let ([x, y], [right, down]) = (to(self.from, point), self.along);
        let (along, across) = (x * right + y * down, y * right - x * down);
        across.abs() <= self.half_width + TOLERANCE
            && -TOLERANCE <= along
            && along <= self.length + TOLERANCE
    }
}
