//! Policies that were trained in Python: multilayer perceptrons with tanh or ReLU, without a heap
//! and without a panic.
//!
//! `acrobot_rs.policy.save` writes a file, and a `static` checks and holds it:
//!
//! ```ignore
//! static POLICY: Policy<64> = match Policy::new(include_bytes!("policy.bin")) {
//!     Ok(policy) => policy,
//!     Err(error) => panic!("{}", error.message()),
//! };
//! ```
//!
//! Each sum begins with the bias and adds the products in the order of the inputs, in `f32` without
//! a fused multiply-add; tanh is `libm`'s. So the outputs have the same bits on every machine, and
//! differ from torch's, which adds in another order, in the last digits.
//!
//! A policy whose outputs are not all finite, because its sums overflow, plays no torque:
//! [`Action::Zero`], or 0 N m.
//!
//! # The file
//!
//! Little-endian, in this order:
//!
//! | bytes | contents |
//! |---|---|
//! | 4 | `MLP1`: the name and the version |
//! | 1 | the number of layers |
//! | 1 | 0: the outputs are scores of the three actions; 1: the only output is a torque, N m |
//! | 2 | the number of inputs, 6 |
//! | 4 | the limit of the torque, N m, as `f32`; 0 for scores |
//! | 4 for each layer | the number of its outputs, 2 bytes; 0 for none, 1 for tanh, 2 for ReLU; 0 |
//! | 4 for each number | for each layer and each of its outputs: the bias, then a weight for each input, as `f32` |
//! | 4 | the CRC-32 of all that, as zlib's |

#![no_std]

use acrobot::Action;

/// The number of inputs: those of an observation.
const INPUTS: usize = 6;

/// A policy whose layers have at most `WIDTH` outputs, 6 at least. It refers to the file. A
/// decision needs 8 `WIDTH` bytes of stack.
#[derive(Clone, Copy, Debug)]
pub struct Policy<'a, const WIDTH: usize> {
    layers: &'a [u8],
    numbers: &'a [u8],
    torque_limit: Option<f32>,
}

/// Why a file is rejected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PolicyError(&'static str);

impl PolicyError {
    const MAGIC: Self = Self("a policy must begin with MLP1");
    const LENGTH: Self = Self("a policy must have the length that its header says");
    const CHECKSUM: Self = Self("a policy must have its checksum");
    const WIDTH: Self = Self("a layer of a policy must have 1 to WIDTH outputs");
    const ACTIVATION: Self = Self("an activation of a policy must be none, tanh or ReLU");
    const SHAPE: Self = Self("a policy must have 6 inputs, and 3 outputs or a torque");
    const NUMBER: Self =
        Self("the numbers of a policy must be finite, and a limit of the torque above 0");

    /// What the file must have.
    pub const fn message(self) -> &'static str {
        self.0
    }
}

impl core::fmt::Display for PolicyError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.message())
    }
}

impl core::error::Error for PolicyError {}

impl<'a, const WIDTH: usize> Policy<'a, WIDTH> {
    /// Checks a file.
    ///
    /// # Errors
    ///
    /// The file is not one that `acrobot_rs.policy.save` wrote, or a layer is too wide.
    pub const fn new(file: &'a [u8]) -> Result<Self, PolicyError> {
        let Some((content, checksum)) = file.split_last_chunk() else {
            return Err(PolicyError::MAGIC);
        };
        let &[b'M', b'L', b'P', b'1', count, kind, low, high, a, b, c, d, ref rest @ ..] = content
        else {
            return Err(PolicyError::MAGIC);
        };
        let Some((layers, numbers)) = rest.split_at_checked(4 * count as usize) else {
            return Err(PolicyError::LENGTH);
        };
        let mut inputs = u16::from_le_bytes([low, high]) as usize;
        if inputs != INPUTS || WIDTH < INPUTS {
            return Err(PolicyError::SHAPE);
        }
        let (mut rest, mut bytes) = (layers, 0_usize);
        while let Some((&[low, high, activation, _], tail)) = rest.split_first_chunk() {
            let outputs = u16::from_le_bytes([low, high]) as usize;
            if outputs == 0 || outputs > WIDTH {
                return Err(PolicyError::WIDTH);
            }
            if activation > 2 {
                return Err(PolicyError::ACTIVATION);
            }
            bytes = bytes.saturating_add(outputs.saturating_mul(4 * (1 + inputs)));
            inputs = outputs;
            rest = tail;
        }
        if numbers.len() != bytes {
            return Err(PolicyError::LENGTH);
        }
        if crc32(content) != u32::from_le_bytes(*checksum) {
            return Err(PolicyError::CHECKSUM);
        }
        let mut rest = numbers;
        while let Some((&number, tail)) = rest.split_first_chunk() {
            if !f32::from_le_bytes(number).is_finite() {
                return Err(PolicyError::NUMBER);
            }
            rest = tail;
        }
        let limit = f32::from_le_bytes([a, b, c, d]);
        let torque_limit = match (kind, inputs) {
            (0, 3) => None,
            (1, 1) if limit > 0.0 && limit.is_finite() => Some(limit),
            (1, 1) => return Err(PolicyError::NUMBER),
            _ => return Err(PolicyError::SHAPE),
        };
        Ok(Self { layers, numbers, torque_limit })
    }

    /// The action with the highest score; among equal ones the first. A policy with a torque takes
    /// the action of its sign.
    pub fn action(&self, observation: &[f32; 6]) -> Action {
        let Some(scores) = self.finite_outputs(observation) else {
            return Action::Zero;
        };
        if self.torque_limit.is_some() {
            let [torque, ..] = scores;
            return match torque {
                x if x < 0.0 => Action::Negative,
                x if x > 0.0 => Action::Positive,
                _ => Action::Zero,
            };
        }
        let mut best = (Action::Negative, f32::NEG_INFINITY);
        for (action, &score) in Action::ALL.into_iter().zip(&scores) {
            if score > best.1 {
                best = (action, score);
            }
        }
        best.0
    }

    /// The torque within its limits, N m. None for a policy with scores of actions.
    pub fn torque(&self, observation: &[f32; 6]) -> Option<f32> {
        let limit = self.torque_limit?;
        let [torque, ..] = self.finite_outputs(observation).unwrap_or_default();
        Some(torque.min(limit).max(-limit)) // `clamp` can panic
    }

    fn finite_outputs(&self, observation: &[f32; 6]) -> Option<[f32; 3]> {
        let outputs = self.outputs(observation);
        outputs.iter().all(|x| x.is_finite()).then_some(outputs)
    }

    /// The outputs of the last layer: three scores, or a torque before its limits, N m. The rest is
    /// 0.
    pub fn outputs(&self, observation: &[f32; 6]) -> [f32; 3] {
        let mut inputs = [0.0; WIDTH];
        for (input, x) in inputs.iter_mut().zip(*observation) {
            *input = x;
        }
        let mut width = INPUTS;
        let (numbers, _) = self.numbers.as_chunks();
        let mut numbers = numbers.iter().map(|&number| f32::from_le_bytes(number));
        let (layers, _) = self.layers.as_chunks();
        for &[low, high, activation, _] in layers {
            let mut outputs = [0.0; WIDTH];
            let count = u16::from_le_bytes([low, high]).into();
            for output in outputs.iter_mut().take(count) {
                let mut sum = numbers.next().unwrap_or_default();
                for (input, weight) in inputs.iter().take(width).zip(&mut numbers) {
                    sum += weight * input;
                }
                *output = match activation {
                    0 => sum,
                    1 => libm::tanhf(sum),
                    _ if sum < 0.0 => 0.0,
                    _ => sum, // also NaN, of which `max` would make 0
                };
            }
            inputs = outputs;
            width = count;
        }
        let mut last = [0.0; 3];
        for (output, x) in last.iter_mut().zip(inputs) {
            *output = x;
        }
        last
    }
}

/// zlib's, without a table: the compiler computes it.
const fn crc32(mut bytes: &[u8]) -> u32 {
    let mut crc = u32::MAX;
    while let Some((&byte, tail)) = bytes.split_first() {
        crc ^= byte as u32;
        let mut bit = 0;
        while bit < 8 {
            crc = (crc >> 1) ^ (0xedb8_8320 * (crc & 1));
            bit += 1;
        }
        bytes = tail;
    }
    !crc
}
