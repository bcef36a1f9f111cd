//! The header of a snapshot: type, version, task and arithmetic.

use core::fmt;
use core::marker::PhantomData;

use heapless::String;
use serde::de::{Deserialize, Deserializer, Error};
use serde::ser::{Serialize, Serializer};

use crate::arithmetic::Arithmetic;
use crate::task::Task;

/// Incremented whenever the fields of any snapshot change.
const VERSION: u32 = 6;

/// The longest text in a header, bytes. Saving an acrobot with a longer name does not compile.
const LIMIT: usize = 16;

/// The first field of a snapshot of an acrobot or a batch. Zero-sized: its contents are constants,
/// checked when loaded.
pub(crate) struct Header<A, T, const BATCH: bool>(PhantomData<(A, T)>);

#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "Header")]
struct Fields<Text> {
    of: Text,
    version: u32,
    task: Text,
    arithmetic: Text,
}

impl<Text: fmt::Debug> fmt::Display for Fields<Text> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { of, version, task, arithmetic } = self;
        write!(f, "{of:?}, version {version}, task {task:?}, arithmetic {arithmetic:?}")
    }
}

impl<A: Arithmetic, T: Task, const BATCH: bool> Header<A, T, BATCH> {
    pub(crate) const NEW: Self = Self(PhantomData);

    /// The size in postcard's format, bytes: three texts, a byte for each length, and the version.
    pub(crate) const SIZE: usize = 4 + Self::FIELDS.of.len() + T::NAME.len() + A::NAME.len();

    const FIELDS: Fields<&'static str> = {
        assert!(A::NAME.len() <= LIMIT, "an arithmetic's NAME must have at most 16 bytes");
        assert!(T::NAME.len() <= LIMIT, "a task's NAME must have at most 16 bytes");
        assert!(size_of::<T>() == 0, "a snapshot does not hold the data of a task");
        Fields {
            of: if BATCH { "batch" } else { "acrobot" },
            version: VERSION,
            task: T::NAME,
            arithmetic: A::NAME,
        }
    };
}

impl<A: Arithmetic, T: Task, const BATCH: bool> Serialize for Header<A, T, BATCH> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Self::FIELDS.serialize(serializer)
    }
}

impl<'de, A: Arithmetic, T: Task, const BATCH: bool> Deserialize<'de> for Header<A, T, BATCH> {
    /// Rejects any other header.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let found: Fields<String<LIMIT>> = Fields::deserialize(deserializer).map_err(|error| {
            D::Error::custom(format_args!(
                "{error}; the input must be a snapshot of version {VERSION}"
            ))
        })?;
        let rule = Self::FIELDS;
        let same_names = found.task == T::NAME && found.arithmetic == A::NAME;
        if found.of == rule.of && same_names && found.version == VERSION {
            return Ok(Self::NEW);
        }
        let text = format_args!("the snapshot must be {rule}, got {found}");
        Err(D::Error::custom(text))
    }
}
