//! Makes environments from their ids.

use super::AcrobotEnv;
use super::error::Error;
use super::rendering::RenderMode;
use crate::acrobot::Acrobot;
use crate::arithmetic::{Arithmetic, Host};
use crate::physics::Params;
use crate::task::{Gymnasium, GymnasiumV0, Task};
use crate::time_limit::TimeLimit;

/// Gymnasium's `make(id)`: `"Acrobot-v1"` or `"Acrobot-v0"`, with seed 0 and Gymnasium's bits.
///
/// # Errors
///
/// [`Error::UnknownId`] for another id.
pub fn make(id: &str) -> Result<TimeLimit<AcrobotEnv>, Error> {
    make_with::<Host>(id, Params::DEFAULT, RenderMode::None)
}

/// [`make`] in any arithmetic, with other parameters, or with pictures: [an
/// example](crate::guide::rust#spaces-wrappers-rendering).
///
/// # Errors
///
/// [`Error::UnknownId`] for another id, and [`Error::Invalid`] with the errors of
/// [`AcrobotEnv::set_params`].
pub fn make_with<A: Arithmetic>(
    id: &str,
    params: Params,
    render_mode: RenderMode,
) -> Result<TimeLimit<AcrobotEnv>, Error> {
    match id {
        "Acrobot-v0" => limited::<A, GymnasiumV0>(params, render_mode),
        "Acrobot-v1" => limited::<A, Gymnasium>(params, render_mode),
        _ => Err(Error::UnknownId(id.into())),
    }
}

fn limited<A: Arithmetic, T: Task>(
    params: Params,
    render_mode: RenderMode,
) -> Result<TimeLimit<AcrobotEnv>, Error> {
    let mut env = AcrobotEnv::new(Acrobot::<A, T>::new(0), render_mode);
    env.set_params(params)?;
    Ok(TimeLimit::new(env, T::MAX_STEPS))
}
