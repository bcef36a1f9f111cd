//! The learning curve: its running mean, and its chart in the terminal.

use acrobot::REWARD_THRESHOLD;

/// Gymnasium's reward threshold applies to the mean of this many episodes.
const LATEST: usize = 100;

/// The mean of the latest 100 returns, or of all if there are fewer. Returns are integers, so the
/// sum is exact.
pub fn running_mean(returns: &[f32]) -> f32 {
    mean(&returns[returns.len().saturating_sub(LATEST)..])
}

fn mean(returns: &[f32]) -> f32 {
    returns.iter().sum::<f32>() / returns.len() as f32
}

/// The first episode after which Gymnasium calls the task solved.
pub fn solved_at(returns: &[f32]) -> Option<usize> {
    (LATEST..=returns.len()).find(|&n| running_mean(&returns[..n]) >= REWARD_THRESHOLD)
}

/// The rows of the chart, each a factor of √2 in steps: on a linear axis, −500 to −100 would hide
/// the best returns.
const ROWS: usize = 6;

/// Bars of mean returns: better is higher. Each bar covers a sixth of all episodes before it,
/// because most is learnt early.
pub fn chart(returns: &[f32]) -> String {
    const EIGHTHS: [char; 9] = [' ', '▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
    let (mut heights, mut axis) = (Vec::new(), String::new());
    let (mut from, mut tick) = (0, 1);
    while from < returns.len() {
        let to = (from + (from / 6).max(1)).min(returns.len());
        if to >= tick {
            axis += &format!("{:>1$}", "", heights.len().saturating_sub(axis.len()));
            axis += &tick.to_string();
            tick *= 10;
        }
        let rows = (-500.0 / mean(&returns[from..to])).log2() * 2.0;
        // The worst return still has a visible bar.
        heights.push(((rows * 8.0) as usize).clamp(1, ROWS * 8));
        from = to;
    }
    let mut chart = String::from("mean return\n");
    for row in (0..ROWS).rev() {
        let top = -500.0 * (-0.5 * (row + 1) as f32).exp2();
        let bar = |&height: &usize| EIGHTHS[height.saturating_sub(row * 8).min(8)];
        let bars: String = heights.iter().map(bar).collect();
        chart += &format!("{top:>5.0} ┤{bars}\n");
    }
    chart + &format!("{:7}{axis} episodes\n", "")
}
