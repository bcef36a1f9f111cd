//! A whole batch, saved and loaded with serde.

use core::fmt;
use core::marker::PhantomData;
use core::num::NonZeroU32;

use heapless::Vec;
use serde::de::{Deserialize, DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess};
use serde::de::{Error as _, Visitor};
use serde::ser::{Serialize, SerializeSeq, Serializer};

use super::buffers::check_length;
#[cfg(feature = "alloc")]
use super::vec_batch::VecBatch;
use super::{Autoreset, Batch, Member, Storage};
use crate::arithmetic::Arithmetic;
use crate::error::Error;
#[cfg(feature = "alloc")]
use crate::numpy::SeedSequence;
use crate::physics::{Params, ParamsRange, ResetBounds};
use crate::snapshot::{Header, Subject};

impl<A: Arithmetic, S, const N: usize> Subject for Batch<A, S, N> {
    const NAME: &'static str = "batch";
    type Arithmetic = A;
}

#[derive(serde::Serialize)]
#[serde(rename = "Batch")]
struct Snapshot<H, T, M> {
    snapshot: H,
    settings: T,
    members: M,
}

#[derive(serde::Deserialize)]
#[serde(field_identifier, rename_all = "snake_case")]
enum Field {
    Snapshot,
    Settings,
    Members,
    #[serde(other)]
    Other,
}

/// The settings. The parameters that all acrobots share are those of each member.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "Settings")]
struct Settings<S> {
    low: f64,
    high: f64,
    limit: NonZeroU32,
    autoreset: Autoreset,
    /// Whether each acrobot has its own parameters.
    own_params: bool,
    /// Both ends of the range, or nothing.
    params_range: Vec<Params<S>, 2>,
}

/// The members of a batch, saved one by one.
struct Members<'a, T>(&'a T);

impl<A, S, const N: usize> Serialize for Members<'_, Batch<A, S, N>>
where
    A: Arithmetic<Scalar: Serialize>,
    S: Storage<A, N>,
{
    fn serialize<T: Serializer>(&self, serializer: T) -> Result<T::Ok, T::Error> {
        let mut members = serializer.serialize_seq(Some(self.0.len()))?;
        for member in (0..self.0.len()).filter_map(|index| self.0.member(index)) {
            members.serialize_element(&member)?;
        }
        members.end()
    }
}

impl<A, S, const N: usize> Serialize for Batch<A, S, N>
where
    A: Arithmetic<Scalar: Serialize>,
    S: Storage<A, N>,
{
    fn serialize<T: Serializer>(&self, serializer: T) -> Result<T::Ok, T::Error> {
        let (.., lane_params) = self.storage.slices();
        let range = self
            .params_range()
            .map(|range| [*range.low(), *range.high()]);
        let settings = Settings {
            low: self.settings.bounds.low(),
            high: self.settings.bounds.high(),
            limit: self.settings.limit,
            autoreset: self.settings.autoreset,
            own_params: !lane_params.is_empty(),
            params_range: range.map(Vec::from_array).unwrap_or_default(),
        };
        Snapshot {
            snapshot: Header::<Self>::NEW,
            settings,
            members: Members(self),
        }
        .serialize(serializer)
    }
}

impl<A: Arithmetic, S: Storage<A, N>, const N: usize> Batch<A, S, N> {
    /// Loads a [snapshot](Self#snapshots) of a batch into memory for as many acrobots.
    ///
    /// # Errors
    ///
    /// Those of the format, of [`new`](Self::new) and of [`set_member`](Self::set_member), [`Error::WrongLength`] for
    /// another number of members, and those of [`ResetBounds::new`] and [`ParamsRange::new`]. The memory then has any
    /// contents.
    pub fn from_snapshot<'de, D>(storage: S, deserializer: D) -> Result<Self, D::Error>
    where
        D: Deserializer<'de>,
        A::Scalar: Deserialize<'de>,
    {
        let mut batch = Self::new(0, storage).map_err(D::Error::custom)?;
        let mut index = 0;
        let settings = read(deserializer, |member| {
            batch.load(index, member)?;
            index += 1;
            Ok(())
        })?;
        batch.apply(settings, index).map_err(D::Error::custom)?;
        Ok(batch)
    }

    /// Replaces a member. The first brings the parameters that all acrobots share.
    fn load(&mut self, index: usize, member: Member<A>) -> Result<(), Error> {
        if index >= self.len() {
            return check_length("members", index + 1, self.len());
        }
        if index == 0 {
            self.set_params(member.params)?;
        }
        self.set_member(index, member)
    }

    fn apply(&mut self, settings: Settings<A::Scalar>, members: usize) -> Result<(), Error> {
        check_length("members", members, self.len())?;
        if let [low, high] = *settings.params_range {
            self.set_params_range(Some(ParamsRange::new(low, high)?))?;
        }
        self.set_reset_bounds(ResetBounds::new(settings.low, settings.high)?);
        self.set_limit(settings.limit);
        self.set_autoreset(settings.autoreset);
        Ok(())
    }
}

#[cfg(feature = "alloc")]
impl<A: Arithmetic<Scalar: Serialize>, const N: usize> Serialize for VecBatch<A, N> {
    fn serialize<T: Serializer>(&self, serializer: T) -> Result<T::Ok, T::Error> {
        (**self).serialize(serializer)
    }
}

#[cfg(feature = "alloc")]
impl<'de, A, const N: usize> Deserialize<'de> for VecBatch<A, N>
where
    A: Arithmetic<Scalar: Deserialize<'de>>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut members = alloc::vec::Vec::new();
        let settings = read(deserializer, |member| {
            let len = members.len() + 1;
            let reserved = members.try_reserve(1);
            reserved.map_err(|_| Error::OutOfMemory { len })?;
            members.push(member);
            Ok(())
        })?;
        let load = || {
            let len = members.len();
            let lane_params = if settings.own_params {
                len.div_ceil(N)
            } else {
                0
            };
            let mut batch = Self::allocate(SeedSequence::new(0), len, lane_params)?;
            for (index, member) in members.into_iter().enumerate() {
                batch.load(index, member)?;
            }
            batch.apply(settings, len)?;
            Ok(batch)
        };
        load().map_err(|error: Error| D::Error::custom(error))
    }
}

/// Reads a snapshot: calls `each` with the members in their order, and returns the settings.
fn read<'de, A, D>(
    deserializer: D,
    each: impl FnMut(Member<A>) -> Result<(), Error>,
) -> Result<Settings<A::Scalar>, D::Error>
where
    A: Arithmetic<Scalar: Deserialize<'de>>,
    D: Deserializer<'de>,
{
    let fields = &["snapshot", "settings", "members"];
    deserializer.deserialize_struct("Batch", fields, Reader(each, PhantomData))
}

struct Reader<A, F>(F, PhantomData<A>);

impl<'de, A, F> Visitor<'de> for Reader<A, F>
where
    A: Arithmetic<Scalar: Deserialize<'de>>,
    F: FnMut(Member<A>) -> Result<(), Error>,
{
    type Value = Settings<A::Scalar>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a snapshot of a batch")
    }

    /// Formats without names, such as postcard.
    fn visit_seq<T: SeqAccess<'de>>(mut self, mut fields: T) -> Result<Self::Value, T::Error> {
        let header = fields.next_element::<Header<Batch<A, (), 1>>>()?;
        header.ok_or_else(|| T::Error::missing_field("snapshot"))?;
        let settings = fields.next_element()?;
        let members = fields.next_element_seed(Each(&mut self))?;
        members.ok_or_else(|| T::Error::missing_field("members"))?;
        settings.ok_or_else(|| T::Error::missing_field("settings"))
    }

    /// Formats with names. Some sort them.
    fn visit_map<T: MapAccess<'de>>(mut self, mut fields: T) -> Result<Self::Value, T::Error> {
        let (mut header, mut settings, mut members) = (None, None, None);
        while let Some(field) = fields.next_key()? {
            match field {
                Field::Snapshot => header = Some(fields.next_value::<Header<Batch<A, (), 1>>>()?),
                Field::Settings => settings = Some(fields.next_value()?),
                Field::Members => members = Some(fields.next_value_seed(Each(&mut self))?),
                Field::Other => _ = fields.next_value::<IgnoredAny>()?,
            }
        }
        header.ok_or_else(|| T::Error::missing_field("snapshot"))?;
        members.ok_or_else(|| T::Error::missing_field("members"))?;
        settings.ok_or_else(|| T::Error::missing_field("settings"))
    }
}

/// Passes each member on.
struct Each<'a, T>(&'a mut T);

impl<'de, A, F> DeserializeSeed<'de> for Each<'_, Reader<A, F>>
where
    A: Arithmetic<Scalar: Deserialize<'de>>,
    F: FnMut(Member<A>) -> Result<(), Error>,
{
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_seq(self)
    }
}

impl<'de, A, F> Visitor<'de> for Each<'_, Reader<A, F>>
where
    A: Arithmetic<Scalar: Deserialize<'de>>,
    F: FnMut(Member<A>) -> Result<(), Error>,
{
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("members of a batch")
    }

    fn visit_seq<T: SeqAccess<'de>>(self, mut members: T) -> Result<(), T::Error> {
        while let Some(member) = members.next_element()? {
            (self.0.0)(member).map_err(T::Error::custom)?;
        }
        Ok(())
    }
}
