//! Episodes as an animated SVG.

use std::f64::consts::TAU;
use std::iter;
use std::ops::Range;

use acrobot::State;

/// How long a step of 0.2 s is shown, in 1/100 s: about three times as fast as real time.
pub const DELAY: u16 = 7;
/// How long the last frame is shown, in 1/100 s.
const LAST: u16 = 200;

/// Links of 1 m, drawn as Gymnasium draws them. Each state is shown for `delay`, in 1/100 s, and
/// the angles are interpolated between states. In the frames `pushed` the tip has a ring. The text
/// has no blank line, so that Markdown takes it as one picture.
pub fn svg(states: &[State], delay: u16, pushed: Range<usize>) -> String {
    let last = usize::from(LAST / delay);
    let frames = states.len() + last;
    let seconds = f64::from(delay) / 100.0 * frames as f64;
    let rotate = |angle: fn(&State) -> f64| {
        let angles = rotations(states.iter().map(angle), last);
        format!(
            "<animateTransform attributeName=\"transform\" type=\"rotate\" dur=\"{seconds:.2}s\" \
            repeatCount=\"indefinite\" values=\"{angles}\"/>"
        )
    };
    let ring = if pushed.is_empty() {
        String::new()
    } else {
        let times = [pushed.start, pushed.end].map(|frame| frame as f64 / frames as f64);
        format!(
            "<circle cy=\"1\" r=\".25\" fill=\"none\" stroke=\"#b25a00\" stroke-width=\".06\">\n\
            <animate attributeName=\"opacity\" calcMode=\"discrete\" dur=\"{seconds:.2}s\" \
            repeatCount=\"indefinite\" values=\"0;1;0\" keyTimes=\"0;{:.3};{:.3}\"/></circle>\n",
            times[0], times[1]
        )
    };
    let link = r##"<path d="M-.1 0h.2v1h-.2z" fill="#0cc"/><circle r=".1" fill="#cc0"/>"##;
    format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="300" viewBox="-2.2 -2.2 4.4 4.4">
<path d="M-2.2-2.2h4.4v4.4h-4.4z" fill="#fff"/>
<path d="M-2.2-1h4.4" stroke="#000" stroke-width=".01"/>
<g>
{}
{link}
<g transform="translate(0 1)"><g>
{}
{link}
{ring}</g></g>
</g>
</svg>
"##,
        rotate(|state| state.theta1),
        rotate(|state| state.theta2)
    )
}

/// Angles in degrees, clockwise and without jumps at half a turn. The last one is repeated.
fn rotations(angles: impl Iterator<Item = f64>, repeats: usize) -> String {
    let mut unwrapped: Vec<f64> = Vec::new();
    for angle in angles {
        let last = unwrapped.last().copied().unwrap_or(angle);
        unwrapped.push(angle + ((last - angle) / TAU).round() * TAU);
    }
    if let Some(&last) = unwrapped.last() {
        unwrapped.extend(iter::repeat_n(last, repeats));
    }
    let degrees = unwrapped.iter().map(|x| format!("{:.1}", -x.to_degrees()));
    degrees.collect::<Vec<_>>().join(";")
}
