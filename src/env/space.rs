//! Spaces: the sets of valid actions and observations.

use core::num::NonZeroU32;

use rand_core::Rng;

use crate::action::Action;
use crate::numpy::{integers, uniform};

/// A set that can test for an element and draw random ones.
///
/// A space has no generator: Gymnasium's `action_space.seed(s)` is a new `Pcg64`.
pub trait Space {
    /// The type of its elements.
    type Element;

    /// Whether `element` is in it.
    fn contains(&self, element: &Self::Element) -> bool;

    /// Draws a random element: Gymnasium's `sample()`, if `rng` is a
    /// [`Pcg64`](crate::numpy::Pcg64).
    fn sample<R: Rng + ?Sized>(&self, rng: &mut R) -> Self::Element;
}

/// Gymnasium's `Discrete`: a list of elements, numbered from 0.
///
/// ```
/// use acrobot::env::{DiscreteSpace, Space};
/// use acrobot::Action;
/// use acrobot::numpy::Pcg64;
///
/// let space = DiscreteSpace::new(&[10, 20, 30]).unwrap();
/// assert_eq!(space.sample(&mut Pcg64::new(42)), 10);
/// assert!(space.contains(&20) && !space.contains(&25));
/// assert!(DiscreteSpace::<Action>::new(&[]).is_none());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscreteSpace<T: 'static> {
    elements: &'static [T],
    n: NonZeroU32,
}

impl DiscreteSpace<Action> {
    /// Acrobot's three actions.
    pub const ACTIONS: Self = Self { elements: &Action::ALL, n: NonZeroU32::new(3).unwrap() };
}

impl<T> DiscreteSpace<T> {
    /// A space of these elements. `None` if there are none, or more than 2³² − 1.
    #[must_use]
    pub fn new(elements: &'static [T]) -> Option<Self> {
        let n = NonZeroU32::new(elements.len().try_into().ok()?)?;
        Some(Self { elements, n })
    }

    /// The number of elements.
    #[must_use]
    pub fn n(&self) -> NonZeroU32 {
        self.n
    }
}

impl<T: Clone + PartialEq> Space for DiscreteSpace<T> {
    type Element = T;

    fn contains(&self, element: &T) -> bool {
        self.elements.contains(element)
    }

    #[expect(clippy::indexing_slicing, reason = "integers are below n")]
    fn sample<R: Rng + ?Sized>(&self, rng: &mut R) -> T {
        self.elements[integers(rng, self.n) as usize].clone()
    }
}

/// Gymnasium's `Box`: vectors of `f32`, each component between two finite bounds.
///
/// ```
/// use acrobot::env::{BoxSpace, Space};
/// use acrobot::numpy::Pcg64;
///
/// let space = BoxSpace::new([-1.0, -12.6], [1.0, 12.6]).unwrap();
/// let sample = space.sample(&mut Pcg64::new(42));
/// assert!(space.contains(&sample));
/// assert!(BoxSpace::new([1.0], [0.0]).is_none());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxSpace<T> {
    low: T,
    high: T,
}

impl<T: AsRef<[f32]>> BoxSpace<T> {
    /// The vectors from `low` to `high`. `None` if the two differ in length, a bound is not finite,
    /// or a lower bound is above its upper bound.
    #[must_use]
    pub fn new(low: T, high: T) -> Option<Self> {
        let (lows, highs) = (low.as_ref(), high.as_ref());
        let mut bounds = lows.iter().zip(highs);
        let valid = lows.len() == highs.len()
            && bounds.all(|(low, high)| low.is_finite() && high.is_finite() && low <= high);
        valid.then_some(Self { low, high })
    }

    /// The lower bounds.
    #[must_use]
    pub fn low(&self) -> &T {
        &self.low
    }

    /// The upper bounds.
    #[must_use]
    pub fn high(&self) -> &T {
        &self.high
    }
}

impl<T> BoxSpace<T> {
    /// The same bounds as vectors of another type.
    pub(super) fn map<U>(self, convert: impl Fn(T) -> U) -> BoxSpace<U> {
        BoxSpace { low: convert(self.low), high: convert(self.high) }
    }
}

impl<T: AsMut<[f32]> + Clone> BoxSpace<T> {
    /// The vectors from −`high` to `high`, which must be finite and not negative.
    pub(super) fn symmetric(high: T) -> Self {
        let mut low = high.clone();
        low.as_mut().iter_mut().for_each(|x| *x = -*x);
        Self { low, high }
    }
}

impl<T: AsRef<[f32]> + AsMut<[f32]> + Clone> Space for BoxSpace<T> {
    type Element = T;

    fn contains(&self, element: &T) -> bool {
        let (lows, highs) = (self.low.as_ref(), self.high.as_ref());
        let element = element.as_ref();
        let mut all = element.iter().zip(lows.iter().zip(highs));
        element.len() == lows.len() && all.all(|(x, (low, high))| low <= x && x <= high)
    }

    fn sample<R: Rng + ?Sized>(&self, rng: &mut R) -> T {
        let mut sample = self.low.clone();
        for (x, &high) in sample.as_mut().iter_mut().zip(self.high.as_ref()) {
            *x = uniform(rng, (*x).into(), high.into()) as f32;
        }
        sample
    }
}
