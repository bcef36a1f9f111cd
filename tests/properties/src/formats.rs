//! Stores and loads a value in serde formats of each kind: with names or without, of text or of
//! bytes, without optional fields or 64-bit integers (TOML), and through serde's buffers.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Untagged<T> {
    One(T),
}

/// The value after a round trip through each format, with the format's name. `value` must be a
/// struct.
pub fn again<T: Serialize + DeserializeOwned>(value: &T) -> Vec<(&'static str, T)> {
    let json = serde_json::to_string(value).unwrap();
    let Untagged::One(untagged) = serde_json::from_str(&json).unwrap();
    let named = rmp_serde::to_vec_named(value).unwrap();
    vec![
        ("JSON", serde_json::from_str(&json).unwrap()),
        ("postcard", postcard::from_bytes(&postcard::to_stdvec(value).unwrap()).unwrap()),
        ("MessagePack", rmp_serde::from_slice(&rmp_serde::to_vec(value).unwrap()).unwrap()),
        ("MessagePack with names", rmp_serde::from_slice(&named).unwrap()),
        ("TOML", toml::from_str(&toml::to_string(value).unwrap()).unwrap()),
        ("an untagged enum", untagged),
    ]
}
