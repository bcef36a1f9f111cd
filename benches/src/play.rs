//! A random policy that plays a batch.

use acrobot::arithmetic::Arithmetic;
use acrobot::batch::{StepBuffers, VecBatch};
use acrobot::task::{Gymnasium, Task};

/// The policy: the next action of a stream. It costs little compared with a step, and SIMD can
/// compute it.
pub fn draw(stream: &mut u32) -> u8 {
    *stream = stream.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    (((*stream >> 16) * 3) >> 16) as u8
}

/// A batch, the random policy that plays it, and the buffers of its steps.
#[derive(Debug)]
pub struct Play<A: Arithmetic, T: Task = Gymnasium> {
    pub batch: VecBatch<A, T>,
    streams: Vec<u32>,
    actions: Vec<u8>,
    rewards: Vec<f32>,
    terminated: Vec<bool>,
    truncated: Vec<bool>,
    rows: Vec<T::Observation>,
}

impl<A: Arithmetic, T: Task> From<VecBatch<A, T>> for Play<A, T> {
    fn from(mut batch: VecBatch<A, T>) -> Self {
        let len = batch.len();
        let rows = batch.observations().to_vec();
        Self {
            batch,
            streams: (0..len as u32).map(|i| i.wrapping_mul(0x9e37_79b9)).collect(),
            actions: vec![0; len],
            rewards: vec![0.0; len],
            terminated: vec![false; len],
            truncated: vec![false; len],
            rows,
        }
    }
}

impl<A: Arithmetic, T: Task> Play<A, T> {
    pub fn new(len: usize) -> Self {
        Self::from(VecBatch::new(0, len).expect("memory for the batch"))
    }

    /// Draws actions and steps. Returns the number of acrobots.
    pub fn play(&mut self, observe: bool) -> usize {
        for (stream, action) in self.streams.iter_mut().zip(&mut self.actions) {
            *action = draw(stream);
        }
        self.step(observe, false)
    }

    /// How many episodes the last step ended.
    pub fn ends(&self) -> usize {
        let ends = self.terminated.iter().zip(&self.truncated);
        ends.filter(|(terminated, truncated)| **terminated || **truncated).count()
    }

    /// Steps with the last actions, on one core or on all. Returns the number of acrobots.
    pub fn step(&mut self, observe: bool, parallel: bool) -> usize {
        let mut buffers =
            StepBuffers::new(&mut self.rewards, &mut self.terminated, &mut self.truncated);
        if observe {
            buffers.observations = Some(&mut self.rows);
        }
        // The batch inside, which writes into buffers.
        let stepped = match parallel {
            true => (*self.batch).par_step_into(&self.actions, buffers),
            false => (*self.batch).step_into(&self.actions, buffers),
        };
        stepped.expect("slices of the batch's length");
        self.batch.len()
    }
}
