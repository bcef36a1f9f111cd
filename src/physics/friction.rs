//! Friction of the joints, chosen by type: a form without it stores nothing and computes nothing for it.

use core::fmt;

use crate::math::{Numbers, Real, sealed};

/// No friction: the default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Frictionless;

/// Viscous friction: each joint resists its velocity with a torque in proportion to it.
///
/// A form of the equations has it as its type parameter. `Damped<Fast>` is [`Fast`](crate::Fast) with such a form:
///
/// ```
/// use acrobot::arithmetic::Damped;
/// use acrobot::physics::{Pendulum, Viscous};
/// use acrobot::{Fast, Params, State};
///
/// let params = Params::DEFAULT.with_friction(Viscous { joint1: 0.05, joint2: 0.05 });
/// let mut pendulum = Pendulum::<Damped<Fast>>::new(params, State::from([1.0, 0.0, 0.0, 0.0]))?;
/// let energy = pendulum.energy();
/// for _ in 0..100 {
///     pendulum.step(0.0)?;
/// }
/// assert!(pendulum.energy() < energy);
/// # Ok::<(), acrobot::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Viscous<V> {
    /// Of the fixed joint, which resists θ̇1: N m s/rad; 0 or more.
    pub joint1: V,
    /// Of the elbow, which resists θ̇2: N m s/rad; 0 or more.
    pub joint2: V,
}

mod private {
    pub trait Sealed {}
    impl Sealed for super::Frictionless {}
    impl<V> Sealed for super::Viscous<V> {}
}

/// The friction of a form of the equations: [`Frictionless`] or [`Viscous`]. No other type can implement it.
pub trait Friction<S: Real>:
    private::Sealed
    + Copy
    + fmt::Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + sealed::Serde
    + sealed::Format
    + 'static
{
    /// The same for one acrobot or for many.
    type Of<V: Numbers<S>>: Copy + fmt::Debug + Send + Sync;

    /// No friction.
    #[doc(hidden)]
    const ZERO: Self;

    /// The coefficients of both joints, N m s/rad. None where there is no friction, so that a step computes nothing.
    #[doc(hidden)]
    fn coefficients<V: Numbers<S>>(all: &Self::Of<V>) -> Option<[V; 2]>;

    /// Applies `f` to each pair of coefficients.
    #[doc(hidden)]
    fn zip<V: Numbers<S>, W: Numbers<S>>(
        all: Self::Of<V>,
        one: Self,
        f: impl FnMut(V, S) -> W,
    ) -> Self::Of<W>;
}

impl<S: Real> Friction<S> for Frictionless {
    type Of<V: Numbers<S>> = Self;
    const ZERO: Self = Self;

    #[inline(always)]
    fn coefficients<V: Numbers<S>>(_: &Self) -> Option<[V; 2]> {
        None
    }

    #[inline(always)]
    fn zip<V: Numbers<S>, W: Numbers<S>>(_: Self, _: Self, _: impl FnMut(V, S) -> W) -> Self {
        Self
    }
}

impl<S: Real> Friction<S> for Viscous<S> {
    type Of<V: Numbers<S>> = Viscous<V>;
    const ZERO: Self = Self {
        joint1: S::ZERO,
        joint2: S::ZERO,
    };

    #[inline(always)]
    fn coefficients<V: Numbers<S>>(all: &Viscous<V>) -> Option<[V; 2]> {
        Some([all.joint1, all.joint2])
    }

    #[inline(always)]
    fn zip<V: Numbers<S>, W: Numbers<S>>(
        all: Viscous<V>,
        one: Self,
        mut f: impl FnMut(V, S) -> W,
    ) -> Viscous<W> {
        Viscous {
            joint1: f(all.joint1, one.joint1),
            joint2: f(all.joint2, one.joint2),
        }
    }
}

/// The torque at the elbow less that of friction, and the resistance of the fixed joint if it has friction, N m.
#[inline(always)]
pub(super) fn resist<S: Real, F: Friction<S>, V: Numbers<S>>(
    friction: &F::Of<V>,
    torque: V,
    [dtheta1, dtheta2]: [V; 2],
) -> (V, Option<V>) {
    match F::coefficients(friction) {
        None => (torque, None),
        Some([joint1, joint2]) => (torque - joint2 * dtheta2, Some(joint1 * dtheta1)),
    }
}

/// The name and value of each coefficient, N m s/rad.
pub(super) fn fields<S: Real, F: Friction<S, Of<S> = F>>(
    friction: &F,
) -> impl Iterator<Item = (&'static str, S)> {
    let names = ["friction.joint1", "friction.joint2"];
    names
        .into_iter()
        .zip(F::coefficients(friction).into_iter().flatten())
}
