//! The learning curve: its running mean, and the chart of it that grows in the terminal.

use acrobot::REWARD_THRESHOLD;

/// Episodes of a running mean, by which Gymnasium calls a task solved.
const LATEST: usize = 100;

/// The mean of the latest 100 returns, or of all where there are fewer. Returns are whole numbers: the sum is exact.
pub fn running_mean(returns: &[f32]) -> f32 {
    mean(&returns[returns.len().saturating_sub(LATEST)..])
}

fn mean(returns: &[f32]) -> f32 {
    returns.iter().sum::<f32>() / returns.len() as f32
}

/// The first episode from which on Gymnasium calls the task solved.
pub fn solved_at(returns: &[f32]) -> Option<usize> {
    (LATEST..=returns.len()).find(|&n| running_mean(&returns[..n]) >= REWARD_THRESHOLD)
}

/// A row is half a doubling of the steps: what is between −500 and −100 would else hide all that follows.
const ROWS: usize = 6;

/// Bars of mean returns, the better the higher, each of a sixth more episodes than there were: most is learnt early.
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
        // The worst is seen, too.
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
