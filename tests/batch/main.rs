//! Promise 2 for batches: acrobot `i` is bit-identical to an `Acrobot` seeded with the seed's `i`-th child, with shared
//! parameters and with its own.

mod bits;
mod params;
mod resets;
mod twins;
