//! What a step applies: actions or torques, one for each acrobot.

use super::buffers::{check_length, take};
use crate::action::Action;
use crate::error::Error;
use crate::math::{Lanes, Real};
use crate::physics::check_torque;

/// What a step of a batch applies to an acrobot: an action as a `u8` (0, 1 or 2) or an [`Action`],
/// or any finite torque in N m, as the scalar of the arithmetic. No other type can implement it.
///
/// ```
/// use acrobot::{Action, batch::Input};
///
/// fn count<I: Input<f32>>(inputs: &[I]) -> usize {
///     inputs.len()
/// }
/// assert_eq!([count(&[0_u8, 2]), count(&[Action::Zero]), count(&[0.5, -0.5])], [2, 1, 2]);
/// ```
pub trait Input<S>: Copy + Sync {
    #[doc(hidden)]
    fn inputs(inputs: &[Self]) -> Inputs<'_, S>;
}

impl<S: Real> Input<S> for u8 {
    fn inputs(inputs: &[Self]) -> Inputs<'_, S> {
        Inputs::Numbers(inputs)
    }
}

impl<S: Real> Input<S> for Action {
    fn inputs(inputs: &[Self]) -> Inputs<'_, S> {
        Inputs::Actions(inputs)
    }
}

impl<S: Real> Input<S> for S {
    fn inputs(inputs: &[Self]) -> Inputs<'_, S> {
        Inputs::Torques(inputs)
    }
}

/// The inputs of several acrobots. Their kind is a value, so that a step is compiled once. No path
/// outside of the crate names it, which seals [`Input`].
#[derive(Clone, Copy, Debug)]
pub enum Inputs<'a, S> {
    Numbers(&'a [u8]),
    Actions(&'a [Action]),
    Torques(&'a [S]),
}

impl<S: Real> Inputs<'_, S> {
    /// Splits off the inputs of the first `n` acrobots, or of all if there are fewer.
    #[inline(always)]
    pub(super) fn take(&mut self, n: usize) -> Self {
        match self {
            Self::Numbers(numbers) => Self::Numbers(take(numbers, n)),
            Self::Actions(actions) => Self::Actions(take(actions, n)),
            Self::Torques(torques) => Self::Torques(take(torques, n)),
        }
    }

    /// Rejects a wrong number of inputs, unknown actions, and torques that are not finite.
    pub(super) fn check(&self, expected: usize) -> Result<(), Error> {
        match self {
            Self::Numbers(numbers) => {
                check_length("actions", numbers.len(), expected)?;
                match numbers.iter().copied().fold(0, u8::max) {
                    0..=2 => Ok(()),
                    highest => Err(Error::UnknownAction(highest)),
                }
            }
            Self::Actions(actions) => check_length("actions", actions.len(), expected),
            Self::Torques(torques) => {
                check_length("torques", torques.len(), expected)?;
                torques.iter().try_for_each(|torque| check_torque(*torque))
            }
        }
    }

    /// The torques of one block, N m, given those of the three actions. Lanes without an acrobot
    /// get a valid torque.
    #[inline(always)]
    pub(super) fn torques<const N: usize>(self, of_actions: &[Lanes<S, N>; 3]) -> Lanes<S, N> {
        match self {
            Self::Numbers(numbers) => choose(of_actions, read(numbers, 1, |number| number)),
            Self::Actions(actions) => choose(of_actions, read(actions, 1, u8::from)),
            Self::Torques(torques) => Lanes(read(torques, S::ZERO, |torque| torque)),
        }
    }
}

/// The torque of each lane's action.
#[inline(always)]
fn choose<S: Real, const N: usize>(
    [negative, zero, positive]: &[Lanes<S, N>; 3],
    actions: [u8; N],
) -> Lanes<S, N> {
    let mut torques = *negative;
    let others = zero.0.iter().zip(&positive.0).zip(actions);
    for (torque, ((zero, positive), action)) in torques.0.iter_mut().zip(others) {
        *torque = S::select([*torque, *zero, *positive], action);
    }
    torques
}

/// Converts a block's inputs. The last block may have fewer than `N`; its other lanes get `rest`.
#[inline(always)]
fn read<T: Copy, U: Copy, const N: usize>(
    from: &[T],
    rest: U,
    convert: impl Fn(T) -> U + Copy,
) -> [U; N] {
    let mut to = [rest; N];
    match <&[T; N]>::try_from(from) {
        Ok(from) => to.iter_mut().zip(from).for_each(|(to, &x)| *to = convert(x)),
        Err(_) => read_partial(&mut to, from, convert),
    }
    to
}

/// Out of line: with a constant number of inputs LLVM needs no call of `memcpy`.
#[cold]
#[inline(never)]
fn read_partial<T: Copy, U>(to: &mut [U], from: &[T], convert: impl Fn(T) -> U) {
    to.iter_mut().zip(from).for_each(|(to, &x)| *to = convert(x));
}
