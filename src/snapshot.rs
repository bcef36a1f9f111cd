//! The header of a snapshot: type, version, task and arithmetic. What a task remembers.

use core::fmt;
use core::marker::PhantomData;

use heapless::String;
use serde::de::{Deserialize, Deserializer, Error};
use serde::ser::{Serialize, Serializer};

use crate::arithmetic::Arithmetic;
use crate::task::{NAME_LIMIT, Task};

/// Incremented whenever the fields of any snapshot change.
const VERSION: u32 = 6;

/// The first field of a snapshot of an acrobot or a batch.
pub(crate) struct Header<A, T, const BATCH: bool> {
    pub(crate) task: T,
    arithmetic: PhantomData<A>,
}

#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "Header")]
struct Fields<Text, T> {
    of: Text,
    version: u32,
    task: Text,
    arithmetic: Text,
    /// The task's data; none of the crate's tasks has any.
    data: T,
}

impl<Text: fmt::Debug, T> fmt::Display for Fields<Text, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { of, version, task, arithmetic, .. } = self;
        write!(f, "{of:?}, version {version}, task {task:?}, arithmetic {arithmetic:?}")
    }
}

impl<A: Arithmetic, T: Task, const BATCH: bool> Header<A, T, BATCH> {
    /// The largest size in postcard's format, bytes: three texts, a byte for each length, the
    /// version, and the task's data, whose numbers may take a byte for 7 bits.
    pub(crate) const SIZE: usize =
        4 + Self::OF.len() + T::NAME.len() + A::NAME.len() + 2 * size_of::<T>();

    const OF: &str = {
        assert!(A::NAME.len() <= NAME_LIMIT, "an arithmetic's NAME must have at most 16 bytes");
        assert!(T::NAME.len() <= NAME_LIMIT, "a task's NAME must have at most 16 bytes");
        if BATCH { "batch" } else { "acrobot" }
    };

    pub(crate) fn of(task: T) -> Self {
        Self { task, arithmetic: PhantomData }
    }

    fn fields(&self) -> Fields<&'static str, T> {
        let (of, task, arithmetic) = (Self::OF, self.task.name(), A::NAME);
        Fields { of, version: VERSION, task, arithmetic, data: self.task }
    }
}

impl<A: Arithmetic, T: Task + Serialize, const BATCH: bool> Serialize for Header<A, T, BATCH> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.fields().serialize(serializer)
    }
}

impl<'de, A: Arithmetic, T, const BATCH: bool> Deserialize<'de> for Header<A, T, BATCH>
where
    T: Task + Deserialize<'de>,
{
    /// Rejects any other header.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let found: Fields<String<NAME_LIMIT>, T> =
            Fields::deserialize(deserializer).map_err(|error| {
                D::Error::custom(format_args!(
                    "{error}; the input must be a snapshot of version {VERSION}"
                ))
            })?;
        let rule = Self::of(T::DEFAULT).fields();
        let named = found.data.named(&found.task);
        let is_same = found.of == rule.of && found.arithmetic == rule.arithmetic;
        if let Some(task) = named.filter(|_| is_same && found.version == VERSION) {
            return Ok(Self::of(task));
        }
        let text = format_args!("the snapshot must be {rule}, got {found}");
        Err(D::Error::custom(text))
    }
}

/// What a task remembers, as a tuple of numbers.
pub(crate) mod numbers {
    use core::fmt;
    use core::marker::PhantomData;

    use serde::de::{Deserializer, Error, SeqAccess, Visitor};
    use serde::ser::{SerializeTuple, Serializer};

    use crate::math::{Real, Zeros};
    use crate::task::Memory;

    /// Tasks that remember nothing have no field for it in formats with names.
    pub(crate) fn is_empty<S: Real, M: Memory>(_: &M::Of<S>) -> bool {
        M::LEN == 0
    }

    /// Numbers that no task accepts.
    pub(crate) fn missing<S: Real, M: Memory>() -> M::Of<S> {
        let mut memory = Zeros::ZEROS;
        M::zip(&{ memory }, &mut memory, &mut |_: S, to: &mut S| *to = S::from_f64(f64::NAN));
        memory
    }

    pub(crate) fn serialize<S: Real, M: Memory, Z: Serializer>(
        memory: &M::Of<S>,
        serializer: Z,
    ) -> Result<Z::Ok, Z::Error> {
        let mut tuple = serializer.serialize_tuple(M::LEN)?;
        let mut result = Ok(());
        M::zip(memory, &mut { *memory }, &mut |x: S, _: &mut S| {
            if result.is_ok() {
                result = tuple.serialize_element(&x);
            }
        });
        result?;
        tuple.end()
    }

    pub(crate) fn deserialize<'de, S: Real, M: Memory, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<M::Of<S>, D::Error> {
        struct Tuple<S, M>(PhantomData<(S, M)>);

        impl<'de, S: Real, M: Memory> Visitor<'de> for Tuple<S, M> {
            type Value = M::Of<S>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "the {} numbers that the task remembers", M::LEN)
            }

            fn visit_seq<Z: SeqAccess<'de>>(self, mut tuple: Z) -> Result<M::Of<S>, Z::Error> {
                let mut memory = Zeros::ZEROS;
                let mut result = Ok(());
                let mut len = 0;
                M::zip(&{ memory }, &mut memory, &mut |_: S, to: &mut S| {
                    if result.is_ok() {
                        let number = tuple.next_element();
                        let missing = || Z::Error::invalid_length(len, &self);
                        result = number.and_then(|x| x.ok_or_else(missing)).map(|x| *to = x);
                        len += 1;
                    }
                });
                result.map(|()| memory)
            }
        }

        deserializer.deserialize_tuple(M::LEN, Tuple::<S, M>(PhantomData))
    }
}
