//! Promise 2 for batches: acrobot `i` is bit-identical to an `Acrobot` seeded with the seed's
//! `i`-th child, with shared parameters and with its own. `cargo test -p properties` tries calls in
//! any order.

mod linearize;
mod slices;
mod snapshots;
mod steps;
mod vec_batch;
