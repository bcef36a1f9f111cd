//! The header of a snapshot: what it is of, its version and its scalar, so that none is misread.

use core::marker::PhantomData;

use heapless::String;
use serde::de::{Deserialize, Deserializer, Error};
use serde::ser::{Serialize, Serializer};

use crate::arithmetic::Real;
use crate::arithmetic::sealed::Sealed;

/// It moves on whenever the fields of any snapshot change.
const VERSION: u32 = 1;

/// What a snapshot can be of.
pub(crate) trait Subject {
    const NAME: &'static str;
    type Scalar: Real;
}

/// The first field of a snapshot of a `T`. It holds nothing, for all that it says is known where it is
/// read; a binary format has no other way to tell one snapshot from another.
///
/// The name comes first, in letters: bytes that begin otherwise are no snapshot.
pub(crate) struct Header<T>(PhantomData<T>);

impl<T> Header<T> {
    pub(crate) const NEW: Self = Self(PhantomData);
}

#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "Header")]
struct Fields<Text> {
    of: Text,
    version: u32,
    scalar: Text,
}

impl<T: Subject> Serialize for Header<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Fields {
            of: T::NAME,
            version: VERSION,
            scalar: T::Scalar::NAME,
        }
        .serialize(serializer)
    }
}

impl<'de, T: Subject> Deserialize<'de> for Header<T> {
    /// Refuses all but its own.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        // Also where there is none: of what was stored before there were versions.
        let Fields {
            of,
            version,
            scalar,
        }: Fields<String<16>> = Fields::deserialize(deserializer).map_err(|error| {
            D::Error::custom(format_args!(
                "{error}; allowed is a snapshot of version {VERSION}"
            ))
        })?;
        if (&*of, version, &*scalar) == (T::NAME, VERSION, T::Scalar::NAME) {
            return Ok(Self::NEW);
        }
        Err(D::Error::custom(format_args!(
            "the snapshot is of {of:?}, version {version}, in {scalar}; \
             allowed is {:?}, version {VERSION}, in {}",
            T::NAME,
            T::Scalar::NAME
        )))
    }
}
