//! Replacing eligibility traces (Sutton & Barto 12.5, for linear methods with binary features) as a ring of the latest
//! tile sets. A trace follows from its age, so a weight without a trace takes no memory. Where hashing makes two tilings
//! share a slot, each has its own trace for it, and the two add up.

/// The number of sets in the ring.
const LENGTH: usize = 64;

/// Smaller traces are cut.
const CUT: f32 = 0.05;

/// The traces of `T` tilings.
#[derive(Clone, Debug)]
pub(crate) struct Traces<const T: usize> {
    /// (γλ)ᵏ, the trace of a set of age k.
    decay: [f32; LENGTH],
    /// The number of ages that have a trace, from 1 to `LENGTH`.
    ages: usize,
    /// The index of the latest set.
    head: usize,
    actions: [u8; LENGTH],
    slots: [[u16; LENGTH]; T],
    /// For each tiling, a bit for each set in the ring whose tile has a trace. A tile that was visited again has its
    /// trace in the later set only.
    live: [u64; T],
}

impl<const T: usize> Traces<T> {
    /// No traces. They will decay by `gamma_lambda` in each step.
    pub fn new(gamma_lambda: f32) -> Self {
        let mut decay = [0.0; LENGTH];
        let (mut ages, mut trace) = (0, 1.0);
        for decay in &mut decay {
            if trace < CUT {
                break;
            }
            *decay = trace;
            trace *= gamma_lambda;
            ages += 1;
        }
        Self {
            decay,
            ages,
            head: 0,
            actions: [0; LENGTH],
            slots: [[0; LENGTH]; T],
            live: [0; T],
        }
    }

    pub fn clear(&mut self) {
        self.live = [0; T];
    }

    /// Adds the latest set. The traces of its tiles become 1, and all others are one step older.
    #[inline]
    pub fn push(&mut self, slots: &[u16; T], action: usize) {
        let head = (self.head + 1) % LENGTH;
        self.head = head;
        self.actions[head] = action as u8;
        let oldest = (head + LENGTH - self.ages) % LENGTH;
        for ((&slot, slots), live) in slots.iter().zip(&mut self.slots).zip(&mut self.live) {
            slots[head] = slot;
            *live = *live & !(1 << oldest) | 1 << head;
        }
    }

    /// w ← w + αδz, where `step` is αδ. Then drops the traces of the tiles of the `next` set.
    #[inline]
    pub fn update<const A: usize>(
        &mut self,
        weights: &mut [[f32; A]],
        step: f32,
        next: Option<(&[u16; T], usize)>,
    ) {
        let mut steps = [0.0; LENGTH];
        for (age, decay) in self.decay.iter().take(self.ages).enumerate() {
            steps[(self.head + LENGTH - age) % LENGTH] = step * decay;
        }
        let (next_slots, chosen) = next.unzip();
        for (t, (slots, live)) in self.slots.iter().zip(&mut self.live).enumerate() {
            let next_slot = next_slots.and_then(|slots| slots.get(t)).copied();
            // In machine words: with 64 bits at once a Cortex-M takes 1.5 times as long.
            for low in (0..LENGTH).step_by(usize::BITS as usize) {
                let (mut rest, mut again) = ((*live >> low) as usize, 0);
                while rest != 0 {
                    let bit = rest & rest.wrapping_neg();
                    let place = (low + rest.trailing_zeros() as usize) % LENGTH;
                    let (slot, action) = (slots[place], usize::from(self.actions[place]));
                    let weights = weights.get_mut(usize::from(slot));
                    if let Some(w) = weights.and_then(|w| w.get_mut(action)) {
                        *w += steps[place];
                    }
                    if next_slot == Some(slot) && chosen == Some(action) {
                        again = bit;
                    }
                    rest ^= bit;
                }
                *live &= !((again as u64) << low);
            }
        }
    }
}
