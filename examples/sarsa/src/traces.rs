//! Replacing eligibility traces (Sutton & Barto 12.5, there for linear methods with binary features) as a ring of the
//! latest tile sets: a trace is known from its age, and nothing is stored for a weight that has none. Where hashing makes
//! two tilings share a slot, each has a trace of its own for it, and the two add up.

/// Sets that the ring holds.
const LENGTH: usize = 64;

/// Traces below this are cut.
const CUT: f32 = 0.05;

/// The traces of `T` tilings.
#[derive(Clone, Debug)]
pub(crate) struct Traces<const T: usize> {
    /// (γλ)ᵏ for sets of age k.
    decay: [f32; LENGTH],
    /// Ages that have a trace, from 1 to `LENGTH`.
    ages: usize,
    /// Place of the latest set.
    head: usize,
    actions: [u8; LENGTH],
    slots: [[u16; LENGTH]; T],
    /// Of each tiling, the places that have a trace: those visited again since have none, and a
    /// tile has one place at most.
    live: [u64; T],
}

impl<const T: usize> Traces<T> {
    /// None yet, which will decay by `gamma_lambda` a step.
    pub fn new(gamma_lambda: f32) -> Self {
        let mut decay = [0.0; LENGTH];
        let (mut ages, mut trace) = (0, 1.0);
        while ages < LENGTH && trace >= CUT {
            decay[ages] = trace;
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

    /// The latest set: its tiles' traces become 1, and all others a step older.
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

    /// w ← w + αδz, where `step` is αδ. Then drops the traces of the tiles that come `next`.
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
        for (t, (slots, live)) in self.slots.iter().zip(&mut self.live).enumerate() {
            // By the machine's words: a Cortex-M takes half as long again for 64 bits at once.
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
                    if next.is_some_and(|(next, chosen)| slot == next[t] && action == chosen) {
                        again = bit;
                    }
                    rest ^= bit;
                }
                *live &= !((again as u64) << low);
            }
        }
    }
}
