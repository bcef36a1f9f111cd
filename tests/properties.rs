//! Promise 3, no panic, no hang and no NaN, for any input: properties of all public functions in every arithmetic.
//! `PROPTEST_CASES=60000 PROPTEST_RNG_SEED=7 cargo test --release --test properties` tries more and other cases.

mod common;
#[path = "common/formats.rs"]
mod formats;
#[path = "properties/given.rs"]
#[macro_use]
mod given;

#[path = "properties/draws.rs"]
mod draws;
#[path = "properties/environments.rs"]
mod environments;
#[path = "properties/pictures.rs"]
mod pictures;
#[path = "properties/snapshots.rs"]
mod snapshots;
#[path = "properties/steps.rs"]
mod steps;
#[path = "properties/values.rs"]
mod values;
