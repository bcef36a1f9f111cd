//! A whole batch, saved and loaded with serde: a sequence of its settings and its members.

use core::fmt;
use core::marker::PhantomData;
use core::num::NonZeroU32;

use serde::de::{Deserialize, Deserializer, Error as _, SeqAccess, Visitor};
use serde::ser::{Serialize, SerializeSeq, Serializer};

use super::Batch;
use super::buffers::check_length;
use super::member::Member;
use super::settings::Autoreset;
use super::storage::Storage;
#[cfg(feature = "alloc")]
use super::vec_batch::VecBatch;
use crate::arithmetic::Arithmetic;
use crate::error::Error;
use crate::numpy::SeedSequence;
use crate::physics::Params;
use crate::snapshot::Header;
use crate::task::{Draw, Draws, ResetBounds, Task};

/// The settings. The parameters that all acrobots share are those of each member.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(
    rename = "Settings",
    bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>")
)]
struct Settings<A: Arithmetic, T: Task> {
    snapshot: Header<A, T, true>,
    low: f64,
    high: f64,
    max_steps: NonZeroU32,
    autoreset: Autoreset,
    /// Whether each acrobot has its own parameters.
    own_params: bool,
    draws: Params<Draw<A::Scalar>>,
}

impl<A: Arithmetic, S, T, const N: usize> Serialize for Batch<A, S, T, N>
where
    S: Storage<A, N, T::Memory>,
    T: Task + Serialize,
{
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        let mut records = serializer.serialize_seq(Some(1 + self.len()))?;
        records.serialize_element(&Settings::<A, T> {
            snapshot: Header::of(*self.task()),
            low: self.settings.bounds.low(),
            high: self.settings.bounds.high(),
            max_steps: self.settings.max_steps,
            autoreset: self.settings.autoreset,
            own_params: self.has_own_params(),
            draws: *self.draws().params(),
        })?;
        for member in (0..self.len()).filter_map(|index| self.member(index).ok()) {
            records.serialize_element(&member)?;
        }
        records.end()
    }
}

impl<A: Arithmetic, S: Storage<A, N, T::Memory>, T: Task, const N: usize> Batch<A, S, T, N> {
    /// Loads a [snapshot](Self#snapshots) of a batch into memory for as many acrobots, for example
    /// with `&mut postcard::Deserializer::from_bytes(&bytes)`.
    ///
    /// ```
    /// # use acrobot::Fast;
    /// # use acrobot::batch::{Batch, BatchMemory, Block};
    /// # use acrobot::numpy::Pcg64;
    /// let (blocks, generators) = ([Block::EMPTY], [Pcg64::UNSEEDED; 3]);
    /// let memory = BatchMemory { blocks, generators, own: () };
    /// let batch = Batch::<Fast, _>::new(42, memory.clone()).unwrap();
    /// let bytes = postcard::to_stdvec(&batch)?;
    /// let mut reader = postcard::Deserializer::from_bytes(&bytes);
    /// let loaded = Batch::<Fast, _>::from_snapshot(memory, &mut reader)?;
    /// assert_eq!(loaded.member(2), batch.member(2));
    /// # Ok::<(), postcard::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of the format, of [`new`](Self::new), of [`set_member`](Self::set_member), of
    /// [`ResetBounds::new`] and of [`Draws::new`], and [`Error::WrongLength`] for another
    /// number of members. The contents of the memory are then unspecified.
    pub fn from_snapshot<'de, D>(storage: S, deserializer: D) -> Result<Self, D::Error>
    where
        D: Deserializer<'de>,
        T: Deserialize<'de>,
    {
        let mut batch = Self::new(SeedSequence::new(0), storage).map_err(D::Error::custom)?;
        let mut index = 0;
        let settings = read(deserializer, |member| {
            index += 1;
            batch.load(index - 1, member)
        })?;
        batch.apply(settings, index).map_err(D::Error::custom)?;
        Ok(batch)
    }

    /// Replaces a member. The first brings the parameters that all acrobots share.
    fn load(&mut self, index: usize, member: Member<A, T::Memory>) -> Result<(), Error> {
        if index >= self.len() {
            return check_length("members", index + 1, self.len());
        }
        if index == 0 {
            self.set_all_params(member.params)?;
        }
        self.set_member(index, member)
    }

    fn apply(&mut self, settings: Settings<A, T>, members: usize) -> Result<(), Error> {
        check_length("members", members, self.len())?;
        self.set_task(settings.snapshot.task);
        self.set_draws(Draws::new(settings.draws)?)?;
        self.set_reset_bounds(ResetBounds::new(settings.low, settings.high)?);
        self.set_max_steps(settings.max_steps);
        self.set_autoreset(settings.autoreset);
        Ok(())
    }
}

#[cfg(feature = "alloc")]
impl<A: Arithmetic, T: Task + Serialize, const N: usize> Serialize for VecBatch<A, T, N> {
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        (**self).serialize(serializer)
    }
}

#[cfg(feature = "alloc")]
impl<'de, A: Arithmetic, T, const N: usize> Deserialize<'de> for VecBatch<A, T, N>
where
    T: Task + Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut members = alloc::vec::Vec::new();
        let settings = read(deserializer, |member| {
            let len = members.len() + 1;
            let reserved = members.try_reserve(1);
            reserved.map_err(|_| Error::OutOfMemory { of: "acrobots", len })?;
            members.push(member);
            Ok(())
        })?;
        let assemble = || {
            let len = members.len();
            let mut batch = Self::new(0, len)?;
            if settings.own_params {
                batch.own_params()?;
            }
            for (index, member) in members.into_iter().enumerate() {
                batch.load(index, member)?;
            }
            batch.apply(settings, len)?;
            Ok(batch)
        };
        assemble().map_err(|error: Error| D::Error::custom(error))
    }
}

/// Reads a snapshot: calls `each` with the members in their order, and returns the settings.
fn read<'de, A: Arithmetic, T: Task + Deserialize<'de>, D: Deserializer<'de>>(
    deserializer: D,
    each: impl FnMut(Member<A, T::Memory>) -> Result<(), Error>,
) -> Result<Settings<A, T>, D::Error> {
    struct Records<A, T, F>(F, PhantomData<(A, T)>);

    impl<'de, A: Arithmetic, T, F> Visitor<'de> for Records<A, T, F>
    where
        T: Task + Deserialize<'de>,
        F: FnMut(Member<A, T::Memory>) -> Result<(), Error>,
    {
        type Value = Settings<A, T>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("the settings of a batch and its members")
        }

        fn visit_seq<Z: SeqAccess<'de>>(
            mut self,
            mut records: Z,
        ) -> Result<Settings<A, T>, Z::Error> {
            let settings = records.next_element()?;
            let settings = settings.ok_or_else(|| Z::Error::invalid_length(0, &self))?;
            while let Some(member) = records.next_element()? {
                (self.0)(member).map_err(Z::Error::custom)?;
            }
            Ok(settings)
        }
    }

    deserializer.deserialize_seq(Records(each, PhantomData))
}
