//! The steps to the goal from every state, approximately: value iteration on a grid, with linear
//! interpolation.

use std::array::from_fn;
use std::f32::consts::{PI, TAU};

use acrobot::batch::VecBatch;
use acrobot::numpy::SeedSequence;
use acrobot::{Action, Fast, State};
use indicatif::ProgressIterator;
use rayon::prelude::*;

use crate::DEPTH;

/// Points of the grid in θ1, θ2, θ̇1 and θ̇1 + θ̇2. The angles are cyclic.
pub const SHAPE: [usize; 4] = [60, 60, 51, 51];
/// The largest velocities of the grid, rad/s. Shortest paths stay within.
const REACH: [f32; 2] = [5.0, 8.0];
/// States with the same angles.
const PLANE: usize = SHAPE[2] * SHAPE[3];

/// A value for each point of the grid.
pub struct Values(Vec<f32>);

impl Values {
    /// Iterates V(s) = 1 + min V(s′) over the actions, from V = 0.
    pub fn compute() -> Self {
        let mut values = Self(vec![0.0; SHAPE.iter().product()]);
        let planes = SHAPE[0] * SHAPE[1];
        // Each sweep takes one more step into account.
        for _ in (0..DEPTH).progress() {
            // The mirror image of a state has its value, so half of the planes are enough.
            let half = (0..=planes / 2 + SHAPE[1]).into_par_iter();
            let swept = half.map_init(Stepper::default, |stepper, plane| {
                let states: Vec<_> = (0..PLANE).map(|i| state(plane * PLANE + i)).collect();
                let mut found = vec![f32::MAX; PLANE];
                for action in Action::ALL {
                    stepper.step(&states, action, |i, next, reached| {
                        let value = if reached { 0.0 } else { values.at(&next) };
                        found[i] = found[i].min(1.0 + value);
                    });
                }
                for (value, state) in found.iter_mut().zip(&states) {
                    if is_goal(state) {
                        *value = 0.0;
                    }
                }
                found
            });
            for (plane, found) in swept.collect::<Vec<_>>().into_iter().enumerate() {
                let mirrored = mirror(plane) * PLANE;
                for (i, value) in found.into_iter().enumerate() {
                    values.0[plane * PLANE + i] = value;
                    values.0[mirrored + PLANE - 1 - i] = value;
                }
            }
        }
        values
    }

    /// The interpolated value of a state.
    #[inline]
    pub fn at(&self, state: &State<f32>) -> f32 {
        let x = coordinates(state);
        let positions = [
            (x[0] + PI) * (SHAPE[0] as f32 / TAU),
            (x[1] + PI) * (SHAPE[1] as f32 / TAU),
            velocity(x[2], 0),
            velocity(x[3], 1),
        ];
        let low = positions.map(|position| position as usize);
        let part: [f32; 4] = from_fn(|d| positions[d] - low[d] as f32);
        let rows = from_fn::<_, 2, _>(|d| [low[d] % SHAPE[d], (low[d] + 1) % SHAPE[d]]);
        let lerp = |[a, b]: [f32; 2], part: f32| a + (b - a) * part;
        let corner = low[2] * SHAPE[3] + low[3];
        let planes = rows[0].map(|row| {
            let row = rows[1].map(|column| {
                let first = (row * SHAPE[1] + column) * PLANE + corner;
                let v = |i| self.0[first + i];
                let pairs = [[v(0), v(1)], [v(SHAPE[3]), v(SHAPE[3] + 1)]];
                lerp(pairs.map(|pair| lerp(pair, part[3])), part[2])
            });
            lerp(row, part[1])
        });
        lerp(planes, part[0])
    }
}

/// θ1, θ2, θ̇1 and θ̇1 + θ̇2: the velocities of both links in space.
pub fn coordinates(state: &State<f32>) -> [f32; 4] {
    let [theta1, theta2, dtheta1, dtheta2] = (*state).into();
    [theta1, theta2, dtheta1, dtheta1 + dtheta2]
}

/// The position of a velocity between the points of its dimension.
#[inline]
fn velocity(x: f32, link: usize) -> f32 {
    let steps = (SHAPE[2 + link] - 1) as f32;
    // Below the last point, so that there is a next one.
    ((x / REACH[link] + 1.0) * (steps / 2.0)).clamp(0.0, steps * 0.999_999)
}

/// The state at a point.
fn state(mut point: usize) -> State<f32> {
    let mut x = [0.0; 4];
    for d in (0..4).rev() {
        let i = (point % SHAPE[d]) as f32;
        point /= SHAPE[d];
        x[d] = match d.checked_sub(2) {
            None => i * (TAU / SHAPE[d] as f32) - PI,
            Some(link) => (2.0 * i / (SHAPE[d] - 1) as f32 - 1.0) * REACH[link],
        };
    }
    State::from([x[0], x[1], x[2], x[3] - x[2]])
}

/// The plane of the negated angles.
fn mirror(plane: usize) -> usize {
    let [first, second] = [plane / SHAPE[1], plane % SHAPE[1]];
    (SHAPE[0] - first) % SHAPE[0] * SHAPE[1] + (SHAPE[1] - second) % SHAPE[1]
}

#[expect(clippy::disallowed_methods, reason = "these bits need not be the same everywhere")]
fn is_goal(state: &State<f32>) -> bool {
    -state.theta1.cos() - (state.theta1 + state.theta2).cos() > 1.0
}

/// The states that a batch steps at a time.
const LANES: usize = 512;

pub struct Stepper(VecBatch<Fast>);

impl Default for Stepper {
    fn default() -> Self {
        Self(VecBatch::new(SeedSequence::new(0), LANES).expect("lanes"))
    }
}

impl Stepper {
    /// Calls `to` with the index of each state, its next state, and whether that is a goal state.
    pub fn step(
        &mut self,
        states: &[State<f32>],
        action: Action,
        mut to: impl FnMut(usize, State<f32>, bool),
    ) {
        let Self(batch) = self;
        for (chunk, states) in states.chunks(LANES).enumerate() {
            let mut lanes = [State::default(); LANES];
            lanes[..states.len()].copy_from_slice(states);
            batch.reset_to(&lanes).expect("finite states");
            let results = batch.step(&[action; LANES]).expect("valid actions");
            let reached = results.terminated[..states.len()].to_vec();
            for (i, reached) in reached.into_iter().enumerate() {
                let next = batch.state_of(i).expect("a lane");
                to(chunk * LANES + i, next, reached);
            }
        }
    }
}
