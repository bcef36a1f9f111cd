use std::convert::Infallible;

use rand_core::{Rng, TryRng};

/// A custom generator, which repeats these words.
#[derive(Clone, Debug, PartialEq)]
pub struct Repeating {
    pub words: Vec<u64>,
    drawn: usize,
}

impl Repeating {
    pub fn new(words: impl Into<Vec<u64>>) -> Self {
        let words = words.into();
        Self { words, drawn: 0 }
    }
}

impl TryRng for Repeating {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        self.try_next_u64().map(|word| word as u32)
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        self.drawn += 1;
        Ok(self.words[self.drawn % self.words.len()])
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        bytes.fill_with(|| self.next_u64() as u8);
        Ok(())
    }
}
