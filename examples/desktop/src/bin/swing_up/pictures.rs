//! Pictures of the learning curve, the learnt values and an episode.

use std::f32::consts::PI;

use acrobot::physics::Pendulum;
use acrobot::{Fast, Params, REWARD_THRESHOLD, State};
use plotters::coord::Shift;
use plotters::prelude::*;

use crate::curve::running_mean;

const TITLE: (&str, i32) = ("sans-serif", 24);
const NAME: (&str, i32) = ("sans-serif", 18);
const LABEL: (&str, i32) = ("sans-serif", 15);

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// A picture of this size in pixels, as SVG.
pub fn svg(
    size: (u32, u32),
    draw: impl FnOnce(&Area) -> anyhow::Result<()>,
) -> anyhow::Result<String> {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        area.fill(&WHITE)?;
        draw(&area)?;
        area.present()?;
    }
    Ok(text)
}

/// The return of each episode, and the running mean.
pub fn draw_curve(area: &Area, returns: &[f32]) -> anyhow::Result<()> {
    let body = area.titled("Learning to swing up", TITLE)?;
    // Both axes are logarithmic: most is learnt in few episodes, and the last steps are the hardest
    // to save.
    let threshold = f64::from(REWARD_THRESHOLD);
    let (worst, best) = (-500_f64, -40_f64);
    let last = (returns.len() as f64).max(2.0);
    let doublings = |reward: f64| -(reward / threshold).log2();
    let mut chart = ChartBuilder::on(&body)
        .margin(10)
        .margin_right(24)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d((1.0..last).log_scale(), doublings(worst)..doublings(best))?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .label_style(LABEL)
        .axis_desc_style(NAME)
        .x_desc("episode")
        .y_desc("return")
        .x_label_formatter(&|episode| format!("{episode:.0}"))
        .y_labels(4)
        .y_label_formatter(&|y| format!("{:.0}", threshold * (-y).exp2()))
        .draw()?;
    let line = |value: &dyn Fn(usize) -> f32| -> Vec<(f64, f64)> {
        let point = |n| (n as f64, doublings(f64::from(value(n)).clamp(worst, best)));
        (1..=returns.len()).map(point).collect()
    };
    let threshold = [1.0, last].map(|n| (n, doublings(threshold))).to_vec();
    for (name, points, color, width) in [
        ("return of an episode", line(&|n| returns[n - 1]), RGBColor(185, 195, 205), 1),
        ("solved: -100", threshold, RGBColor(200, 60, 40), 1),
        (
            "mean of the latest 100",
            line(&|n| running_mean(&returns[..n])),
            RGBColor(33, 145, 140),
            3,
        ),
    ] {
        let style = color.stroke_width(width);
        chart
            .draw_series(LineSeries::new(points, style))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 24, y)], style));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .legend_area_size(30)
        .margin(16)
        .background_style(WHITE)
        .border_style(RGBColor(200, 200, 200))
        .label_font(LABEL)
        .draw()?;
    Ok(())
}

/// The values at rest over both angles, except where the tip is above the target height, which ends
/// an episode.
pub fn draw_values(area: &Area, value: impl Fn(&State<f32>) -> f32) -> anyhow::Result<()> {
    /// The number of cells in each direction.
    const SIDE: usize = 72;
    let at = |i: usize| ((i as f32 + 0.5) / SIDE as f32 * 2.0 - 1.0) * PI;
    let cells = (0..SIDE * SIDE).map(|i| {
        let (theta1, theta2) = (at(i / SIDE), at(i % SIDE));
        let rest = State::from([theta1, theta2, 0.0, 0.0]);
        let pendulum = Pendulum::<Fast>::new(Params::DEFAULT, rest).expect("the angles are finite");
        let value = (pendulum.tip_height() <= 1.0).then(|| f64::from(value(&rest)));
        (f64::from(theta1), f64::from(theta2), value)
    });
    let cells: Vec<_> = cells.collect();
    let values = || cells.iter().filter_map(|&(.., value)| value);
    let least = values().fold(f64::INFINITY, f64::min);
    let most = values().fold(least + 1.0, f64::max);

    let title = "Learnt values at rest: minus the steps to the goal";
    let colors =
        format!("from {least:.1} (dark) to {most:.1} (bright); grey: above the target height");
    let body = area.titled(title, TITLE)?.titled(&colors, NAME)?;
    let pi = f64::from(PI);
    let mut chart = ChartBuilder::on(&body)
        .margin(10)
        .x_label_area_size(44)
        .y_label_area_size(52)
        .build_cartesian_2d(-pi..pi, -pi..pi)?;
    chart
        .configure_mesh()
        .disable_mesh()
        .label_style(LABEL)
        .axis_desc_style(NAME)
        .x_desc("θ1 (rad, 0 = hanging)")
        .y_desc("θ2 (rad, 0 = straight)")
        .x_labels(7)
        .y_labels(7)
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| format!("{y:.0}"))
        .draw()?;
    let half = pi / SIDE as f64;
    chart.draw_series(cells.iter().map(|&(x, y, value)| {
        let color = |value| ViridisRGB.get_color_normalized(value, least, most);
        let color = value.map_or(RGBColor(190, 190, 190), color);
        Rectangle::new([(x - half, y - half), (x + half, y + half)], color.filled())
    }))?;
    Ok(())
}
