//! Linear-quadratic regulators, with an unlimited torque and with a motor's.

mod bounded;
mod dlqe;
mod dlqr;
mod double;
mod equilibrium;
mod feedback;
mod lqr;
mod region;
mod riccati;
mod tvlqr;

pub use bounded::BoundedRegulator;
pub(super) use bounded::{is_below, is_near, step};
pub use dlqe::{Lqe, dlqe};
pub(super) use dlqr::check_weights;
pub use dlqr::{Lqr, dlqr};
pub use feedback::Feedback;
pub use lqr::lqr;
pub use region::Region;
pub(super) use tvlqr::back_up;
pub use tvlqr::tvlqr;
