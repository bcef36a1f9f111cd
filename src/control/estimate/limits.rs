//! Parameters that a correction has moved out of their limits.

use super::estimator::{KalmanFilter, within};
use super::parameter_std::PARAMETERS;
use crate::arithmetic::Arithmetic;
use crate::math::Real;
use crate::math::matrix::add_scaled;

impl<A: Arithmetic, const K: usize> KalmanFilter<A, K> {
    /// Moves parameters into their limits, and what they vary with as the covariances say. Without
    /// that a friction that is 0 would make masses and zeros wander.
    pub(super) fn bound(&self, y: &mut [A::Scalar; 4], mut values: [&mut A::Scalar; PARAMETERS]) {
        let mut is_bound = false;
        for (i, own) in self.parameters.iter().enumerate() {
            let (Some(value), Some(variance)) = (values.get(i), own.with_params.get(i)) else {
                break;
            };
            let excess = within(**value, own.limits) - **value;
            let variance = own.deviation * *variance;
            is_bound |= excess != A::Scalar::ZERO;
            if excess != A::Scalar::ZERO && variance > A::Scalar::ZERO {
                let part = excess / variance;
                add_scaled(y, part, &own.with_state);
                let others = self.parameters.iter().zip(own.with_params);
                for (value, (other, covariance)) in values.iter_mut().zip(others) {
                    **value = **value + part * (other.deviation * covariance);
                }
            }
        }
        if is_bound {
            // A later one may have moved an earlier one.
            for (value, own) in values.into_iter().zip(&self.parameters) {
                *value = within(*value, own.limits);
            }
        }
    }
}
