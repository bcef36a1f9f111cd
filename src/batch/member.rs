//! One acrobot of a batch, to save and to load.

use super::buffers::take_mut;
use super::{Batch, Block, ParamsKind, check_index, no_such_member};
use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::numpy::Pcg64;
use crate::physics::State;

/// One acrobot's saved state. Saving all members saves the batch except its settings. With the `serde` feature it
/// can be stored, as an [`Acrobot`](crate::Acrobot#snapshots) can.
///
/// ```
/// use acrobot::Fast;
/// use acrobot::batch::{Batch, Block, Member};
/// use acrobot::numpy::Pcg64;
///
/// let new = |seed| Batch::<Fast, _, _>::new(seed, [Block::EMPTY; 2], [Pcg64::UNSEEDED; 20]);
/// let (batch, mut twin) = (new(42)?, new(0)?);
/// let saved: Vec<Member<Fast>> = (0..20).filter_map(|index| batch.member(index)).collect();
/// for (index, member) in saved.into_iter().enumerate() {
///     twin.set_member(index, member)?;
/// }
/// assert_eq!(twin.member(19), batch.member(19));
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Member<A: Arithmetic> {
    /// The state.
    pub state: State<A::Scalar>,
    /// The number of steps since the last reset.
    pub elapsed: u32,
    /// Whether the next step resets it; only with [`Autoreset::NextStep`](super::Autoreset::NextStep).
    pub ended: bool,
    /// The generator of its initial states and its torque noise.
    pub rng: Pcg64,
}

impl<A, B, G, const N: usize, P> Batch<A, B, G, N, P>
where
    A: Arithmetic,
    B: AsRef<[Block<A, N, P>]> + AsMut<[Block<A, N, P>]>,
    G: AsRef<[Pcg64]> + AsMut<[Pcg64]>,
    P: ParamsKind<A>,
{
    /// Acrobot `index`, if there is one.
    #[must_use]
    pub fn member(&self, index: usize) -> Option<Member<A>> {
        let rng = self.generators.as_ref().get(index)?.clone();
        let block = self.blocks.as_ref().get(index / N)?;
        let (elapsed, ended) = block.progress(index % N)?;
        Some(Member {
            state: block.state(index % N)?,
            elapsed,
            ended,
            rng,
        })
    }

    /// Replaces acrobot `index` by `member`, which continues bit-identically. If its reset is pending,
    /// [`Autoreset::SameStep`](super::Autoreset::SameStep) resets it immediately, and
    /// [`Autoreset::Disabled`](super::Autoreset::Disabled) never.
    ///
    /// # Errors
    ///
    /// [`Error::NoSuchIndex`] for an index of at least [`len`](Self::len), and [`Error::OutOfRange`] for a state with a
    /// number that is not finite.
    pub fn set_member(&mut self, index: usize, member: Member<A>) -> Result<(), Error> {
        member.state.validate()?;
        let len = self.len();
        check_index(index, len)?;
        let block = self.blocks.as_mut().get_mut(index / N);
        let mut generators = self.generators.as_mut().get_mut(index - index % N..);
        let generators = take_mut(generators.get_or_insert_default(), N);
        let (Some(block), Some(rng)) = (block, generators.get_mut(index % N)) else {
            return Err(no_such_member(index, len));
        };
        block.resume(index % N, member.state, (member.elapsed, member.ended));
        *rng = member.rng;
        block.stop_waiting(&self.settings, generators);
        Ok(())
    }
}

#[cfg(feature = "serde")]
mod snapshot {
    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::{Serialize, Serializer};

    use super::{Member, Pcg64, State};
    use crate::arithmetic::Arithmetic;
    use crate::snapshot::{Header, Subject};

    impl<A: Arithmetic> Subject for Member<A> {
        const NAME: &'static str = "batch member";
        type Arithmetic = A;
    }

    #[derive(serde::Serialize, serde::Deserialize)]
    #[serde(rename = "Member")]
    struct Snapshot<H, S, R> {
        snapshot: H,
        state: State<S>,
        elapsed: u32,
        ended: bool,
        rng: R,
    }

    impl<A: Arithmetic<Scalar: Serialize>> Serialize for Member<A> {
        fn serialize<T: Serializer>(&self, serializer: T) -> Result<T::Ok, T::Error> {
            Snapshot {
                snapshot: Header::<Self>::NEW,
                state: self.state,
                elapsed: self.elapsed,
                ended: self.ended,
                rng: &self.rng,
            }
            .serialize(serializer)
        }
    }

    impl<'de, A: Arithmetic<Scalar: Deserialize<'de>>> Deserialize<'de> for Member<A> {
        /// Rejects what [`set_member`](crate::batch::Batch::set_member) rejects.
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            let Snapshot::<Header<Self>, _, Pcg64> {
                state,
                elapsed,
                ended,
                rng,
                ..
            } = Snapshot::deserialize(deserializer)?;
            state.validate().map_err(D::Error::custom)?;
            Ok(Self {
                state,
                elapsed,
                ended,
                rng,
            })
        }
    }
}
