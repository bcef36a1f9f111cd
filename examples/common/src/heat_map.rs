//! A colour map and its bar.

use std::error::Error;
use std::ops::Range;

use plotters::coord::Shift;
use plotters::prelude::*;

pub const LABEL: (&str, i32) = ("sans-serif", 15);
pub const NAME: (&str, i32) = ("sans-serif", 18);

/// The number of shades in the colour bar.
const SHADES: u32 = 60;

/// The colour of a value in this range. Values outside have the colours of its ends.
pub fn color(value: f64, range: &Range<f64>) -> RGBColor {
    viridis((value - range.start) / (range.end - range.start))
}

/// Draws the colours of a range, with a name and labels.
pub fn draw_bar(
    area: &DrawingArea<SVGBackend, Shift>,
    range: &Range<f64>,
    name: &str,
    label: &dyn Fn(&f64) -> String,
) -> Result<(), Box<dyn Error>> {
    let mut chart = ChartBuilder::on(area)
        .margin(10)
        .margin_bottom(54)
        .y_label_area_size(60)
        .build_cartesian_2d(0.0..1.0, range.clone())?;
    chart
        .configure_mesh()
        .disable_mesh()
        .disable_x_axis()
        .set_all_tick_mark_size(5)
        .label_style(LABEL)
        .axis_desc_style(NAME)
        .y_desc(name)
        .y_labels(7)
        .y_label_formatter(&label)
        .draw()?;
    chart.draw_series((0..SHADES).map(|shade| {
        let [from, middle, to] = [0.0, 0.5, 1.0].map(|part| {
            let share = (f64::from(shade) + part) / f64::from(SHADES);
            range.start + share * (range.end - range.start)
        });
        Rectangle::new([(0.0, from), (1.0, to)], color(middle, range).filled())
    }))?;
    Ok(())
}

/// The colour map viridis from 0 to 1, which is perceptually uniform, also for the colour-blind.
fn viridis(share: f64) -> RGBColor {
    const FIVE: [[f64; 3]; 5] = [
        [68.0, 1.0, 84.0],
        [59.0, 82.0, 139.0],
        [33.0, 145.0, 140.0],
        [94.0, 201.0, 98.0],
        [253.0, 231.0, 37.0],
    ];
    let position = share.clamp(0.0, 1.0) * 4.0;
    let below = (position as usize).min(3);
    let weight = position - below as f64;
    let [red, green, blue] = std::array::from_fn(|i| {
        let (from, to) = (FIVE[below][i], FIVE[below + 1][i]);
        (from + weight * (to - from)).round() as u8
    });
    RGBColor(red, green, blue)
}
