//! Gymnasium's task through all instruments.

use acrobot::task::{Draw, Gymnasium, Instruments, Measured};

/// Each reset draws the motor and the sensors.
pub fn measured() -> Measured<Gymnasium> {
    let uniform = |low, high| Some(Draw::Uniform { low, high });
    let instruments = Instruments {
        action_delay: uniform(0.0, 4.0),
        observation_delay: uniform(0.0, 4.0),
        motor_lag: uniform(0.01, 0.1),
        torque_error: uniform(-0.1, 0.1),
        angle_noise: uniform(0.0, 0.01),
        encoder_zero1: uniform(-0.05, 0.05),
        encoder_zero2: uniform(-0.05, 0.05),
        encoder_counts: Some(Draw::exactly(4096.0)),
        velocity_filter: uniform(0.01, 0.1),
    };
    Measured::new(Gymnasium, instruments).expect("numbers within their ranges")
}
