//! Promise 3, no panic, no hang and no NaN, for any input: properties of all public functions in
//! every arithmetic. `PROPTEST_CASES=60000 PROPTEST_RNG_SEED=7 cargo test --release -p properties`
//! tries more and other cases.

#![cfg(test)]

mod batches;
mod control;
mod draws;
mod formats;
mod given;
mod pictures;
mod snapshots;
mod steps;
mod values;
