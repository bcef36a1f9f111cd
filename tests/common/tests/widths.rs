//! Promise 2 for batches of other widths: below, at and above that of a vector.

use acrobot::arithmetic::Micro;
use acrobot::{Fast, Portable};
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
