//! Promise 2 for batches of other widths: below, at and above that of a vector.

use acrobot::arithmetic::Micro;
use acrobot::{Fast, Portable};
use bits::episodes;
use common::twins::Twins;

#[test]
fn any_width_equals_single_acrobots() {
    Twins::<Fast, 1>::at_every_level();
    Twins::<Fast, 4>::at_every_level();
    Twins::<Fast, 7>::at_every_level();
    Twins::<Fast, 8>::at_every_level();
    Twins::<Fast, 32>::at_every_level();
    Twins::<Micro, 7>::at_every_level();
    Twins::<Portable, 4>::at_every_level();
}

#[test]
fn batches_are_stable_in_every_width() {
    let shared = [
        episodes::shared_params::<1, 20>(),
        episodes::shared_params::<4, 5>(),
    ];
    assert_eq!(shared, [episodes::SHARED_PARAMS; 2]);
    let subnormal = [
        episodes::subnormal_batch::<1, 20>(),
        episodes::subnormal_batch::<4, 5>(),
    ];
    assert_eq!(subnormal, [episodes::SUBNORMAL_BATCH; 2]);
    let own = [
        episodes::own_params::<1, 8>(),
        episodes::own_params::<4, 2>(),
    ];
    assert_eq!(own, [episodes::OWN_PARAMS; 2]);
}
