//! The header of a snapshot: type, version and scalar.

use core::marker::PhantomData;

use heapless::String;
use serde::de::{Deserialize, Deserializer, Error};
use serde::ser::{Serialize, Serializer};

use crate::arithmetic::Real;

/// Incremented whenever the fields of any snapshot change.
const VERSION: u32 = 1;

/// A type that has snapshots.
pub(crate) trait Subject {
    const NAME: &'static str;
    type Scalar: Real;
}

/// The scalar's name in Rust.
fn name<S: Real>() -> &'static str {
    S::NAME
}

/// The first field of a snapshot of a `T`. Zero-sized: its contents are constants, checked when loaded. Binary
/// formats have no other way to tell one snapshot from another, and other bytes do not begin with the name.
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
            scalar: name::<T::Scalar>(),
        }
        .serialize(serializer)
    }
}

impl<'de, T: Subject> Deserialize<'de> for Header<T> {
    /// Rejects any other header.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Fields {
            of,
            version,
            scalar,
        }: Fields<String<16>> = Fields::deserialize(deserializer).map_err(|error| {
            D::Error::custom(format_args!(
                "{error}; must be a snapshot of version {VERSION}"
            ))
        })?;
        if (&*of, version, &*scalar) == (T::NAME, VERSION, name::<T::Scalar>()) {
            return Ok(Self::NEW);
        }
        Err(D::Error::custom(format_args!(
            "the snapshot must be {:?}, version {VERSION}, {}, got {of:?}, version {version}, {scalar}",
            T::NAME,
            name::<T::Scalar>()
        )))
    }
}
