//! Stores and loads a value in serde formats of each kind: with names or without, of text or of
//! bytes, without optional fields or 64-bit integers (TOML), and through serde's buffers.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
pub struct Flattened<T> {
    pub name: String,
    #[serde(flatten)]
    pub value: T,
}

#[derive(Serialize, Deserialize)]
#[serde(tag = "type")]
enum Tagged<T> {
    One(T),
}

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Untagged<T> {
    One(T),
}

/// The value after a round trip through each format, with the format's name. `value` must be a
/// struct.
pub fn again<T: Serialize + DeserializeOwned>(value: &T) -> Vec<(&'static str, T)> {
    let flattened = Flattened { name: "a".into(), value };
    let json = |text: String| serde_json::from_str(&text).unwrap();
    let mut cbor = Vec::new();
    ciborium::into_writer(value, &mut cbor).unwrap();
    let named = rmp_serde::to_vec_named(value).unwrap();
    let tagged = serde_json::to_string(&Tagged::One(value)).unwrap();
    let untagged = serde_json::to_string(&Untagged::One(value)).unwrap();
    let flattened_toml = toml::to_string(&flattened).unwrap();
    let flat_toml: Flattened<T> = toml::from_str(&flattened_toml).unwrap();
    let Tagged::One(tagged) = serde_json::from_str::<Tagged<T>>(&tagged).unwrap();
    let Untagged::One(untagged) = serde_json::from_str::<Untagged<T>>(&untagged).unwrap();
    vec![
        ("JSON", json(serde_json::to_string(value).unwrap())),
        ("postcard", postcard::from_bytes(&postcard::to_stdvec(value).unwrap()).unwrap()),
        ("CBOR", ciborium::from_reader(&cbor[..]).unwrap()),
        ("MessagePack", rmp_serde::from_slice(&rmp_serde::to_vec(value).unwrap()).unwrap()),
        ("MessagePack with names", rmp_serde::from_slice(&named).unwrap()),
        ("TOML", toml::from_str(&toml::to_string(value).unwrap()).unwrap()),
        ("flattened TOML", flat_toml.value),
        ("a tagged enum", tagged),
        ("an untagged enum", untagged),
    ]
}
