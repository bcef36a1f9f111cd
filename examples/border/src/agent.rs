//! Q-learning with tile coding, as Sutton & Barto solve Acrobot, behind border's traits. border-core has the loop, the replay
//! buffer and the evaluation, but no learning.

use acrobot::env::{AcrobotEnv, BoxSpace, Discrete, Space};
use acrobot::numpy::{Pcg64, uniform};
use acrobot::{Action, Observation, Portable, TimeLimit};
use acrobot_border::{Adapter, One};
use border_core::generic_replay_buffer::{BatchBase, SimpleReplayBuffer, SimpleStepProcessor};
use border_core::record::Record;
use border_core::{Agent, Policy, ReplayBufferBase, TransitionBatch};

/// The time limit of `Acrobot-v1`, the angles of `Acrobot-v0` for the tiles, and the same bits on every machine.
pub type Acrobot = TimeLimit<AcrobotEnv<Portable, Observation<4>>>;
pub type Env = Adapter<Acrobot>;
pub type Buffer = SimpleReplayBuffer<Rows<Observation<4>>, Rows<Action>>;
pub type Steps = SimpleStepProcessor<Env, Rows<Observation<4>>, Rows<Action>>;

pub fn acrobot() -> Acrobot {
    TimeLimit::v1(AcrobotEnv::default())
}

/// A column of border's replay buffer.
pub struct Rows<T>(Vec<T>);

impl<T> From<One<T>> for Rows<T> {
    fn from(one: One<T>) -> Self {
        Self(vec![one.0])
    }
}

impl<T: Clone> BatchBase for Rows<T> {
    fn new(capacity: usize) -> Self {
        Self(Vec::with_capacity(capacity))
    }

    /// border fills the rows in order, then the first ones again.
    fn push(&mut self, row: usize, data: Self) {
        let kept = data.0.len().min(self.0.len() - row);
        self.0.splice(row..row + kept, data.0);
    }

    fn sample(&self, rows: &Vec<usize>) -> Self {
        Self(rows.iter().map(|&row| self.0[row].clone()).collect())
    }
}

/// The agent to compare with.
pub struct Random(pub Pcg64);

impl Policy<Env> for Random {
    fn sample(&mut self, _observation: &One<Observation<4>>) -> One<Action> {
        One(Discrete::ACTIONS.sample(&mut self.0))
    }
}

impl Agent<Env, Buffer> for Random {}

const TILINGS: usize = 8;
/// Tiles along an axis. An offset tiling needs one more.
const TILES: usize = 7;
const TILING: usize = TILES.pow(4);
/// What each sample of a batch moves each of its tiles by, times the error.
const RATE: f32 = 0.1 / TILINGS as f32;
const BATCH: usize = 32;
/// The share of random actions in training. Few are enough: the values start at 0, above every return, so the agent explores
/// by itself.
const EPSILON: f64 = 0.02;
const DISCOUNT: f32 = 0.99;

/// The value of each action is the sum over the tiles that a state lies in.
pub struct Learner {
    values: Vec<[f32; 3]>,
    space: BoxSpace<Observation<4>>,
    rng: Pcg64,
    training: bool,
}

impl Learner {
    pub fn new(space: BoxSpace<Observation<4>>, rng: Pcg64) -> Self {
        Self {
            values: vec![[0.0; 3]; TILINGS * TILING],
            space,
            rng,
            training: false,
        }
    }

    /// The tile of each tiling. Each tiling has its own offset along each axis.
    fn tiles(&self, observation: &Observation<4>) -> [usize; TILINGS] {
        let [lows, highs, seen] =
            [self.space.low(), self.space.high(), observation].map(|x| x.to_array());
        std::array::from_fn(|tiling| {
            (0..4).fold(tiling, |tile, axis| {
                let (low, high) = (lows[axis], highs[axis]);
                let place = (seen[axis] - low) / (high - low) * (TILES - 1) as f32;
                // Odd multiples, another for each axis, spread the tilings evenly (Miller & Glanz).
                let shift = (tiling * (2 * axis + 1) % TILINGS) as f32 / TILINGS as f32;
                tile * TILES + ((place + shift) as usize).min(TILES - 1)
            })
        })
    }

    fn values(&self, tiles: [usize; TILINGS]) -> [f32; 3] {
        let mut sum = [0.0; 3];
        for tile in tiles {
            for (sum, value) in sum.iter_mut().zip(self.values[tile]) {
                *sum += value;
            }
        }
        sum
    }
}

/// The first of the greatest.
fn best(values: [f32; 3]) -> usize {
    (1..3).fold(0, |best, i| if values[i] > values[best] { i } else { best })
}

impl Policy<Env> for Learner {
    fn sample(&mut self, observation: &One<Observation<4>>) -> One<Action> {
        if self.training && uniform(&mut self.rng, 0.0, 1.0) < EPSILON {
            return One(Action::sample(&mut self.rng));
        }
        One(Action::ALL[best(self.values(self.tiles(&observation.0)))])
    }
}

impl Agent<Env, Buffer> for Learner {
    fn train(&mut self) {
        self.training = true;
    }

    fn eval(&mut self) {
        self.training = false;
    }

    fn is_train(&self) -> bool {
        self.training
    }

    fn opt_with_record(&mut self, buffer: &mut Buffer) -> Record {
        let batch = buffer.batch(BATCH).expect("it holds a step by now");
        let (before, actions, after, rewards, terminated, _truncated, ..) = batch.unpack();
        for (i, reward) in rewards.into_iter().enumerate() {
            // Only a termination has no future. The episode would go on after a truncation.
            let future = match terminated[i] {
                0 => {
                    let values = self.values(self.tiles(&after.0[i]));
                    DISCOUNT * values[best(values)]
                }
                _ => 0.0,
            };
            let tiles = self.tiles(&before.0[i]);
            let action = usize::from(u8::from(actions.0[i]));
            let error = reward + future - self.values(tiles)[action];
            for tile in tiles {
                self.values[tile][action] += RATE * error;
            }
        }
        Record::empty()
    }
}
