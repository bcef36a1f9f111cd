//! What the targets share: numbers from bytes, and the check of a state after a step.

use acrobot::arithmetic::Real;
use acrobot::physics::{Dynamics, ParamsRange};
use acrobot::{Error, Params, State};
use libfuzzer_sys::arbitrary::{Result, Unstructured};

/// Numbers at which range checks are likely to be wrong.
const EDGES: [f64; 12] = [
    0.0,
    -0.0,
    f64::from_bits(1),
    f64::MIN_POSITIVE,
    f32::MIN_POSITIVE as f64,
    f32::EPSILON as f64,
    f32::MAX as f64,
    f64::MAX,
    f64::MIN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

/// A number near the `usual` one, at an edge, or of any bits. With numbers of any bits only, few sequences would reach
/// a step.
pub fn number(u: &mut Unstructured<'_>, usual: f64) -> Result<f64> {
    Ok(match u.int_in_range(0..=7)? {
        0 => f64::from_bits(u.arbitrary()?),
        1 => f32::from_bits(u.arbitrary()?).into(),
        2 => *u.choose(&EDGES)?,
        3 | 4 => usual * f64::from(u.arbitrary::<i16>()?) / 256.0,
        _ => usual,
    })
}

/// Parameters, valid or not.
pub fn params(u: &mut Unstructured<'_>) -> Result<Params> {
    let usual = Params::DEFAULT;
    Ok(Params {
        length1: number(u, usual.length1)?,
        length2: number(u, usual.length2)?,
        mass1: number(u, usual.mass1)?,
        mass2: number(u, usual.mass2)?,
        center_of_mass1: number(u, usual.center_of_mass1)?,
        center_of_mass2: number(u, usual.center_of_mass2)?,
        inertia1: number(u, usual.inertia1)?,
        inertia2: number(u, usual.inertia2)?,
        gravity: number(u, usual.gravity)?,
        dt: number(u, usual.dt)?,
        max_velocity1: number(u, usual.max_velocity1)?,
        max_velocity2: number(u, usual.max_velocity2)?,
        torques: [number(u, -1.0)?, number(u, 0.0)?, number(u, 1.0)?],
        torque_noise: number(u, usual.torque_noise)?,
        dynamics: *u.choose(&[Dynamics::Book, Dynamics::Nips])?,
    })
}

/// A range of parameters, or why it is rejected. With any two ends most would be.
pub fn params_range<S: Real>(
    u: &mut Unstructured<'_>,
) -> Result<std::result::Result<ParamsRange<S>, Error>> {
    let low = params(u)?;
    let mut high = low;
    let fields = [
        &mut high.length1,
        &mut high.mass2,
        &mut high.gravity,
        &mut high.dt,
        &mut high.max_velocity2,
        &mut high.torques[2],
        &mut high.torque_noise,
    ];
    for field in fields {
        *field += number(u, 0.25)?;
    }
    Ok(ParamsRange::new(low.cast(), high.cast()))
}

/// A state, finite or not.
pub fn state(u: &mut Unstructured<'_>) -> Result<State> {
    let numbers = [
        number(u, 3.0)?,
        number(u, 1.0)?,
        number(u, 6.0)?,
        number(u, 9.0)?,
    ];
    Ok(numbers.into())
}

/// Angles and velocities are within their bounds, so none is NaN.
pub fn assert_settled<S: Real>(state: State<S>, params: &Params<S>) {
    let limits = [S::PI, S::PI, params.max_velocity1, params.max_velocity2];
    for (x, limit) in <[S; 4]>::from(state).into_iter().zip(limits) {
        assert!(-limit <= x && x <= limit, "{state:?}");
    }
}
